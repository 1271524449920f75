"""The figure of a reduction: two impedances over frequency, and how much the difference is beside hand and paddle."""

import numpy as np

from ...base.drawing import STYLES, forbid, house_style, new_figure


def plot_reduction(offer):
    """Draw the impedance of a scene and of its reduction, and below it their difference.

    Parameters
    ----------
    offer : Reduction

    Returns
    -------
    matplotlib.figure.Figure
    """
    with house_style():
        figure = new_figure(height=5.0)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        shown = (
            (offer.full_impedance, f"{offer.before} masses"),
            (offer.impedance, f"{offer.masses} left"),
        )
        for (Z, label), style in zip(shown, STYLES, strict=False):
            upper.loglog(offer.frequency, np.abs(Z), label=label, **style)
        upper.set_ylabel("|Z| [N s/m]")
        upper.legend()
        lower.loglog(offer.frequency, np.maximum(offer.error, 1e-16), **STYLES[0])
        forbid(lower, offer.tolerance, "above the tolerance")
        lower.set_ylim(bottom=max(1e-6 * offer.tolerance, 0.5 * max(np.min(offer.error), 1e-16)))  # below it is rounding
        lower.set_ylabel("relative error")
        lower.set_xlabel("frequency [Hz]")
        lower.legend()
    return figure
