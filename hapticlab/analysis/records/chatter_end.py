"""Where an oscillation ends: the swing towards which the swings of a record tend, with an interval.

Averaged over a cycle, a handle that bounces on a wall, or one whose motor is at its limit, approaches its limit cycle as a
constant plus an exponential. Inside the wall, without leaving it, the law is linear: there is no cycle, and what shrinks
dies out. So a cycle is a swing that leaves the wall, and the smallest that does is twice the depth at which the handle
would rest.
"""

from __future__ import annotations

import math

import numpy as np

#: fewer swings than this tell nothing of where they end
SWINGS = 7
#: exponents of the way to the end over the time of the swings; the first are tried where no larger one is the best
RATES, IN_SIGHT = np.geomspace(0.02, 30, 240), 0.3
#: a fit is as good as the best where its squares exceed it by less than this over its free swings: 3.5 standard deviations
AS_GOOD = 12.0
#: what still shrinks may end lower by this part of the rest of its way: the exponential is that of bounces, which become short
BENDS = 1.0
#: swings that differ by more of their size than this are uneven: they tell nothing of an end that is not in sight
UNEVEN = 0.02
#: swings are known to this part; the depth at rest is known to this part, where its two halves do not say worse
KNOWN, DEPTH = 2e-5, 2e-3
#: without a depth to compare with: an end above the first part of the present swing is a cycle, below the second it is rest
LARGE, SMALL = 0.5, 0.1
#: a cycle has been seen where it ends surely above this part of the present swing, and rest where it ends surely below this
#: part of the swing that leaves the wall; between the two the record does not tell
REACHED, CLEARLY = 0.7, 0.7
#: a swing this much smaller than one beside it is a wiggle of noise; where more than this part are, swings tell nothing
WIGGLE, RAGGED = 0.1, 0.1
#: what has come so near to its end has settled
SETTLED = 0.01
#: a trend of a linear motion is told from none where it exceeds its error by this
SURE = 5.0
#: a force is linear in the samples where what is left of it is below this part of its range
LINEAR = 1e-4


def swings_of(x):
    """Return where swings end, in samples, and how far each goes: from turning point to turning point."""
    d = np.diff(x)
    moving = np.flatnonzero(d)
    turns = np.flatnonzero(d[moving[:-1]] * d[moving[1:]] < 0)
    a, b = moving[turns], moving[turns + 1]
    # the parabola through a turning point's three samples; a handle that stops for a while turns where it stands
    peak = x[b] + np.where(b == a + 1, (d[b] + d[a]) ** 2 / (8 * (d[a] - d[b])), 0.0)
    return b[1:], abs(np.diff(peak))


def ragged(swings):
    """Return whether noise turns the handle round again and again between its true turning points."""
    beside = np.maximum(swings[:-2], swings[2:])
    return bool(np.mean(swings[1:-1] < WIGGLE * beside) > RAGGED) if len(swings) > 2 else False


def verdict(t, swings, x, F, clipped, attracts=False):
    """Return the state of an oscillation that is not linear, and between which swings it ends [m].

    ``attracts`` says that rest inside the wall is known to attract.
    """
    best, lowest, highest = swings_end(t, swings)
    now = float(np.median(swings[-5:]))
    least, most = (0.0, math.inf) if clipped else leaving_swing(x, F)
    least, most = (SMALL * now, LARGE * now) if math.isinf(most) else (least, most)
    if lowest > max(most, REACHED * now) or lowest > (1 - SETTLED) * now:
        state = "growing" if best > (1 + SETTLED) * now and not lowest <= now <= highest else "chatter"
    else:
        state = "decaying" if highest < (1.0 if attracts else CLEARLY) * least else "undecided"
    return state, (float(max(lowest, 0.0)), float(max(highest, 0.0)))


def swings_end(t, swings):
    """Return the best estimate of the swing that swings at times t tend to, and its lowest and highest [m].

    The interval holds what the last two thirds alone say as well, so that a motion that is no exponential is not believed.
    Swings in which no exponential is seen end at their mean.
    """
    best, lowest, highest, now = _fitted(t, swings)
    third = len(t) // 3
    if lowest != highest and len(t) - third >= SWINGS - 1:
        again = _fitted(t[third:], swings[third:])[0]
        lowest, highest = min(lowest, again), max(highest, again)
    return best, lowest - BENDS * max(0.0, now - best), highest


