"""Pictures of what was searched: the trials of a stiffness, the border of the Z-width."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.drawing import FRAME, WARM, house_style, new_figure, style_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .largest_stiffness import LargestStiffness
    from .z_width import ZWidth


def plot_search(found: LargestStiffness) -> Figure:
    """Draw a search's trials over their number, stood or chattered, and the limits of theory as lines."""
    with house_style():
        figure = new_figure(height=3.6)
        axes = figure.add_subplot()
        number, K = np.arange(1, len(found.trials) + 1), np.array([t.K for t in found.trials])
        outcome = [t.stands for t in found.trials]
        stands, chatters, unclear = (np.array([o is which for o in outcome], bool) for which in (True, False, None))
        axes.plot(number, K, color="0.75", linewidth=1)
        axes.plot(number[stands], K[stands], "o", color="black", label="comes to rest")
        axes.plot(number[chatters], K[chatters], "X", color=WARM, markersize=8, label="chatters")
        if unclear.any():
            axes.plot(number[unclear], K[unclear], "s", color="0.4", fillstyle="none", label="undecided")
        for i, (name, limit) in enumerate(found.theory.items()):
            if 0 < limit.K < 1e9:
                axes.axhline(limit.K, **style_of(i + 2), label=f"{name}: {limit.K:.4g} N/m")
        answer = f"{found.K:.4g} N/m stands" if found.K > 0 else "undecided" if np.isnan(found.K) else "none stands"
        axes.set(yscale="log", xlabel="trial", ylabel="stiffness K [N/m]", title=f"{found.law}: {answer}")
        axes.xaxis.get_major_locator().set_params(integer=True)
        axes.legend(loc="lower right" if found.K > 0 else "upper right", **FRAME)
    return figure


def plot_border(width: ZWidth) -> Figure:
    """Draw the border of a Z-width: what stood, what chattered, and the lines of theory."""
    with house_style():
        figure = new_figure(height=4.2)
        axes = figure.add_subplot()
        top = np.where(np.isfinite(width.chatters_at), width.chatters_at, width.K)
        axes.fill_between(width.B, 0, width.K, color="0.92")
        for i, (name, label) in enumerate((("stability", "exact stability"), ("passivity", "passivity, any passive hand"))):
            known = np.isfinite(getattr(width, name))  # 0 too: no stiffness is promised there
            if known.any():
                axes.plot(width.B[known], getattr(width, name)[known], **style_of(i + 1), marker=".", label=label)
        axes.plot(width.B, top, "x", color=WARM, label="does not stand")
        axes.plot(width.B, width.K, "o-", color="black", markersize=4, linewidth=1, label="comes to rest")
        # a lossless corner of theory may lie far above; the picture is of the border
        axes.set_ylim(0, 1.25 * np.nanmax([*top, 1.0]))
        axes.set(xlabel="virtual damping B [N s/m]", ylabel="stiffness K [N/m]", title=f"Z-width, law {width.law}")
        axes.legend(loc="best", **FRAME)
    return figure
