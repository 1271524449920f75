"""The speed of aimed movements: submovements whose scatter grows with their speed, each as fast as pays off."""

import math

import numpy as np

from ..base.statistics import normal
from ..errors import AnalysisError

#: shortest and longest submovement thought of [s], and how many between; distances between half a width and the longest
SHORTEST, LONGEST, DURATIONS, DISTANCES = 0.08, 3.0, 80, 80


class Submovements:
    """Stochastic optimized submovements: each ends off its aim by a normal error of ``scatter`` times distance/duration.

    Whoever misses pauses to see it, then corrects. The durations are those that bring the hand to the target soonest on
    average, found by iterating Bellman's equation; D. E. Meyer et al., *Psychological Review* 95 (1988) 340. Fitts' law
    comes out, it is not put in.

    Parameters
    ----------
    width : float
        Of the target [m].
    scatter : float
        Standard deviation of the end over mean speed [s], > 0.
    pause : float
        Between two submovements [s].
    furthest : float
        Longest distance to be asked for [m].

    Attributes
    ----------
    distances, durations, times : array
        For each distance the best duration of the next submovement and the mean time until the hand is in the target [s].

    Examples
    --------
    >>> near, far = (Submovements(0.01, furthest=d).time(d) for d in (0.04, 0.08))
    >>> 0 < far - near < near
    True
    """

    def __init__(self, width, *, scatter=0.04, pause=0.18, furthest):
        if not (width > 0 and scatter > 0 and pause >= 0 and furthest > width / 2):
            raise AnalysisError(
                f"width = {width:g} m, scatter = {scatter:g} s, pause = {pause:g} s, furthest = {furthest:g} m; all need to "
                "be positive, and the distances larger than half the width"
            )
        self.width, self.scatter = width, scatter
        self.distances = np.geomspace(width / 2, furthest, DISTANCES)
        self._choose(pause)

    def _choose(self, pause):
        durations = np.geomspace(SHORTEST, LONGEST, DURATIONS)
        spread = self.scatter * self.distances[:, None] / durations
        edges = np.r_[self.distances[0], np.sqrt(self.distances[1:] * self.distances[:-1]), np.inf]
        # missing by a distance near each point of the grid; whatever lies beyond the last counts as that
        part = 2 * np.diff(normal(edges / spread[:, :, None]), axis=-1)
        missed = 2 * (1 - normal(self.distances[0] / spread))
        times = np.full(DISTANCES, LONGEST)
        for _ in range(1000):
            cost = durations + missed * pause + part @ times
            better = cost.min(axis=1)
            if np.abs(better - times).max() < 1e-9:
                break
            times = better
        self.times, self.durations = times, durations[cost.argmin(axis=1)]

    def time(self, distance):
        """Mean time from this distance until the hand is in the target [s]."""
        return float(np.interp(math.log(distance), np.log(self.distances), self.times))

    def duration(self, distance):
        """Best duration of the next submovement [s]."""
        return float(np.interp(math.log(max(distance, self.distances[0])), np.log(self.distances), self.durations))
