"""Vectors of the plane as pairs (x, y): of floats, arrays, expressions or traced values alike."""


def dot(a, b):
    """Return the scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1]


def less(a, b):
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1]


def minus(a):
    """Return -a."""
    return -a[0], -a[1]
