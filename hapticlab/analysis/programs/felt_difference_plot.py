"""The figure of a felt difference: both forces over time, and below them how much of each threshold is reached."""

import numpy as np

from ...base.drawing import STYLES, forbid, house_style, new_figure


def plot_difference(found):
    """Draw the forces of two scenes over one motion, and their difference over the thresholds.

    Parameters
    ----------
    found : FeltDifference

    Returns
    -------
    matplotlib.figure.Figure
    """
    window = found.thresholds.window
    at = window * (np.arange(len(found.force)) + 0.5)
    with house_style():
        figure = new_figure(height=5.0)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        for F, label, style in zip((found.full, found.smaller), ("full scene", "smaller scene"), STYLES, strict=False):
            upper.plot(found.t, F, label=label, **style)
        upper.set_ylabel("force F [N]")
        upper.legend()
        parts = (found.force, "as a force"), (found.vibration, "as a vibration"), (found.own_vibration, "the encoder's own")
        for (part, label), style in zip(parts, STYLES, strict=False):
            lower.plot(at, np.maximum(part, 1e-3), label=label, marker="o", markersize=3, **style)
        lower.set_yscale("log")
        lower.set_ylim(bottom=0.1 * lower.get_ylim()[0])  # room for the legend
        forbid(lower, 1.0, "noticed")
        lower.set_ylabel("over the threshold")
        lower.set_xlabel("time t [s]")
        lower.legend(fontsize="small", ncols=2, loc="lower right")
    return figure
