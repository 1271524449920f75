"""Where a function of one number is zero, and where it is least: SciPy's searches, to the last digits."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

#: relative accuracy of a root, the least that brentq takes: four times the rounding of a float
LAST_DIGITS = 2.0**-50


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function of different signs at ``low`` and ``high`` is zero, by Brent's method.

    Examples
    --------
    >>> round(root(lambda x: x * x - 2, 0, 2), 12)
    1.414213562373
    """
    from scipy.optimize import brentq

    return brentq(function, low, high, xtol=1e-300, rtol=LAST_DIGITS)


def minimum(function: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function with one minimum between ``low`` and ``high`` is least, to about half of the digits.

    Examples
    --------
    >>> round(minimum(lambda x: (x - 0.3) ** 2, 0, 1), 6)
    0.3
    """
    from scipy.optimize import minimize_scalar

    return float(minimize_scalar(function, bounds=(low, high), method="bounded", options={"xatol": 1e-10 * (high - low)}).x)
