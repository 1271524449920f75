"""Confidence intervals side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.drawing import COLD, WARM, house_style, new_figure
from ..base.profile.estimate import Estimate
from ..errors import AnalysisError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

#: up to so many intervals have a name and their numbers each
NAMED = 12
#: an interval wider than so many times the median is cut off at the edge of the axis
WIDE = 4.0


def plot_intervals(intervals: Mapping[str, Estimate | tuple[float, float]], *, label: str, true: float | None = None) -> Figure:
    """Draw confidence intervals below each other, with their numbers; those that miss a known true value are marked.

    The axis suits the narrower intervals, so that they can be compared; a much wider one reaches beyond it.

    Parameters
    ----------
    intervals : dict of str to Estimate or (low, high)
        In one unit. More than 12 are drawn without names and numbers.
    label : str
        Of the axis, with the unit.
    true : float, optional
        Drawn as a dashed line.

    Examples
    --------
    >>> import hapticlab as hl
    >>> figure = hl.identify.plot_intervals({"first": (4.2, 5.1), "second": (4.9, 5.4)}, label="b/m [1/s]", true=5.0)
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['4.65 ± 0.45', '5.15 ± 0.25']
    """
    if not intervals:
        raise AnalysisError('plot_intervals of no interval; needs a dict such as {"spin-down": found["b/m"]}')
    ends = np.array([(i.low, i.high) if isinstance(i, Estimate) else i for i in intervals.values()], float)
    misses = np.zeros(len(ends), bool) if true is None else (true < ends[:, 0]) | (ends[:, 1] < true)
    named, rows = len(ends) <= NAMED, np.arange(len(ends))
    with house_style():
        figure = new_figure(height=1.2 + 0.36 * len(ends) if named else 4.2)
        axes = figure.subplots()
        low, high = _span(ends, true)
        for missing, colour, width in ((False, COLD, 1.6), (True, WARM, 3.2)):
            some = rows[misses == missing]
            if len(some):
                word = None if true is None else f"{len(some)} {'miss' if missing else 'contain'} the true value"
                axes.hlines(some, ends[some, 0], ends[some, 1], colors=colour, linewidth=width, label=word)
        if named:
            axes.plot(ends.mean(1), rows, "o", color="black")
            for row, (a, b) in enumerate(ends):
                axes.annotate(
                    f"{(a + b) / 2:.3g} ± {(b - a) / 2:.2g}", (1.01, row), xycoords=("axes fraction", "data"), va="center"
                )
        if true is not None:
            axes.axvline(true, color="black", linestyle="--", label=f"true value {true:.4g}")
            figure.legend(loc="outside upper center", ncols=3)
        axes.set(xlabel=label, xlim=(low, high), ylim=(len(ends) - 0.5, -0.5))
        axes.set_yticks(rows if named else [], list(intervals) if named else [])
    told = [f"{name} {a:.3g} to {b:.3g}" for name, (a, b) in zip(intervals, ends, strict=True)] if named else []
    if true is not None:
        told.append(f"{misses.sum()} of {len(ends)} miss the true value {true:.4g}")
    figure.alt = f"Intervals of {label}: {'; '.join(told)}."
    return figure


def _span(ends, true):
    """Return the ends of an axis that shows the narrower intervals, and the true value."""
    widths = ends[:, 1] - ends[:, 0]
    narrow = ends[widths <= WIDE * np.median(widths)]
    shown = np.r_[narrow.ravel(), [] if true is None else [true]]
    margin = 0.15 * (np.ptp(shown) or 1.0)
    return shown.min() - margin, shown.max() + margin
