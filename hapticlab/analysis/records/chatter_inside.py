"""What a record shows of the motion inside the wall, where the force acts: whether small oscillations there grow.

Inside the wall a linear law gives linear motion: the next position is a weighted sum of the last ones. The weights follow
from the samples by least squares, and the largest eigenvalue says whether rest attracts. If it does not, a handle that is
pushed into the wall never comes to rest, and an oscillation that shrinks towards the wall shrinks towards a cycle.
If rest attracts, a cycle can exist beside it only where the sampling instants of each contact feed the oscillation.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .chatter_end import SWINGS

if TYPE_CHECKING:
    from ...base.annotations import Array, Flags

#: past positions on which the next one may depend: a handle has two, and a law's memory and a delay add theirs
LAGS = range(2, 6)
#: motion is linear where the residual is below this fraction of the second difference of the position
LINEAR = 1e-4
#: weights are not resolved where rounding makes up more than this part of what the positions say of one of them
UNRESOLVED = 0.1
#: one more past position has to reduce the residual to this fraction, or the law does not depend on it
FEWER = 0.3
#: different samples for each weight, so that a cycle of few samples is not fitted by any weights
DIFFERENT = 3
#: an eigenvalue differs from 1 where it does so by this number of standard errors
SURE = 5.0
#: swings lose surely where the least loss per cycle exceeds the scatter of the losses by this factor
CERTAIN = 3.0


class Inside(NamedTuple):
    """How oscillations inside the wall grow, per sample; nan if the record does not show it. And where they end."""

    growth: float = math.nan
    rest: float = math.nan


def inside(x: Array, F: Array, clipped: Flags | None = None) -> Inside:
    """Return the growth of small oscillations where the force acts, and the position at which they would rest [m].

    Parameters
    ----------
    x, F : array of shape (N,)
        Positions [m] and forces [N]. Samples of no force are outside.
    clipped : bool array of shape (N,), optional
        Where the motor is at its limit, and so not inside.
    """
    acts = F != 0 if clipped is None else (F != 0) & ~clipped
    bend = float(np.std(np.diff(x, 2)[acts[2:]])) if acts[2:].any() else 0.0
    found, least, rounding = Inside(), LINEAR * bend, 4 * np.finfo(float).eps * abs(x).max()
    for lags in LAGS:
        together = np.lib.stride_tricks.sliding_window_view(acts[:-1], lags).all(axis=1)
        last = np.flatnonzero(together) + lags - 1
        if len(last) == 0 or bend == 0:
            break
        rows, following = np.stack([x[last - i] for i in range(lags)], axis=1), x[last + 1]
        different = len(np.unique(np.round((following - following.mean()) / (np.ptp(following) or 1.0), 6)))
        if different < DIFFERENT * (lags + 1):
            break
        weights, inverse = _least_squares(rows - rows.mean(axis=0), following - following.mean())
        if np.linalg.norm(inverse, 2) * rounding * math.sqrt(len(last)) > UNRESOLVED:
            break
        constant = following.mean() - rows.mean(axis=0) @ weights
        residual = following - rows @ weights - constant
        error = math.sqrt(residual @ residual / (len(last) - lags - 1))
        if error < least:
            found, least = _of_weights(weights, inverse, error, len(last), constant), FEWER * error
        elif least < LINEAR * bend:
            break
    return found


def _least_squares(rows, following):
    """Return the weights of the rows, and the matrix that gives the errors of the weights for an error of 1."""
    _, sizes, directions = np.linalg.svd(rows, full_matrices=False)
    inverse = directions.T / np.maximum(sizes, 1e-300)
    return np.linalg.lstsq(rows, following, rcond=None)[0], inverse


def _of_weights(weights, inverse, error, number, constant):
    """Return the growth by the largest eigenvalue of the weights, if it exceeds its error."""
    polynomial = np.r_[1.0, -weights]
    roots = np.roots(polynomial)
    largest = roots[abs(roots).argmax()]
    slope = largest ** np.arange(len(weights))[::-1] / np.polyval(np.polyder(polynomial), largest)
    slope = (slope * np.conj(largest)).real / abs(largest)
    # errors in the positions themselves bias the weights, by the square of the errors
    bias = number * error**2 / (1 + weights @ weights) * abs(slope @ inverse @ inverse.T @ weights)
    growth, margin = abs(largest) - 1, SURE * error * np.linalg.norm(slope @ inverse) + 2 * bias
    stiffness = 1 - weights.sum()  # none where the motion inside drifts, without a rest
    return Inside(float(growth), float(constant / stiffness)) if abs(growth) > margin and stiffness else Inside()


def loses_each_cycle(at, swings, growth):
    """Return whether swings that end at samples ``at`` lose in each cycle, at every instant of sampling, down to rest.

    The loss per cycle lies between that of the record's end and that inside the wall, ``growth`` per sample. Contacts begin
    between samples, sooner or later, which scatters the losses. Where the smaller loss exceeds the scatter, no cycle can
    hold the oscillation.
    """
    if len(swings) < SWINGS:
        return False
    loss, when = np.log(swings[:-2] / swings[2:]), at[2:] - at[-1]
    trend = np.polyfit(when, loss, 2 if len(loss) > 2 * SWINGS else 1)
    scatter = abs(loss - np.polyval(trend, when)).max()
    cycle = float(np.median(at[2:] - at[:-2]))
    return bool(min(trend[-1], -growth * cycle) > CERTAIN * scatter)
