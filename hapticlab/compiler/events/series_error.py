"""What a Taylor series leaves out, judged by its last term: whether a step of a motion that is not linear converged."""

import math

from ..algebra.polynomial_crossing import horner
from ..ir.conditions import any_of
from ..ir.structural_zeros import is_zero

#: a term below this [SI] is nothing: a state that only starts to move has no terms before it
NOTHING = 1e-9


def remainder_for(order, real, linear):
    """The parts of a state that the last term of its series may be: (converged, not diverged); None where it is.

    Examples
    --------
    >>> from hapticlab.compiler.events.series_error import remainder_for
    >>> remainder_for(16, "f64", linear=False), remainder_for(16, "f64", linear=True)
    ((1e-08, 0.0001), None)
    """
    if linear or order < 6:  # a motion that turns by a radian leaves 1/order!
        return None
    last = 10.0 / math.factorial(order)
    return max({"f64": 1e-8, "f32": 1e-5}[real], last), max(1e-4, last)


def exceeded(rows, theta, order, parts):
    """For each part whether the last term of a series at theta is more than that part of the terms before it.

    Parameters
    ----------
    rows : iterable of lists
        Coefficients 0 to ``order`` of each state.
    theta : Value or float
    order : int
    parts : sequence of float
    """
    power, rows = _power(theta, order), [row for row in rows if not is_zero(row[order])]
    last = [power * abs(row[order]) for row in rows]
    before = [horner([abs(c) for c in row[:order]], theta) for row in rows]
    return [any_of(part * size + NOTHING < term for size, term in zip(before, last, strict=True)) for part in parts]


def _power(a, n):
    """a**n by squaring."""
    half = _power(a, n // 2) if n > 1 else 1.0
    return half * half * a if n % 2 else half * half
