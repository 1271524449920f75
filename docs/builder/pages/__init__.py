"""What writes pages from the package itself: each ``write`` gets the copied sources; ``generators.py`` has their order."""