def _fitted(t, swings):
    """Return best, lowest and highest end of a constant plus an exponential, and its value at the last time."""
    u = (t - t[0]) / (t[-1] - t[0])
    shapes = -np.expm1(-np.outer(RATES, u)) / RATES[:, None]
    centred = shapes - shapes.mean(axis=1, keepdims=True)
    slopes = centred @ (swings - swings.mean()) / (centred**2).sum(axis=1)
    start = swings.mean() - slopes * shapes.mean(axis=1)
    left = swings - start[:, None] - slopes[:, None] * shapes
    squares, ends = (left**2).sum(axis=1), start + slopes / RATES
    tried = RATES >= (1.0 if squares.min() > len(t) * (UNEVEN * swings.mean()) ** 2 else IN_SIGHT)
    i = int(np.where(tried, squares, np.inf).argmin())
    if not tried[i - 1] and tried.sum() == (RATES >= IN_SIGHT).sum():  # an even way to an end that is far away
        tried[:], i = True, int(squares.argmin())
    free, known = _free(left[i]), len(t) * (KNOWN * swings[-1]) ** 2
    around = swings - swings.mean()
    if around @ around <= squares[i] * (1 + AS_GOOD / free) + known:
        mean, error = swings.mean(), math.sqrt(AS_GOOD * (around @ around) / len(t) / _free(around))
        return mean, mean - error, mean + error, mean
    good = tried & (squares <= squares[i] * (1 + AS_GOOD / free) + known)
    return ends[i], ends[good].min(), ends[good].max(), start[i] + slopes[i] * shapes[i, -1]


def _free(left):
    """Return how many of the residuals are worth one each: neighbours that agree are not."""
    alike = (left[1:] @ left[:-1]) / max(left @ left, 1e-300)
    return max(1.0, (len(left) - 3) * (1 - alike) / (1 + alike) if alike > 0 else len(left) - 3)


def leaving_swing(x, F):
    """Return the smallest and the largest estimate of the swing from which on the handle leaves the wall; 0 and inf if unknown.

    The stiffness is that of the force over the position while it acts; the mean force over whole cycles holds the handle.
    """
    begins = np.flatnonzero((F[1:] != 0) & (F[:-1] == 0)) + 1
    if len(begins) < 3:
        return 0.0, math.inf
    depths = [_depth(x[a:b], F[a:b]) for a, b in _halves(begins)]
    if not all(np.isfinite(depths)) or min(depths) <= 0 or max(depths) > 1.2 * min(depths):
        return 0.0, math.inf
    whole = _depth(x[begins[0] : begins[-1]], F[begins[0] : begins[-1]])
    spread = max(DEPTH * whole, abs(depths[1] - depths[0]))
    return 2 * (whole - spread), 2 * (whole + spread)


def _halves(begins):
    middle = len(begins) // 2
    return (begins[0], begins[middle]), (begins[middle], begins[-1])


def _depth(x, F):
    """Return the depth at which the spring that acts in the samples would hold its own mean force [m], or nan."""
    acts = F != 0
    if acts.sum() < 4:
        return math.nan
    terms = np.c_[x, np.gradient(x), np.ones(len(x))][acts]
    (k, _, _), *_ = np.linalg.lstsq(terms, F[acts], rcond=None)
    return float(F.mean() / k) if k else math.nan


def linear_trend(x, F):
    """Return the trend of the logarithm of the swings [1/sample] where the force acts throughout and is linear; else 0.

    It is 0 too where it does not exceed its error. Over many swings it shows what rounding hides from sample to sample.
    """
    if len(F) < 4 or not np.all(F != 0):
        return 0.0
    terms = np.c_[x[2:], x[1:-1], x[:-2]]
    terms, force = terms - terms.mean(axis=0), F[2:] - F[2:].mean()
    left = force - terms @ np.linalg.lstsq(terms, force, rcond=None)[0]
    at, swings = swings_of(x)
    if not np.ptp(left) < LINEAR * np.ptp(force) or len(swings) < SWINGS:
        return 0.0
    at, logs = at - at.mean(), np.log(swings + 1e-300)
    slope = (at @ logs) / (at @ at)
    left = logs - logs.mean() - slope * at
    error = math.sqrt(left @ left / (at @ at) / _free(left))
    return float(slope) if abs(slope) > SURE * error else 0.0
