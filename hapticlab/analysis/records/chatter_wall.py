"""What the wall makes of an oscillation: whether it lasts, where the handle bounces and where it stays inside."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .chatter_end import SWINGS, linear_trend, ragged, swings_of, verdict
from .chatter_inside import inside, loses_each_cycle
from .chatter_signs import around_trend, sinks_to_counts

#: swings of fewer samples than this are known too badly to be fitted
COARSE = 3
#: a cycle beside rest that attracts repeats itself where its growth is below this part of that inside the wall
SETTLES = 0.01


class OfTheWall(NamedTuple):
    """A state; whether it has settled; lowest and highest amplitude at its end [m]; the growth inside the wall [1/sample]."""

    state: str
    locked: bool
    ends: tuple[float, float] | None = None
    growth: float = math.nan


def of_the_wall(state, locked, x, F, log, clipped):
    """Return what the force makes of an oscillation that two quarters of a record call ``state``, and whether it has settled.

    Where the handle stays inside and the force is linear, the growth inside decides. Where the handle bounces, or the motor is
    at its limit, the oscillation ends in a cycle if rest does not attract. Else it ends where the swings say.
    """
    growth, rest = inside(x, F, log.saturated[-len(x) :].astype(bool) if clipped else None)
    outside = np.flatnonzero(F == 0)
    bounces = len(outside) > 0 and np.any(F) and outside[-1] >= len(F) // 2
    if sinks_to_counts(around_trend(x)[0], log.x[-len(x) :]) or not (bounces or clipped):
        since = slice(outside[-1] + 1 if len(outside) else 0, None)
        trend = growth if not math.isnan(growth) else linear_trend(x[since], F[since]) if locked else 0.0
        if trend:
            state, locked = ("growing" if trend > 0 else "decaying"), False
        return OfTheWall(state, locked, None, growth)
    if bounces and not _deeper(x, outside, rest):
        growth = math.nan
    at, swings = swings_of(x)
    ends, fitted = None, state != "growing" and len(x) >= COARSE * len(swings)
    if len(swings) < SWINGS or ragged(swings):
        state, locked = state if locked or not fitted else "undecided", locked and len(swings) >= SWINGS
    elif fitted:
        state, (low, high) = verdict(at * log.T, swings, x, F, clipped, growth < 0)
        locked, ends = locked and state == "chatter", (low / 2, high / 2)
    if growth > 0 and state in ("decaying", "undecided") and len(swings) > 1:
        state = "growing" if swings[-1] > swings[0] else "chatter"
    elif growth < 0 and not clipped:
        state, locked = _above_rest(state, locked, at, swings, growth)
    return OfTheWall(state, locked, ends, growth)


def _deeper(x, outside, rest):
    """Tell whether a position lies deeper in the wall than every sample outside."""
    free = x[outside]
    return rest > free.max() if np.median(np.delete(x, outside)) > np.median(free) else rest < free.min()


def _above_rest(state, locked, at, swings, growth):
    """The state of a handle that bounces above rest that attracts: a cycle counts only where it plainly repeats itself."""
    if loses_each_cycle(at, swings, growth):
        return "decaying", False
    if state in ("chatter", "growing"):
        slope = np.polyfit(at, np.log(swings), 1)[0] if len(swings) > 1 else math.inf
        return ("chatter", locked) if abs(slope) < SETTLES * -growth else ("undecided", False)
    return state, locked
