"""Distributions that a fit needs; identification's only door to scipy."""


def student(confidence, freedom):
    """Return the quantile t of Student's distribution with P(|t'| < t) = confidence.

    Examples
    --------
    >>> round(float(student(0.95, 10)), 6)
    2.228139
    """
    from scipy.special import stdtrit

    return stdtrit(freedom, (1 + confidence) / 2)


def normal(z):
    """Return the normal distribution function of z, small values to all their digits.

    Examples
    --------
    >>> print(f"{normal(-20.0):.6e}")
    2.753624e-89
    """
    from scipy.special import ndtr

    return ndtr(z)
