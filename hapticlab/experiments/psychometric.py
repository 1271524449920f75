"""Fit a psychometric function by maximum likelihood, with its lapses, its intervals and whether it fits at all."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.arguments import choice
from ..base.drawing import COLD, WARM, house_style, new_figure, scale_axis, style_of
from ..base.shows_itself import ShowsItself
from ..base.statistics import chi_squared
from ..errors import AnalysisError
from .likelihood import MOST_LAPSES, Likelihood
from .response_curves import SHAPES, Psychometric

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ..base.annotations import Array
    from .response_curves import Shape

#: samples from which on they say how much less likely than the best an interval's end may be
ENOUGH = 100


@dataclass(frozen=True, eq=False)
class PsychometricFit(ShowsItself):
    """A psychometric function and what is known of it.

    Attributes
    ----------
    curve : Psychometric
    levels, right, trials : array
        What was fitted: at each level so many right answers of so many trials.
    interval : dict of str to (float, float)
        Of threshold and slope, by the likelihood's ratio.
    confidence : float
    deviance : float
        2 log of the likelihood ratio between a free proportion at each level and the curve.
    p_deviance : float
        Part of bootstrap samples with a larger deviance; below 0.05 the curve does not fit, above 0.95 it fits too
        well. With single trials at most levels, as an adaptive procedure leaves them, it says little.
    notes : tuple of str
    """

    curve: Psychometric
    levels: Array
    right: Array
    trials: Array
    interval: dict[str, tuple[float, float]]
    confidence: float
    deviance: float
    p_deviance: float
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        shown = []
        for name in ("threshold", "slope"):
            low, high = self.interval[name]
            shown.append(f"{name} {getattr(self.curve, name):.4g} ({low:.4g} to {high:.4g})")
        head = f"{self.curve.shape} curve, {int(self.trials.sum())} trials at {len(self.levels)} levels: {', '.join(shown)}"
        tail = f"  lapses {self.curve.lapse:.2g}; deviance {self.deviance:.3g}, p = {self.p_deviance:.2f}"
        return "\n".join([f"{head}; {100 * self.confidence:g} % intervals", tail, *(f"  {note}" for note in self.notes)])

    def plot(self, unit: str = "1") -> Figure:
        """Draw the proportions, larger where more trials stand behind them, the curve and the threshold's interval."""
        with house_style():
            figure = new_figure(height=4.0)
            axes = figure.subplots()
            if self.curve.shape == "normal":
                span = np.linspace(self.levels.min(), self.levels.max(), 300)
            else:
                span = np.geomspace(self.levels[self.levels > 0].min() / 2, self.levels.max() * 1.2, 300)
                scale_axis(axes, "x", np.geomspace(span[0], max(span[-1], 10 * span[0]), 3))
            axes.plot(span, self.curve(span), **style_of(0), label=f"{self.curve.shape} curve")
            size = 20 + 160 * self.trials / self.trials.max()
            axes.scatter(self.levels, self.right / self.trials, size, facecolors="none", edgecolors=COLD,
                         label=f"answers, {int(self.trials.max())} in the largest circle")  # fmt: skip
            at, (low, high) = self.curve.threshold, self.interval["threshold"]
            axes.errorbar([at], [float(self.curve(at))], xerr=[[max(at - low, 0)], [max(high - at, 0)]], fmt="s", capsize=4,
                          color=WARM, label=f"threshold, {100 * self.confidence:g} % interval")  # fmt: skip
            axes.set(xlabel=f"level [{unit}]", ylabel="proportion of right answers", ylim=(-0.05, 1.05))
            figure.legend(loc="outside upper center", ncols=2)
        return figure


@dataclass(frozen=True, kw_only=True)
class Intervals(ShowsItself):
    """The confidence of the intervals of a fit, and the number of bootstrap samples.

    Parameters
    ----------
    confidence : float
        Of the intervals, between 0 and 1.
    bootstrap : int
        Samples for the goodness of fit and the intervals, >= 1.
    seed : int
        Of the samples.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.people.Intervals(confidence=0.9)
    Intervals(confidence=0.9, bootstrap=400, seed=0)
    """

    confidence: float = 0.95
    bootstrap: int = 400
    seed: int = 0

    def __post_init__(self) -> None:
        if not (isinstance(self.bootstrap, (int, np.integer)) and self.bootstrap >= 1 and 0 < self.confidence < 1):
            raise AnalysisError(
                f"bootstrap = {self.bootstrap!r}, confidence = {self.confidence!r}; needs a whole number of samples >= 1 and a "
                "confidence between 0 and 1, such as 0.95"
            )


INTERVALS = Intervals()


