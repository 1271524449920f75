"""The outcome of a fit: constants, each with a confidence interval, and how well they explain the record."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ..base.drawing import COLD, FRAME, STYLES, house_style, new_figure
from ..base.grid import Grid
from ..base.profile.estimate import Estimate
from ..base.shows_itself import Tabular
from ..errors import AnalysisError
from .sensor import DITHERED, explains, neighbours

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..base.annotations import Array

#: share of the largest from which on a constant is part of what a record leaves open
PART = 0.05
#: standard errors beyond a bound from which the motion is another than the model's; any, where it is not explained
BEYOND = 4.0


class Estimated(Tabular):
    """A result that holds an :class:`Estimate` for each of its constants, by name."""

    estimates: dict[str, Estimate]

    def __getitem__(self, name: str) -> Estimate:
        if name not in self.estimates:
            raise AnalysisError(f"{name!r} was not estimated; the estimates are {', '.join(self.estimates)}")
        return self.estimates[name]


@dataclass(frozen=True, eq=False)
class Found(Estimated):
    """Constants found from records; ``found["m"]`` is an :class:`Estimate`. Print it, or plot what it left.

    An identification has a class of its own below this one: ``about``, ``constants`` and what stands between add to it.

    The intervals cover as often as they say where the fit converged and the model explains the record, and are as narrow as
    any can be where noise dithers the counts (0.3 count of it and more was tried). The text says so where that is not so.

    Attributes
    ----------
    about, lacking, advice : str
        Whose constants they are, what the model leaves out, and what to record where a record does not tell them.
    above, bounded : tuple of str
        The constants that have to be found above zero, and those whose interval ends there at least.
    constants : dict of str to (str, str)
        Constant -> what it is called, and its unit.
    estimates : dict of str to Estimate
    confidence : float
    sigma : float
        Of the sensor's noise [m]; without dither counting is part of it.
    counted : bool
        Counts in dither, each by its own likelihood; else positions as numbers.
    quantum : float
        A count [m], 0 for a sensor that does not count.
    converged : bool
    correlation : float
        Between neighbouring residuals; near zero where the model explains the record.
    measured, fitted : array, shape (N,)
        Positions [m] of all records, one after the other.
    T : float
        [s]
    """

    about: ClassVar[str]
    lacking: ClassVar[str]
    advice: ClassVar[str]
    above: ClassVar[tuple[str, ...]]
    bounded: ClassVar[tuple[str, ...]]
    constants: ClassVar[dict[str, tuple[str, str]]]
    estimates: dict[str, Estimate]
    confidence: float
    sigma: float
    counted: bool
    quantum: float
    converged: bool
    correlation: float
    measured: Array
    fitted: Array
    T: float

    @property
    def dithered(self) -> bool:
        """Whether noise dithers the counts, if positions are counted."""
        return self.counted or not self.quantum

    @property
    def explained(self) -> bool:
        """Whether what is left looks like noise; without dither, like counting: less than a count does not show."""
        counting = 0.0 if self.dithered else self.quantum
        return bool(explains((self.measured - self.fitted)[:, None], self.measured[:, None], counting)[0])

    _hidden = ("about", "lacking", "advice", "above", "bounded", "constants")

    def _tables(self):
        grid = Grid.of(self.estimates, "value", "low", "high", "unit")
        called = [self.constants[name][0] for name in self.estimates]
        yield "", Grid({"": list(self.estimates), "constant": called, **{k: v for k, v in grid.columns.items() if k}})

    def __str__(self) -> str:
        lines = [f"{self.about} identified from {len(self.measured)} samples, {self.confidence:.0%} confidence:"]
        width = 2 + max(map(len, ("sensor", *(self.constants[name][0] for name in self.estimates))))
        lines += [f"  {self.constants[name][0]:<{width}}{found}" for name, found in self.estimates.items()]
        how = "noise" if self.dithered else "noise and counting"
        counts = f", counts of {1e6 * self.quantum:.3g} um" if self.quantum else ""
        lines.append(f"  {'sensor':<{width}}{how} {1e6 * self.sigma:.3g} um{counts}")
        if not self.explained:
            lines.append(
                f"  NOT EXPLAINED: neighbouring residuals correlate by {self.correlation:.2f}; an effect that is not in the "
                f"model moves the handle ({self.lacking}), and the intervals are too narrow"
            )
        if not self.converged:
            lines.append(
                "  NOT CONVERGED: a small change would fit better, and the intervals contain the true value less often than "
                f"{self.confidence:.0%}. Record longer, move the handle further with more force, or give known constants "
                "with known="
            )
        if not self.dithered:
            lines.append(
                f"  NOT DITHERED: noise is below {DITHERED:g} count, so samples share their rounding; the intervals come "
                "from quantising the fitted motion again. Move the handle over more counts to learn more"
            )
        return "\n".join(lines)

    def plot(self) -> Figure:
        """A figure: positions measured and fitted, and what is left."""
        t = np.arange(len(self.measured)) * self.T
        with house_style():
            figure = new_figure(height=5.2)
            above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
            above.plot(t, 1e3 * self.measured, ".", color="#8a8a8a", markersize=3, label="measured")
            above.plot(t, 1e3 * self.fitted, **STYLES[1], label="fitted")
            above.set(ylabel="handle position x [mm]", title="Positions and residuals")
            above.legend(**FRAME)
            below.plot(t, 1e6 * (self.measured - self.fitted), ".", color="#000000", markersize=2)
            below.axhspan(-2e6 * self.sigma, 2e6 * self.sigma, color=COLD, alpha=0.15, label="2 standard deviations")
            below.set(xlabel="time, records in sequence [s]", ylabel="residual [µm]")
            below.legend(loc="upper right", **FRAME)
        return figure


def told(made, y, fitted, names, *, quantum, T, confidence, beside=""):
    """Constants that a fit of one record found, as ``made``, a class of Found.

    Raises
    ------
    AnalysisError
        If the records leave a combination of the constants open, or ask for a constant below its bound.
    """
    left = np.abs(fitted.blind[0][: len(names)])
    if left.any():
        _open([name for name, part in zip(names, left, strict=True) if part > PART * left.max()], made.advice, beside)
    half, values = fitted.half_width(confidence)[:, 0], fitted.values[: len(names), 0]
    if vague := [name for name, value, width in zip(names, values, half, strict=False) if name in made.above and width >= value]:
        _open(vague, made.advice, beside)
    limit = BEYOND if explains(fitted.residuals, y[:, None], quantum)[0] else 0.0
    if past := [name for name, by in zip(names, fitted.beyond[:, 0], strict=False) if by > limit]:
        raise AnalysisError(
            f"identify: the best fit has a negative {' and '.join(past)}, so an effect is missing from the model "
            f"({made.lacking}), or a force has the wrong sign. Plot the record, and record {made.advice}"
        )
    lows = [0.0 if name in made.bounded else -np.inf for name in names]
    estimates = {
        name: Estimate(name, float(value), float(max(value - width, low)), float(value + width), made.constants[name][1])
        for name, value, width, low in zip(names, values, half, lows, strict=False)
    }
    rest, counted = fitted.residuals, bool(fitted.counted[0])
    lag = float(neighbours(rest, y[:, None], 0.0 if counted else quantum)[0])
    return made(
        estimates, confidence, float(fitted.sigma[0]), counted, quantum, bool(fitted.converged[0]), lag, y, y - rest[:, 0], T
    )  # fmt: skip


def _open(names, advice, beside):
    """Refuse constants that the records leave open."""
    raise AnalysisError(
        f"identify: these records do not determine {', '.join(names)} separately, or at all. Record {advice}; or estimate "
        f"fewer constants (known={{...}}){beside}"
    )
