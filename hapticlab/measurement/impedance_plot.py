"""A measured impedance as a picture: what was rendered, what the law says, what was meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.drawing import FRAME, WARM, house_style, log_scales, new_figure, style_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .measured import MeasuredImpedance


def plot_impedance(found: MeasuredImpedance) -> Figure:
    """Draw |Z| and Re Z over frequency, and transparency where the ideal is known."""
    panels = 3 if found.ideal is not None else 2
    with house_style():
        figure = new_figure(height=2.6 * panels)
        axes = figure.subplots(panels, 1, sharex=True)
        f = found.frequency
        curves = [("law alone, held", found.law)] + ([("ideal", found.ideal)] if found.ideal is not None else [])
        for i, (label, Z) in enumerate(curves):
            axes[0].plot(f, abs(Z), **style_of(i + 1), label=label)
            axes[1].plot(f, Z.real, **style_of(i + 1))
        axes[0].plot(f, abs(found.rendered), "o", color="black", markersize=4, label="measured")
        axes[1].errorbar(f, found.rendered.real, np.nan_to_num(found.radius), fmt="o", color="black", markersize=4, capsize=2)
        axes[0].set(ylabel="|Z| [N s/m]", title="rendered impedance Z = F/v")
        log_scales(axes[0])
        axes[1].axhline(0, color="0.5", linewidth=0.8)
        axes[1].set(ylabel="Re Z [N s/m]")
        axes[0].legend(loc="best", **FRAME)
        if panels == 3:
            ratio = found.transparency
            small = {"markersize": 4, "linewidth": 1}
            if found.drive == "hand":
                at_handle = abs(found.transparency_at_handle)
                axes[2].plot(f, at_handle, **style_of(2), label="|Z at the handle, device included / ideal|")
                axes[2].set_ylim(top=min(1.05 * at_handle.max(), 4), bottom=-1.5)
            axes[2].plot(f, abs(ratio), "o-", color="black", label="|Z / ideal|", **small)
            axes[2].plot(f, np.angle(ratio, deg=True) / 90, "s--", color=WARM, label="angle / 90 degrees", **small)
            axes[2].set(ylabel="transparency [1]")
            axes[2].legend(loc="best", **FRAME)
        axes[-1].set(xlabel="frequency [Hz]")
    return figure
