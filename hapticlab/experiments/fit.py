"""The normal and the chi-squared distribution; the only place of the experiments where scipy opens."""


def normal_cdf(z):
    """Return the normal distribution function.

    Examples
    --------
    >>> float(normal_cdf(0.0))
    0.5
    """
    from scipy.special import ndtr

    return ndtr(z)


def chi_squared(confidence):
    """Return what a chi-squared variable of one degree of freedom stays below with this probability.

    Examples
    --------
    >>> round(chi_squared(0.95), 4)
    3.8415
    """
    from scipy.special import ndtri

    return float(ndtri((1 + confidence) / 2)) ** 2
