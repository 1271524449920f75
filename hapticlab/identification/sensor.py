"""How likely a sensed position is: Gaussian noise, and the count that it falls into, taken as it is.

A residual r is the middle of a count less the position, so the count is where r + noise lies within half a count.
"""

import numpy as np

from ..base.statistics import normal

#: of a count: noise from which on counts are dithered, each telling something of its own
DITHERED = 0.2
#: correlation of neighbouring residuals, in its standard errors, from which something is left unexplained; and residuals
#: over a count without dither, whose neighbours correlate by their rounding: that alone leaves 0.29, with noise 0.35
UNEXPLAINED, ROUNDED = 5.0, 0.45
#: of neighbours this far apart, a sum of correlations, in its standard errors, up to which nothing but noise is left for sure;
#: and residuals over a count: rounding alone leaves 0.29
LAGS, SURE, ROUNDING = 8, 3.0, 0.32
#: probability of a count, at least, for its logarithm
LEAST = 1e-290
#: noises tried, over the count: from a tenth of what is dither to many counts
TRIED = np.geomspace(0.02, 100.0, 52)


def _edges(rest, sigma, quantum):
    """The count's probability, and its edges over sigma with |r|, for which tails keep their digits."""
    low, high = (np.abs(rest) - quantum / 2) / sigma, (np.abs(rest) + quantum / 2) / sigma
    return np.maximum(normal(-low) - normal(-high), LEAST), low, high


def log_likelihood(rest, sigma, quantum, counted):
    """The logarithm of each sample's probability (density where it is no count), up to a constant.

    Parameters
    ----------
    rest : array, shape (N, L)
        [m]
    sigma : array, shape (L,)
        Noise [m]; beside a sensor whose counts are taken as numbers, of both.
    quantum : float
        A count [m].
    counted : array of bool, shape (L,)
    """
    plain = -0.5 * (rest / sigma) ** 2 - np.log(sigma)
    return np.where(counted, np.log(_edges(rest, sigma, quantum)[0]), plain) if np.any(counted) else plain


def information(rest, sigma, quantum, counted):
    """Each sample's score, the slope of its log-likelihood by the position [1/m], and its information [1/m^2]."""
    score, info = rest / sigma**2, np.broadcast_to(1 / sigma**2, rest.shape)
    if not np.any(counted):
        return score, info
    p, low, high = _edges(rest, sigma, quantum)
    bell = [np.exp(-0.5 * z * z) / np.sqrt(2 * np.pi) for z in (low, high)]
    slope = (bell[0] - bell[1]) / (p * sigma)
    bend = (high * bell[1] - low * bell[0]) / (p * sigma**2)
    told = counted & (p > LEAST)  # so far off that no count tells, a number does
    return np.where(told, np.sign(rest) * slope, score), np.where(told, np.maximum(slope**2 + bend, 0.0), info)


def spread(rest, quantum):
    """The noise that makes counted residuals likeliest, shape (L,), by search and a parabola."""
    tried = TRIED * quantum
    told = np.array([np.sum(np.log(_edges(rest, s, quantum)[0]), axis=0) for s in tried])
    best = np.clip(np.argmax(told, axis=0), 1, len(tried) - 2)
    lane = np.arange(rest.shape[1])
    before, top, after = (told[best + k, lane] for k in (-1, 0, 1))
    bend = np.minimum(before - 2 * top + after, -1e-12)
    shift = np.clip(0.5 * (before - after) / bend, -1, 1)
    return tried[0] * (tried[1] / tried[0]) ** (best + shift)


def run_weights(y, quantum):
    """Weights of the samples where no noise dithers the counts: a run of equal counts weighs as much as one sample."""
    if not quantum:
        return np.ones_like(y)
    counts = np.round(y / quantum)
    changed = np.concatenate([np.ones((1, y.shape[1]), bool), np.diff(counts, axis=0) != 0])
    run = np.cumsum(changed, axis=0) - 1
    weights = np.empty_like(y)
    for lane in range(y.shape[1]):
        weights[:, lane] = 1 / np.bincount(run[:, lane])[run[:, lane]]
    return weights


def neighbours(rest, y, quantum):
    """The correlation of neighbouring residuals, shape (L,)."""
    # neighbours that share a count without dither share its rounding: they say nothing about the model
    pairs = np.diff(y, axis=0) != 0 if quantum else np.ones_like(y[1:], bool)
    return np.sum(rest[1:] * rest[:-1] * pairs, axis=0) / np.maximum(np.sum(rest[1:] ** 2 * pairs, axis=0), 1e-300)


def explains(rest, y, quantum):
    """Whether residuals look like noise, or, without dither, like counting: less than a count does not show; shape (L,)."""
    counting = np.sqrt(np.mean(rest**2, axis=0)) < ROUNDED * quantum
    return counting | (np.abs(neighbours(rest, y, 0.0)) * np.sqrt(len(y)) < UNEXPLAINED)


def noise_alone(rest, quantum):
    """Whether nothing but noise, or rounding, is left for sure: a start elsewhere finds nothing better; shape (L,)."""
    power = np.maximum(np.sum(rest**2, axis=0), 1e-300)
    alike = sum(np.sum(rest[lag:] * rest[:-lag], axis=0) for lag in range(1, LAGS + 1)) / power
    return (np.sqrt(power / len(rest)) < ROUNDING * quantum) | (np.abs(alike) * np.sqrt(len(rest) / LAGS) < SURE)
