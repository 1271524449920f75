"""LIVE VIEWS in a notebook."""
