"""The noise of a sensor behind its counts, from a record of a handle at rest, by maximum likelihood."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.statistics import chi_squared, normal
from ...errors import PaddleError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

#: samples, of which fewer tell too little
LEAST_SAMPLES = 100
#: standard deviations that are tried, in counts: the least, and how many up to twice the spread of the counts
LEAST, TRIED, PLACES = 0.02, 300, 101
#: log likelihood below the best at which a standard deviation is as good: two values say no more than that it is small
AS_GOOD = 0.05


@dataclass(frozen=True)
class StillNoise:
    """Standard deviation of the noise and the ends of its confidence interval, in counts; ``low`` is 0 where it may be less."""

    value: float
    low: float
    high: float


def still_noise(counts: ArrayLike, confidence: float = 0.95) -> StillNoise:
    """Return the noise of a sensor, without the rounding to counts, from what it read of a handle at rest.

    The standard deviation of counts alone is wrong below one count: noise of 0.2 counts gives from 0 to 0.5 counts, by where
    between two counts the handle rests. Here both are unknown, and what is looked for makes the counts that came most
    likely. Where only two values came, it is the largest noise that explains them as well as a smaller one.

    Parameters
    ----------
    counts : array_like, shape (N,)
        Whole numbers; at least 100.
    confidence : float
        Of the interval, 0 ... 1.

    Raises
    ------
    PaddleError
        For fewer samples, or counts that are not whole.

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.device.setup.still_noise import still_noise
    >>> counts = np.floor(0.4 + 0.3 * np.random.default_rng(1).standard_normal(1000))
    >>> found = still_noise(counts)
    >>> round(found.value, 2), found.low < 0.3 < found.high, round(float(np.std(counts)), 2)
    (0.29, True, 0.33)
    """
    given = np.asarray(counts, float)
    if len(given) < LEAST_SAMPLES:
        raise PaddleError(f"noise: {len(given)} samples; needs {LEAST_SAMPLES} or more. Watch the resting handle for longer.")
    if not np.array_equal(given, np.round(given)):
        raise PaddleError("noise: counts are not whole numbers. Give the readings of the sensor, not positions in metres.")
    values, often = np.unique(given, return_counts=True)
    values = values - given.mean()
    deviations = np.geomspace(LEAST, 2 * given.std() + 1, TRIED)
    likely = _likelihoods(values, often, deviations)
    best, allowed = likely.max(), chi_squared(confidence) / 2
    inside = np.flatnonzero(likely > best - allowed)
    low, high = deviations[max(inside[0] - 1, 0)], deviations[min(inside[-1] + 1, TRIED - 1)]
    value = float(deviations[likely > best - AS_GOOD].max()) if len(values) <= 2 else float(deviations[likely.argmax()])
    if len(values) == 1:
        value = 0.0
    return StillNoise(value, float(low) if inside[0] else 0.0, float(high))


def _likelihoods(values, often, deviations):
    """Return for each standard deviation the log likelihood of the counts at the place that suits it best."""
    places = np.linspace(-0.6, 0.6, PLACES)[:, None]
    found = []
    for deviation in deviations:
        edges = (values + 0.5 - places) / deviation, (values - 0.5 - places) / deviation
        # by the smaller tail, so that far from the place no digits are lost
        upper, lower = (np.where(edges[1] > 0, -edge, edge) for edge in edges)
        part = np.abs(normal(upper) - normal(lower))
        found.append((often * np.log(np.maximum(part, 1e-300))).sum(1).max())
    return np.array(found)
