"""The normal distribution of an array; the only place of the experiments where scipy opens."""


def normal_cdf(z):
    """Return the normal distribution function.

    Examples
    --------
    >>> float(normal_cdf(0.0))
    0.5
    """
    from scipy.special import ndtr

    return ndtr(z)
