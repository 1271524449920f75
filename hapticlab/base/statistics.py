"""Distributions of statistics: what an estimate's confidence is read from."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .annotations import Array


def normal(z: ArrayLike) -> Array:
    """Standard normal distribution function of z; small values keep all their digits.

    Examples
    --------
    >>> print(f"{normal(-20.0):.6e}")
    2.753624e-89
    """
    from scipy.special import ndtr

    return ndtr(z)


def student(confidence: float, freedom: ArrayLike) -> Array:
    """Quantile t of Student's distribution with P(|t'| < t) = confidence.

    Examples
    --------
    >>> round(float(student(0.95, 10)), 6)
    2.228139
    """
    from scipy.special import stdtrit

    return stdtrit(freedom, (1 + confidence) / 2)


def chi_squared(confidence: float) -> float:
    """Quantile of the chi-squared distribution with one degree of freedom.

    Examples
    --------
    >>> round(chi_squared(0.95), 4)
    3.8415
    """
    from scipy.special import ndtri

    return float(ndtri((1 + confidence) / 2)) ** 2
