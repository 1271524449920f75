"""Drawings for a student who has no book: the paddle, its loop, sample and hold, the signs. Begin with drawing.py."""
