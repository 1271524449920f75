"""Adaptive up-down staircases: harder after right answers, easier after a wrong one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import numbers
from ..base.shows_itself import ShowsItself
from ..errors import AnalysisError

if TYPE_CHECKING:
    from .response_curves import Psychometric

#: as many answers in a row, all right at the lowest level or all wrong at the highest, and it ends: 1 in a million by guessing
ENOUGH = 20


@dataclass(frozen=True, kw_only=True)
class Levels(ShowsItself):
    """The lowest and the highest level that a staircase can present.

    Parameters
    ----------
    low, high : float
        0 < low < high, in the unit of the level.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.people.Levels(low=0.02)
    Levels(low=0.02, high=2.0)
    """

    low: float = 1e-3
    high: float = 2.0

    def __post_init__(self) -> None:
        numbers(self, "a staircase", low={"above": 0}, high={"above": 0})
        if self.low >= self.high:
            raise AnalysisError(f"low = {self.low:g}, high = {self.high:g}; a staircase needs low < high")


LEVELS = Levels()


class UpDown(ShowsItself):
    """Transformed and weighted up-down staircase: after ``down`` right answers in a row a step down, after a wrong one up.

    It goes towards the level where ``(weight/(1 + weight))^(1/down)`` of the answers are right: 71 % for two down, one
    up (H. Levitt, *J. Acoust. Soc. Am.* 49 (1971) 467) and 75 % for one down with steps up three times as long (C.
    Kaernbach, *Perception & Psychophysics* 49 (1991) 227). That is exact for small steps; :meth:`settles` says where a
    staircase of these steps really ends up (M. A. Garcia-Perez, *Vision Research* 38 (1998) 1861).

    Parameters
    ----------
    first : float
        First level, > 0.
    factor : float
        A step down divides the level by this, > 1.
    down : int
        Right answers in a row that a step down takes.
    weight : float
        A step up multiplies the level by factor^weight.
    reversals : int
        Turning points after which it ends.
    skip : int
        First turning points that the estimate leaves out; until then steps are twice as long.
    most_trials : int
        Trials after which it ends at the latest.
    levels : Levels
        What may be asked, ``hl.people.Levels(low=, high=)``. It ends after 20 answers in a row that are all right at
        the lowest level, or all wrong at the highest.

    Attributes
    ----------
    level : float
        What to ask next.
    done : bool
    gave_up : str or None
        Why it ended before all its turning points.

    Examples
    --------
    >>> stairs = UpDown(first=0.4, factor=2, skip=0)
    >>> for right in (True, True, True, True, False):
    ...     stairs.answer(right)
    >>> stairs.level, stairs.turned
    (0.2, [0.1])
    >>> round(UpDown(first=0.4).target, 4)
    0.7071
    """

    def __init__(
        self,
        *,
        first: float,
        factor: float = 1.25,
        down: int = 2,
        weight: float = 1.0,
        reversals: int = 12,
        skip: int = 4,
        most_trials: int = 300,
        levels: Levels = LEVELS,
    ) -> None:
        low, high = levels.low, levels.high
        if not (1 < factor < math.inf and 0 < weight < math.inf and low <= first <= high):
            raise AnalysisError(
                f"first = {first:g}, factor = {factor:g}, weight = {weight:g}, low = {low:g}, high = {high:g}; a staircase "
                "needs low <= first <= high, factor > 1 and weight > 0, both finite"
            )
        if not (int(down) == down and down >= 1 and 0 <= skip < reversals and most_trials >= 1):
            raise AnalysisError(
                f"down = {down}, reversals = {reversals}, skip = {skip}, most_trials = {most_trials}; needs down = 1, 2, ..., "
                "0 <= skip < reversals and most_trials >= 1"
            )
        self.first, self.factor, self.down, self.weight = float(first), float(factor), int(down), float(weight)
        self.reversals, self.skip, self.low, self.high = int(reversals), int(skip), low, high
        self.level, self._row, self._heading = float(first), 0, 0
        self.most_trials, self.told, self._at_end = int(most_trials), 0, 0
        self.turned: list[float] = []
        self.gave_up: str | None = None

    @property
    def target(self) -> float:
        """The proportion of right answers towards which the staircase goes."""
        return (self.weight / (1 + self.weight)) ** (1 / self.down)

    @property
    def done(self) -> bool:
        """Whether the level has reversed as often as planned, or the staircase gave up at an end of its range."""
        return len(self.turned) >= self.reversals or self.gave_up is not None

    def answer(self, right: bool) -> None:
        """Record an answer at this level and set the next level.

        Parameters
        ----------
        right : bool
            Whether the answer was right.
        """
        self.told += 1
        self._at_end = self._at_end + 1 if self.level == (self.low if right else self.high) else 0
        self._step(right)
        if self._at_end >= ENOUGH:
            end = f"right {ENOUGH} times in a row at the lowest" if right else f"wrong {ENOUGH} times in a row at the highest"
            self.gave_up = f"{end} level, {self.level:.4g}, so the threshold lies beyond it"
        elif self.told >= self.most_trials and len(self.turned) < self.reversals:
            self.gave_up = (
                f"{self.told} trials gave {len(self.turned)} of {self.reversals} turning points, and {self.most_trials} "
                "trials are allowed"
            )

    def _step(self, right):
        self._row = self._row + 1 if right else 0
        if right and self._row < self.down:
            return
        self._row, heading = 0, -1 if right else 1
        if self._heading and heading != self._heading:
            self.turned.append(self.level)
        self._heading = heading
        step = (self.weight if heading > 0 else 1.0) * (2 if len(self.turned) < self.skip else 1)
        self.level = min(max(self.level * self.factor ** (heading * step), self.low), self.high)

    def estimate(self) -> float:
        """The geometric mean of the levels at the turning points, an even number of them, after the first ones."""
        if self.gave_up:
            raise AnalysisError(f"no estimate: {self.gave_up}. Ask again with a different low, high or most_trials")
        used = self.turned[self.skip :]
        used = used[len(used) % 2 :]
        if not used:
            raise AnalysisError(f"{len(self.turned)} turning points; the estimate needs {self.skip + 2}. Continue asking")
        return math.exp(float(np.mean(np.log(used))))

    def settles(self, curve: Psychometric, per_step: int = 1, most: int = 400) -> float:
        """The level at which a long staircase settles for an observer with this psychometric function.

        The staircase is a Markov chain over levels and right answers in a row; this is the geometric mean of the levels
        at which its stationary run turns, exact where ``weight`` is a multiple of 1/per_step.

        Parameters
        ----------
        curve : Psychometric
        per_step : int
            Lattice points of the chain in one step down.
        most : int
            Lattice points at most.
        """
        up = self.weight * per_step
        if abs(up - round(up)) > 1e-9:
            raise AnalysisError(f"weight = {self.weight:g} is not a multiple of 1/{per_step}; give per_step")
        grid = math.log(self.factor) / per_step
        below = min(int(math.log(self.first / self.low) / grid), most // 2)
        above = min(int(math.log(self.high / self.first) / grid), most // 2)
        levels = self.first * np.exp(grid * np.arange(-below, above + 1))
        return _turning_mean(levels, curve(levels), self.down, per_step, round(up))

    def __str__(self) -> str:
        return (
            f"{self.down} down, 1 up from {self.first:g}: steps of {self.factor:g} down and {self.factor**self.weight:.4g} up, "
            f"{self.reversals} turning points, towards {100 * self.target:.1f} % right"
        )


def _turning_mean(levels, P, down, step_down, step_up):
    """The geometric mean level at turning points of the stationary chain over (heading, row, level)."""
    N = len(levels)
    at = np.arange(N)
    lower, upper = np.maximum(at - step_down, 0), np.minimum(at + step_up, N - 1)

    def state(heading, row, place):
        return (heading * down + row) * N + place

    move, turns = np.zeros((2 * down * N, 2 * down * N)), np.zeros(2 * down * N)
    for heading in (0, 1):  # the last step went down, up
        for row in range(down):
            here = state(heading, row, at)
            move[here, state(1, 0, upper)] += 1 - P
            if row + 1 < down:
                move[here, state(heading, row + 1, at)] += P
            else:
                move[here, state(0, 0, lower)] += P
            turns[here] += (1 - P) if heading == 0 else P * (row + 1 == down)
    balance = move.T - np.eye(len(move))
    balance[-1] = 1.0  # one of the balances follows from the others; the probabilities add up to one
    stationary = np.linalg.solve(balance, np.r_[np.zeros(len(move) - 1), 1.0])
    weight = (stationary * turns).reshape(-1, N).sum(0)
    return float(np.exp(weight @ np.log(levels) / weight.sum()))
