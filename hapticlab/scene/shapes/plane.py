"""Vectors of the plane as pairs (x, y): of floats, arrays, expressions or traced values alike."""


def dot(a, b):
    """Scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1]


def less(a, b):
    """The difference a - b."""
    return a[0] - b[0], a[1] - b[1]


def minus(a):
    """The vector turned round, -a."""
    return -a[0], -a[1]
