"""The psi method: each trial asks where the answer is expected to tell most of threshold and slope."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.shows_itself import ShowsItself
from ..errors import AnalysisError
from .likelihood import CERTAIN
from .response_curves import rise

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..base.annotations import Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Grid(ShowsItself):
    """The levels, thresholds and slopes over which the psi method keeps its belief.

    Parameters
    ----------
    levels, thresholds : int
        Points from the lowest to the highest level, >= 2.
    slopes : sequence of float
        Slopes that are thought possible, equally likely, > 0; one alone fixes it.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.people.Grid(slopes=[1.0]).levels
    40
    """

    levels: int = 40
    thresholds: int = 60
    slopes: Sequence[float] | Array = (0.5, 0.71, 1.0, 1.41, 2.0, 2.83)

    def __post_init__(self) -> None:
        if not (self.levels >= 2 and self.thresholds >= 2 and all(s > 0 for s in self.slopes)):
            raise AnalysisError(
                f"{self.levels} levels, {self.thresholds} thresholds, slopes = {self.slopes}; psi needs two points of each, and "
                "positive slopes"
            )


GRID = Grid()


class Psi(ShowsItself):
    """Bayesian adaptive estimation of threshold and slope; L. L. Kontsevich and C. W. Tyler, *Vision Res.* 39 (1999) 2729.

    A probability of every threshold and slope on a grid is kept; the next level is the one whose answer is expected to
    leave the least entropy.

    Parameters
    ----------
    low, high : float
        Ends of the levels that may be asked; thresholds between them are thought equally likely in their logarithm.
    grid : Grid
        How many levels and thresholds between them, and which slopes: ``hl.people.Grid(levels=, thresholds=,
        slopes=)``.
    lapse : float
        Taken as known, 0 <= lapse < 1 - guess; a small one keeps a single slip from ruling out the truth.
    guess : float
        >= 0.
    shape : {"d_prime", "weibull"}
    most_trials : int
        After which it ends.

    Attributes
    ----------
    level : float
        What to ask next.
    belief : array, shape (thresholds, slopes)
        Probabilities.

    Examples
    --------
    >>> psi = Psi(low=0.02, high=1.0, most_trials=3)
    >>> for right in (True, True, False):
    ...     psi.answer(right)
    >>> psi.done, 0.02 < psi.estimate() < 1
    (True, True)
    """

    def __init__(
        self,
        *,
        low: float,
        high: float,
        grid: Grid = GRID,
        lapse: float = 0.02,
        guess: float = 0.5,
        shape: Literal["d_prime", "weibull"] = "d_prime",
        most_trials: int = 60,
    ) -> None:
        if not (0 < low < high and most_trials >= 1):
            raise AnalysisError(
                f"low = {low:g}, high = {high:g}, most_trials = {most_trials}; psi needs 0 < low < high and at least one trial"
            )
        if shape not in ("d_prime", "weibull"):
            raise AnalysisError(f"shape = {shape!r}; psi needs 'd_prime' or 'weibull', whose levels are positive")
        if not (0 <= guess and 0 <= lapse and guess + lapse < 1):
            raise AnalysisError(f"guess = {guess!r}, lapse = {lapse!r}; psi needs both >= 0 and guess + lapse < 1")
        self.levels, self.thresholds = (np.geomspace(low, high, many) for many in (grid.levels, grid.thresholds))
        self.slopes, self.most_trials, self.told = np.array(grid.slopes, float), int(most_trials), 0
        place, log_slope = np.log(self.thresholds)[:, None, None], np.log(self.slopes)[None, :, None]
        right = guess + (1 - guess - lapse) * rise(shape, self.levels, place, log_slope)[0]
        self._right = np.clip(right, CERTAIN, 1 - CERTAIN)  # no answer is impossible, or one could rule out everything
        self.belief = np.full((grid.thresholds, len(self.slopes)), 1.0 / (grid.thresholds * len(self.slopes)))

    @property
    def done(self) -> bool:
        """Whether as many answers as were planned are in."""
        return self.told >= self.most_trials

    @property
    def level(self) -> float:
        """The level of the next trial, ln(comparison/standard): the level whose answer is expected to teach most."""
        return float(self.levels[np.argmin(self.expected_entropy())])

    def expected_entropy(self) -> Array:
        """The entropy [nat] that an answer at each level is expected to leave."""
        total = np.zeros(len(self.levels))
        for chance in (self._right, 1 - self._right):
            joint = self.belief[:, :, None] * chance
            some = joint.sum((0, 1))
            total += some * np.log(some) - np.where(joint > 0, joint * np.log(np.maximum(joint, 1e-300)), 0.0).sum((0, 1))
        return total

    def answer(self, right: bool) -> None:
        """Take an answer at :attr:`level`.

        Parameters
        ----------
        right : bool
            Whether the answer was right.
        """
        chance = self._right[:, :, np.argmin(self.expected_entropy())]
        belief = self.belief * (chance if right else 1 - chance)
        self.belief, self.told = belief / belief.sum(), self.told + 1

    def estimate(self) -> float:
        """The threshold estimate, from the mean of its logarithm over the posterior."""
        return float(np.exp(self.belief.sum(1) @ np.log(self.thresholds)))

    def interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Thresholds between which this fraction of the posterior lies, with equal tails.

        Parameters
        ----------
        confidence : float
            The fraction, 0 ... 1.
        """
        mass = np.cumsum(self.belief.sum(1)) - self.belief.sum(1) / 2
        tail = (1 - confidence) / 2
        low, high = np.interp([tail, 1 - tail], mass, np.log(self.thresholds))
        return float(np.exp(low)), float(np.exp(high))

    def __str__(self) -> str:
        return f"psi, {self.most_trials} trials at levels from {self.levels[0]:.3g} to {self.levels[-1]:.3g}"


class ConstantLevels(ShowsItself):
    """Method of constant stimuli: each level a number of times, in an order drawn from the seed.

    Parameters
    ----------
    levels : sequence of float
        Levels of the trials, ln(comparison/standard), one or more.
    repeats : int
        How often each is presented, >= 1.
    seed : int
        Of the order.

    Examples
    --------
    >>> asked = ConstantLevels([0.1, 0.2], repeats=2, seed=1)
    >>> sorted(asked.order)
    [0.1, 0.1, 0.2, 0.2]
    """

    def __init__(self, levels: Sequence[float] | Array, *, repeats: int, seed: int = 0) -> None:
        if not (len(levels) and repeats >= 1):
            raise AnalysisError(f"{len(levels)} levels, {repeats} times; needs at least one of each")
        levels = [float(a) for a in levels]
        self.order = np.random.default_rng(seed).permutation(np.repeat(levels, repeats)).tolist()
        self.told, self._words = 0, f"{len(levels)} levels, {repeats} times each"

    @property
    def done(self) -> bool:
        """Whether each level was answered as often as planned."""
        return self.told >= len(self.order)

    @property
    def level(self) -> float:
        """The level of the next trial, ln(comparison/standard)."""
        return self.order[self.told]

    def answer(self, right: bool) -> None:
        """Record an answer, which does not affect the next levels.

        Parameters
        ----------
        right : bool
            Whether the answer was right.
        """
        self.told += 1

    def __str__(self) -> str:
        return self._words
