"""Figures of sweeps, with limits drawn across."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.drawing import FRAME, SHOWN, STYLES, axis_label, colour_map, house_style, new_figure, outline, scale_axis
from ...errors import AnalysisError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure

    from ...limits.limit import Limit
    from ..sweeps.sweep import Sweep

LIMIT_DASHES = [(0, (1, 1)), (0, (6, 2)), (0, (4, 1, 1, 1))]
NONE = "#e4e4e4"
#: two axes with at most this many values of one are drawn as lines, else as a map
FAMILY = len(STYLES)


def plot_sweep(result: Sweep, *, limits: Limit | Sequence[Limit] | Mapping[str, Limit | Sequence[Limit]] | None = None) -> Figure:
    """Draw a sweep: lines over one axis, a line for each value of a short second axis, or a map over two.

    Parameters
    ----------
    result : Sweep
    limits : Limit, sequence of Limit, or dict of str to Limit or to a sequence of Limit, optional
        Stiffness limits, drawn across the axis whose unit is N/m and labelled with what they are. A sequence under one
        name holds a limit for each line, in its colour, or on a map a curve: one for each value of the other axis.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    AnalysisError
        For more than two axes, and for limits where no axis is a stiffness.
    """
    if len(result.axes) not in (1, 2):
        raise AnalysisError(f"the sweep has {len(result.axes)} axes; a plot shows 1 or 2. Sweep fewer, or fix some values")
    with house_style():
        figure = new_figure(height=4.2)
        axes = figure.subplots()
        shown = _lines(axes, result) if _short_axis(result) is not None else _map(figure, axes, result)
        _draw_limits(axes, result, shown, _as_dict(limits))
    return figure


def _lines(axes, result):
    """Draw one line a value of the short axis; return the names on the x axis and the y axis."""
    names, short = list(result.axes), _short_axis(result)
    over = names[1 - short] if len(names) == 2 else names[0]
    scale, label = axis_label(result.metric, result.unit)
    x_scale, x_label = axis_label(over, result.units.get(over, "1"))
    values = np.moveaxis(result.values, short, 0) if len(names) == 2 else result.values[None]
    for number, line in enumerate(values):
        text = None
        if len(names) == 2:
            factor, unit = SHOWN.get(result.units.get(names[short]), (1, result.units.get(names[short], "1")))
            text = f"{names[short]} = {factor * result.axes[names[short]][number]:.4g} {unit}"
        style = STYLES[number % len(STYLES)]
        axes.plot(x_scale * result.axes[over], scale * line, marker="." if len(line) <= 30 else None, label=text, **style)
    axes.set_xlabel(x_label)
    axes.set_ylabel(label)
    scale_axis(axes, "x", x_scale * result.axes[over])
    _show_whole_axis(axes, x_scale * result.axes[over])
    if np.isnan(values).all():
        axes.text(0.5, 0.5, "not known anywhere", transform=axes.transAxes, ha="center")
        axes.set_yticks([])
    if len(names) == 2:
        axes.legend(**FRAME)
    return over, None


def _show_whole_axis(axes, swept):
    """Make room for all that was swept, also where nothing is known there."""
    axes.update_datalim([(x, 0.0) for x in swept], updatey=False)
    axes.autoscale_view(scaley=False)


def _map(figure, axes, result):
    """Draw a grey-safe map, zero apart in light grey and nan left white; the first axis runs to the right."""
    across, up = result.axes
    scale, label = axis_label(result.metric, result.unit)
    (x_scale, x_label), (y_scale, y_label) = (axis_label(name, result.units.get(name, "1")) for name in (across, up))
    x, y = x_scale * result.axes[across], y_scale * result.axes[up]
    values = np.ma.masked_invalid(scale * result.values.T)
    least = values[values > 0].min() if (values >= 0).all() and (values > 0).any() else None
    colours = colour_map("cividis").with_extremes(under=NONE)
    image = axes.pcolormesh(x, y, values, shading="nearest", cmap=colours, vmin=least, rasterized=True)
    if least is None:
        figure.colorbar(image, ax=axes, label=label)
    else:
        figure.colorbar(image, ax=axes, extend="min", label=f"{label}\nlight: none")
    axes.set(xlabel=x_label, ylabel=y_label)
    scale_axis(axes, "x", x)
    scale_axis(axes, "y", y)
    axes.grid(False)
    return across, up


def _draw_limits(axes, result, shown, limits):
    """Draw stiffness limits as dashes of their own."""
    if not limits:
        return
    stiff = [name for name in shown if name and result.units.get(name) == "N/m"]
    if not stiff:
        raise AnalysisError("limits are stiffnesses, so a plot of them needs an axis in N/m, such as k")
    on_map, upright = shown[1] is not None, stiff[0] == shown[0]
    for number, (text, limit) in enumerate(limits.items()):
        style = {"color": "#4d4d4d", "linestyle": LIMIT_DASHES[number % 3], "linewidth": 2.2}
        if on_map:  # black with a white edge is seen on light and dark alike
            style |= {"color": "black", "path_effects": [outline(4.2)]}
        if np.ndim(limit) and not on_map:
            _draw_family(axes, text, limit, result, style)
        elif np.ndim(limit):
            other = shown[1] if upright else shown[0]
            K, along = [float(one) for one in limit], _curve_axis(result, other, len(limit))
            axes.plot(*((K, along) if upright else (along, K)), label=text, **style)
        else:
            side = "to the left" if upright else "below"
            label = f"{text}: {float(limit):.4g} N/m, holds {side}"
            (axes.axvline if upright else axes.axhline)(float(limit), label=label, **style)
    axes.legend(**FRAME)


def _draw_family(axes, text, limits, result, style):
    """Draw one limit a line, in the line's colour."""
    lines = len(result.axes[list(result.axes)[_short_axis(result)]]) if len(result.axes) == 2 else 1
    if len(limits) != lines:
        raise AnalysisError(f"{len(limits)} limits for {lines} line(s); give one limit for each line, or a single one")
    for number, limit in enumerate(limits):
        colour = STYLES[number % len(STYLES)]["color"]
        axes.axvline(float(limit), **{**style, "color": colour}, label=None if number else f"{text}, in each line's colour")


def _curve_axis(result, name, length):
    if name is None or len(result.axes[name]) != length:
        raise AnalysisError(f"a curve of {length} limits; needs a map and a limit for each value of its other axis")
    return axis_label(name, result.units.get(name, "1"))[0] * result.axes[name]


def _as_dict(limits):
    if limits is None or isinstance(limits, dict):
        return limits
    several = limits if isinstance(limits, (list, tuple)) else [limits]
    return {limit.kind: limit for limit in several}


def _short_axis(result):
    """The axis with few enough values for a line each, 0 where there is one axis, or None."""
    lengths = [len(a) for a in result.axes.values()]
    if len(lengths) == 1:
        return 0
    short = int(np.argmin(lengths))
    return short if lengths[short] <= FAMILY else None
