"""Pictures of what was searched: the trials of a stiffness, the borders of the Z-width."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.drawing import COLD, WARM, house_style, new_figure, style_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .largest_stiffness import LargestStiffness
    from .z_width import ZWidth


#: how a trial is marked, by its outcome
MARKS: dict[str, dict[str, Any]] = {
    "quiet": {"marker": "o", "color": "black", "label": "comes to rest quietly"},
    "buzzes": {"marker": "^", "color": COLD, "label": "comes to rest, buzzes"},
    "unstable": {"marker": "X", "color": WARM, "markersize": 8, "label": "does not come to rest"},
    "undecided": {"marker": "s", "color": "0.4", "fillstyle": "none", "label": "undecided"},
}


def plot_search(found: LargestStiffness) -> Figure:
    """Draw a search's trials over their number, by their outcome, both borders as bands and the limits of theory as lines."""
    with house_style():
        figure = new_figure(height=4.6)
        axes = figure.add_subplot()
        K, outcome = np.array([t.K for t in found.trials]), np.array([t.outcome for t in found.trials])
        axes.plot(np.arange(1, len(K) + 1), K, color="0.75", linewidth=1)
        for name, mark in MARKS.items():
            at = np.flatnonzero(outcome == name)
            if len(at):
                axes.plot(at + 1, K[at], linestyle="", **mark)
        for border, color, what in ((found.unstable, WARM, "stability"), (found.buzz, COLD, "buzz")):
            if border.lowest > 0:
                label = f"where {what} ends, by the start"
                axes.axhspan(border.lowest, border.highest, color=color, alpha=0.2, linewidth=0, label=label)
        for i, (name, limit) in enumerate(found.theory.items()):
            if 0 < limit.K < 1e9:
                axes.axhline(limit.K, **style_of(i + 2), label=f"{name}: {limit.K:.4g} N/m")
        answer = f"{found.K:.4g} N/m" if found.K > 0 else "undecided" if np.isnan(found.K) else "none comes to rest quietly"
        axes.set(yscale="log", xlabel="trial", ylabel="stiffness K [N/m]", title=f"stiffest wall, law {found.law}: {answer}")
        axes.xaxis.get_major_locator().set_params(integer=True)
        if axes.get_legend_handles_labels()[1]:
            figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    return figure


def plot_border(width: ZWidth) -> Figure:
    """Draw both borders of a Z-width as bands over the starts, and the lines of theory."""
    with house_style():
        figure = new_figure(height=4.6)
        axes = figure.add_subplot()
        axes.fill_between(width.B, 0, width.K, color="0.92")
        for i, (name, label) in enumerate((("stability", "exact stability"), ("passivity", "passivity, any passive hand"))):
            known = np.isfinite(getattr(width, name))  # 0 too: no stiffness is promised there
            if known.any():
                axes.plot(width.B[known], getattr(width, name)[known], **style_of(i + 1), marker=".", label=label)
        for border, color, label in ((width.unstable, WARM, "comes to rest"), (width.buzz, COLD, "no buzz felt")):
            axes.fill_between(width.B, *border.T, color=color, alpha=0.3)
            axes.plot(width.B, border[:, 0], ".-", color=color, linewidth=1, label=f"{label}: up to here, by the start")
        # a lossless corner of theory may lie far above; the picture is of the borders
        axes.set_ylim(0, 1.25 * np.nanmax([*width.unstable[:, 1], 1.0]))
        axes.set(xlabel="virtual damping B [N s/m]", ylabel="stiffness K [N/m]", title=f"Z-width, law {width.law}")
        figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    return figure
