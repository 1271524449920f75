"""Cases and sums over traced values, floats and arrays alike."""

import numpy as np

from .structural_zeros import ZERO, is_zero
from .values import Value, select


def signed(negative, c):
    """Return c, or -c where ``negative``; a structural zero as it is."""
    return c if is_zero(c) else select(negative, -c, c)


def either(condition, a, b):
    """Choose between conditions, as select does between numbers."""
    return (condition & a) | (~condition & b)


def one_of(condition, a, b):
    """Choose between conditions as :func:`either`, by a select: what only one of them needs may be skipped."""
    a, b = (c if isinstance(c, Value) else bool(c) for c in (a, b))
    return 0.5 < select(condition, select(a, 1.0, 0.0), select(b, 1.0, 0.0))


def size(values):
    """Return the sum of |values|."""
    total = ZERO
    for value in values:
        total = total + abs(value)
    return total


def any_of(conditions):
    """The disjunction of some conditions."""
    total = np.False_
    for c in conditions:
        total = c | total
    return total
