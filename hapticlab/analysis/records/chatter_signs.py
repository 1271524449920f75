"""Signs in a record that tell motions apart before anything is called chatter: scatter, running away, a decay that ends."""

import math

import numpy as np

#: a handle that has become faster by this from one quarter to the next, and moves by more [m], runs away
FASTER, FAR = 1.02, 1e-3
#: the scatter of a sensor: at no lag up to so many samples is the correlation as large as this
LAGS, CORRELATED = 40, 0.2
#: a driven motion that has grown by more than this more than its drive, to one side, runs away
OUTGROWS, ONE_SIDE = 2.0, 0.25
#: a decay loses in the second half at least this part of what it lost in the first
LEVELS = 0.5
#: a swing over so many counts of the encoder or fewer: its unevenness may be what is left of a decay
COUNTS = 4


def runs_away(x, quarter):
    """Return whether the handle goes one way, and farther in the last quarter than in the one before."""
    last, before = x[-quarter:], x[len(x) - 2 * quarter : len(x) - quarter]
    return bool(np.ptp(last) > max(FAR, FASTER * np.ptp(before)))


def leaves_its_drive(x, drive, quarter):
    """Return whether a driven handle moves off to one side, much farther than it did before and than its drive asks."""
    last, before = x[-quarter:], x[-2 * quarter : -quarter]
    asked = np.ptp(drive[-quarter:]) / max(np.ptp(drive[-2 * quarter : -quarter]), 1e-300)
    up, down = max(0.0, last.max() - before.max()), max(0.0, before.min() - last.min())
    one_way = min(up, down) < ONE_SIDE * max(up, down)
    return bool(one_way and np.ptp(last) > max(FAR, OUTGROWS * max(1.0, asked) * np.ptp(before)))


def scatter(y):
    """Return the standard deviation of y where it is white noise, else 0: a handle has mass and cannot jump about so.

    An oscillation is correlated with itself a period or half of one later, whatever its frequency.
    """
    power = float(y @ y)
    if power == 0:
        return 0.0
    lags = range(1, min(LAGS, len(y) // 4) + 1)
    white = all(abs(y[k:] @ y[:-k]) < CORRELATED * power for k in lags)
    return float(np.sqrt(power / len(y))) if white else 0.0


def levels_off(strengths):
    """Return whether amplitudes, one after the other, fall more and more slowly: a decay onto a cycle, not to rest."""
    logs = np.log(np.asarray(strengths) + 1e-300)
    if len(logs) < 4:
        return False
    part = len(logs) // 2
    first, last = logs[part] - logs[0], logs[-1] - logs[-1 - part]
    return bool(first < 0 and last > LEVELS * first)


def upward_crossings(y):
    """Return where y rises through zero, in samples; swings below a quarter of its rms do not count."""
    swing = np.flatnonzero(abs(y) > 0.25 * math.sqrt(np.mean(y**2)))
    turns = np.flatnonzero((y[swing[:-1]] < 0) & (y[swing[1:]] > 0))
    before, after = swing[turns], swing[turns + 1]
    return before + (after - before) * y[before] / (y[before] - y[after])


def contact_rate(F, T):
    """Return how often a second the force begins to act [1/s], from the first beginning to the last: whole cycles.

    Where it has ceased to begin, for longer than twice between two beginnings, the whole record counts.
    """
    begins = np.flatnonzero((F[1:] != 0) & (F[:-1] == 0))
    if len(begins) > 2:
        between = (begins[-1] - begins[0]) / (len(begins) - 1)
        if max(begins[0], len(F) - begins[-1]) < 2 * between:
            return float(1 / (between * T))
    return float(len(begins) / (len(F) * T))


def around_trend(x):
    """Return x less its straight line, and the weights of the fit: a drift is no oscillation.

    The line is fitted under a Hann window, which makes whole cycles unnecessary.
    """
    n = np.linspace(-1, 1, len(x))
    window = np.hanning(len(x) + 2)[1:-1]
    window /= window.sum()
    x = x - window @ x
    return x - n * ((window * n) @ x) / ((window * n) @ n), window


def strength(x):
    """Return the amplitude of the sinusoid of equal energy."""
    y, window = around_trend(x)
    return math.sqrt(2 * (window @ y**2))


def sinks_to_counts(y, sensed):
    """Tell whether a swing of a few encoder counts has lost a third: a decay, perhaps onto a smaller cycle.

    Four windows make a decay that has just ended look as uneven as an irregular cycle.
    """
    size = len(y) // 4
    first, second, third, fourth = (strength(y[i * size : (i + 1) * size]) for i in range(4))
    steps = np.diff(np.unique(sensed))
    few = len(steps) > 0 and round(steps.sum() / steps.min()) <= COUNTS
    return few and max(third, fourth) < 2 / 3 * max(first, second)