def psychometric(
    levels: ArrayLike,
    right: ArrayLike,
    trials: ArrayLike | None = None,
    *,
    shape: Shape = "d_prime",
    guess: float | None = 0.5,
    lapse: float | None = None,
    slope: float | None = None,
    intervals: Intervals = INTERVALS,
) -> PsychometricFit:
    """Fit a psychometric function by maximum likelihood to answers at several levels.

    F. A. Wichmann and N. J. Hill, *Perception & Psychophysics* 63 (2001) 1293 and 1314: the lapses are fitted beside
    threshold and slope, and the goodness of fit comes from samples drawn of the fitted curve. These treat the levels as
    fixed also where a procedure placed them by the answers. The intervals are those of the likelihood's ratio: each
    value of the threshold for which some slope and lapses explain the answers nearly as well as the best, and the same
    for the slope. How nearly, samples of the fitted curve say, or chi-squared of one degree of freedom, whichever is
    wider; with fewer than 100 samples chi-squared alone. At seven levels of 40 trials 95 % intervals hold each in 95 %
    of 799 sets, by chi-squared alone in 94 %; at levels of 10 trials the slope in about 90 % either way. The likelihood
    does not depend on how levels were placed, and answers that are all right above a level and all wrong below leave
    the threshold anywhere in between.

    Parameters
    ----------
    levels : array
        Of any order; equal levels are put together. > 0 or 0 unless ``shape="normal"``.
    right : array
        Right answers at each level; 0 or 1 for single trials.
    trials : array, optional
        Trials behind each entry; one each if left out.
    shape : {"d_prime", "weibull", "normal"}
    guess : float or None
        Part right by guessing, 1/2 for two alternatives; None: as many as lapses, for "which one is stronger".
    lapse : float, optional
        Fixed; fitted in 0 ... 0.06 if left out.
    slope : float, optional
        Fixed; fitted if left out. 1 for ``d_prime`` is an observer whose noise does not depend on the level; few trials
        tell a threshold much better with it than without.
    intervals : Intervals
        How sure the intervals are, and by how many samples: ``hl.people.Intervals(confidence=, bootstrap=, seed=)``.

    Returns
    -------
    PsychometricFit

    Raises
    ------
    AnalysisError
        For counts that are none, and answers that say nothing of a threshold.

    Examples
    --------
    >>> few = Intervals(bootstrap=100)
    >>> found = psychometric([0.05, 0.1, 0.2, 0.4], [22, 27, 32, 39], [40] * 4, lapse=0.0, intervals=few)
    >>> round(found.curve.threshold, 2)
    0.17
    """
    bootstrap, confidence = intervals.bootstrap, intervals.confidence
    levels, right, trials = _counts(levels, right, trials)
    choice("shape", shape, SHAPES)
    if lapse is not None and not 0 <= lapse < 0.5:
        raise AnalysisError(f"lapse = {lapse:g}; needs 0 <= lapse < 0.5, or None to fit it")
    if slope is not None and not 0 < slope < math.inf:
        raise AnalysisError(f"slope = {slope:g}; needs slope > 0, or None to fit it")
    if guess is not None and not 0 <= guess < 1 - (MOST_LAPSES if lapse is None else lapse):
        raise AnalysisError(f"guess = {guess:g}; needs guess >= 0 and guess + lapse < 1, or None for one as large as the lapse")
    _check_telling(levels, right, trials, shape)
    fitting = Likelihood(levels, trials, shape, guess, lapse, slope)
    starts = fitting.starts()
    climbed, losses = fitting.most_likely(np.tile(right, (len(starts), 1)), starts)
    found, curve = climbed[losses.argmin()], fitting.curve(climbed[losses.argmin()])
    drawn = np.random.default_rng(intervals.seed).binomial(trials.astype(int), curve(levels), (bootstrap, len(levels)))
    _, its_losses = fitting.most_likely(drawn, np.tile(found, (bootstrap, 1)))
    deviance = 2 * float(losses.min() - fitting.saturated(right))
    p = float(np.mean(2 * (its_losses - fitting.saturated(drawn)) >= deviance))
    most = np.full(2, chi_squared(confidence))
    if bootstrap >= ENOUGH:
        most = np.maximum(most, np.quantile(fitting.ratios(drawn, found, its_losses), confidence, axis=0))
    ends = fitting.intervals(right, found, most)
    low, high = (fitting.curve(np.r_[end, found[2:]]) for end in ends.T)
    interval = {name: (getattr(low, name), getattr(high, name)) for name in ("threshold", "slope")}
    notes = _left_open(found, ends, fitting)
    return PsychometricFit(curve, levels, right, trials, interval, confidence, deviance, p, notes)


def _left_open(q, ends, fitting):
    """Notes on a threshold or a slope that these levels do not bound."""
    notes = []
    for name, at, (low, high), least, most in zip(("threshold", "slope"), q, ends, fitting.low, fitting.high, strict=False):
        near = 1e-6 * (most - least)
        if min(at - least, most - at) < near:  # never of what is fixed
            notes.append(f"the {name} is at the end of the range that was searched, so these levels do not determine it")
        elif min(low - least, most - high) < near:
            way = "below" if low - least < near else "above"
            notes.append(
                f"the interval of the {name} ends at the end of the range that was searched, so these levels do "
                f"not bound it {way}"
            )
    return tuple(notes)


def _counts(levels: ArrayLike, right: ArrayLike, trials: ArrayLike | None) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    levels, right = np.atleast_1d(np.asarray(levels, float)), np.atleast_1d(np.asarray(right, float))
    trials = np.ones_like(levels) if trials is None else np.atleast_1d(np.asarray(trials, float))
    if not (levels.shape == right.shape == trials.shape and levels.ndim == 1 and len(levels)):
        raise AnalysisError(
            f"levels, right and trials have shapes {levels.shape}, {right.shape}, {trials.shape}; needs one entry per level "
            "in each"
        )
    whole = (right == np.round(right)).all() and (trials == np.round(trials)).all()
    if not (np.isfinite(levels).all() and whole and (trials > 0).all() and (right >= 0).all() and (right <= trials).all()):
        raise AnalysisError("right and trials count answers: needs whole numbers, 0 <= right <= trials, and finite levels")
    at, place = np.unique(levels, return_inverse=True)
    return at, np.bincount(place, right), np.bincount(place, trials)


def _check_telling(levels, right, trials, shape):
    if shape != "normal" and levels.min() < 0:
        raise AnalysisError(f"a level of {levels.min():g}; {shape} needs levels >= 0, or shape='normal' for both signs")
    if len(levels) < 2 or right.sum() in (0, trials.sum()):
        raise AnalysisError(
            f"{int(right.sum())} of {int(trials.sum())} answers right at {len(levels)} level(s); a threshold needs right "
            "and wrong answers at two levels or more. Ask at more levels"
        )
