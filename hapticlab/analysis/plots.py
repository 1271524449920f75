"""Figures of records, sweeps and limits; the only place where matplotlib opens.

Figures are made as objects, without pyplot: no window, no backend to choose, no list of open figures that grows. A
notebook shows what is returned (``_repr_png_``); a script calls ``savefig``.
"""

import io

import numpy as np

from ..errors import AnalysisError
from ..records import check_record

#: readable on a projector and in grey print: lines differ in dash and darkness, not in colour alone
STYLES = [
    {"color": "#000000", "linestyle": "-"},
    {"color": "#c1440e", "linestyle": "--"},
    {"color": "#1f6fb4", "linestyle": "-."},
    {"color": "#6b8e23", "linestyle": ":"},
    {"color": "#7a4a9c", "linestyle": (0, (5, 1, 1, 1, 1, 1))},
    {"color": "#8a8a8a", "linestyle": (0, (8, 3))},
]
LIMIT_DASHES = [(0, (1, 1)), (0, (6, 2)), (0, (4, 1, 1, 1))]
HOUSE = {
    "font.size": 11, "axes.grid": True, "grid.alpha": 0.35, "axes.spines.top": False, "axes.spines.right": False,
    "lines.linewidth": 1.6, "legend.frameon": False, "savefig.dpi": 150,
}  # fmt: skip
#: SI unit -> (what to multiply by, the unit an axis shows)
SHOWN = {"m": (1e3, "mm"), "J": (1e3, "mJ"), "s": (1e3, "ms")}
NAMES = {
    "x": "handle position x", "v": "handle velocity v", "F": "force F", "k": "stiffness k", "K": "stiffness K",
    "B": "virtual damping B", "T": "sampling period T", "m": "handle mass m", "b": "handle damping b", "delay": "delay",
    "x_o": "wall boundary x_o", "chatter": "chatter amplitude", "growth": "growth of the oscillation", "contacts": "contacts",
    "energy": "energy drawn from the environment", "peak_force": "peak force",
}  # fmt: skip
NONE = "#e4e4e4"
FRAME = {"frameon": True, "framealpha": 0.9, "edgecolor": "none"}
#: two axes with at most this many values of one are drawn as lines, else as a map
FAMILY = len(STYLES)


def plot(log, *names):
    """Draw recorded quantities against time, one below the other.

    Parameters
    ----------
    log : Telemetry
    *names : str
        Of what was recorded: ``"x"``, ``"v"``, ``"F"``, a watched state; ``"x"`` and ``"F"`` by default. Lengths are shown
        in millimetres.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    AnalysisError
        For a name that was not recorded.

    Examples
    --------
    >>> from hapticlab.records import Telemetry
    >>> log = Telemetry(t=[0, 1e-3], x=[0, 1e-3], v=[0, 1], F=[0, 0.1], T=1e-3)
    >>> [axes.get_ylabel() for axes in plot(log, "x", "F").axes]
    ['handle position x [mm]', 'force F [N]']
    """
    check_record(log, "plot", whole=False)
    names = names or ("x", "F")
    if not all(isinstance(name, str) for name in names):
        raise AnalysisError(f'plot of {names}; needs names one by one, as in hl.plot(log, "x", "F")')
    missing = [name for name in names if name not in log.columns]
    if missing:
        recorded = ", ".join(log.columns)
        raise AnalysisError(
            f"{missing[0]} was not recorded; this log has {recorded}. Watch it: hl.Scene(..., watch=[...])"
        )
    with house_style():
        figure = new_figure(height=1.2 + 1.7 * len(names))
        rows = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
        for axes, name in zip(rows, names, strict=True):
            scale, label = _label(name, log.units.get(name, "1"))
            thin = {"linewidth": 0.6} if len(log.t) > 5000 else {}  # thousands of cycles would be a black bar
            axes.plot(log.t, scale * np.asarray(getattr(log, name)), **STYLES[0], **thin)
            axes.set_ylabel(label)
        rows[-1].set_xlabel("time t [s]")
        if log.fault:
            rows[0].set_title(f"fault: {log.fault}", fontsize="small")
    return figure


def plot_sweep(result, *, limits=None):
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
        raise AnalysisError(
            f"the sweep has {len(result.axes)} axes; a plot shows 1 or 2: sweep fewer, or fix some values"
        )
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
    scale, label = _label(result.metric, result.unit)
    x_scale, x_label = _label(over, result.units.get(over, "1"))
    values = np.moveaxis(result.values, short, 0) if len(names) == 2 else result.values[None]
    for number, line in enumerate(values):
        text = None
        if len(names) == 2:
            factor, unit = SHOWN.get(result.units.get(names[short]), (1, result.units.get(names[short], "1")))
            text = f"{names[short]} = {factor * result.axes[names[short]][number]:.4g} {unit}"
        style = STYLES[number % len(STYLES)]
        axes.plot(
            x_scale * result.axes[over], scale * line, marker="." if len(line) <= 30 else None, label=text, **style
        )
    axes.set_xlabel(x_label)
    axes.set_ylabel(label)
    _space(axes, "x", x_scale * result.axes[over])
    if len(names) == 2:
        axes.legend(**FRAME)
    return over, None


def _map(figure, axes, result):
    """Draw a grey-safe map, zero apart in light grey and nan left white; the first axis runs to the right."""
    from matplotlib import colormaps

    across, up = result.axes
    scale, label = _label(result.metric, result.unit)
    (x_scale, x_label), (y_scale, y_label) = (_label(name, result.units.get(name, "1")) for name in (across, up))
    x, y = x_scale * result.axes[across], y_scale * result.axes[up]
    values = np.ma.masked_invalid(scale * result.values.T)
    least = values[values > 0].min() if (values >= 0).all() and (values > 0).any() else None
    colours = colormaps["cividis"].with_extremes(under=NONE)
    image = axes.pcolormesh(x, y, values, shading="nearest", cmap=colours, vmin=least, rasterized=True)
    if least is None:
        figure.colorbar(image, ax=axes, label=label)
    else:
        figure.colorbar(image, ax=axes, extend="min", label=f"{label}; light: none")
    axes.set(xlabel=x_label, ylabel=y_label)
    _space(axes, "x", x)
    _space(axes, "y", y)
    axes.grid(False)
    return across, up


def _draw_limits(axes, result, shown, limits):
    """Draw stiffness limits as dashes of their own."""
    from matplotlib.patheffects import withStroke

    if not limits:
        return
    stiff = [name for name in shown if name and result.units.get(name) == "N/m"]
    if not stiff:
        raise AnalysisError("limits are stiffnesses; needs an axis in N/m, such as k")
    on_map, upright = shown[1] is not None, stiff[0] == shown[0]
    for number, (text, limit) in enumerate(limits.items()):
        style = {"color": "#4d4d4d", "linestyle": LIMIT_DASHES[number % 3], "linewidth": 2.2}
        if on_map:  # black with a white edge is seen on light and dark alike
            style |= {"color": "black", "path_effects": [withStroke(linewidth=4.2, foreground="white")]}
        if np.ndim(limit) and not on_map:
            _draw_family(axes, text, limit, result, style)
        elif np.ndim(limit):
            other = shown[1] if upright else shown[0]
            K, along = [float(one) for one in limit], _curve_axis(result, other, len(limit))
            axes.plot(*((K, along) if upright else (along, K)), label=text, **style)
        else:
            (axes.axvline if upright else axes.axhline)(float(limit), label=f"{text}: {float(limit):.4g} N/m", **style)
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
    return _label(name, result.units.get(name, "1"))[0] * result.axes[name]


def _as_dict(limits):
    if limits is None or isinstance(limits, dict):
        return limits
    several = limits if isinstance(limits, (list, tuple)) else [limits]
    return {limit.kind: limit for limit in several}


def _short_axis(result):
    """Return which axis has few enough values for a line each, 0 where there is one axis, or None."""
    lengths = [len(a) for a in result.axes.values()]
    if len(lengths) == 1:
        return 0
    short = int(np.argmin(lengths))
    return short if lengths[short] <= FAMILY else None


def _space(axes, side, array):
    """Scale the x or y side as its values are spaced; a logarithmic one shows plain numbers at 1, 2 and 5."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    axes.set(**{f"{side}scale": _spacing(array)})
    axis = getattr(axes, f"{side}axis")
    if _spacing(array) == "log":
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def log_scales(axes):
    """Make both scales logarithmic, with plain numbers: at 1, 2 and 5 within two decades, else at powers of ten."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    axes.set(xscale="log", yscale="log")
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high / low < 100 else (1,)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def _spacing(array):
    """Return "log" where the values grow by a ratio over more than a factor of five, else "linear"."""
    if len(array) < 3 or array.min() <= 0 or array.max() / array.min() < 5:
        return "linear"
    ratios = np.diff(np.log(array))
    return "log" if np.ptp(ratios) < 1e-6 * abs(ratios).max() else "linear"


def _label(name, unit):
    scale, shown = SHOWN.get(unit, (1.0, unit))
    return scale, f"{NAMES.get(name, name)} [{shown}]"


def style_of(number):
    """Return a line that differs from the others in colour or dash, also in grey print."""
    first, again = STYLES[number % len(STYLES)], STYLES[(number + number // len(STYLES)) % len(STYLES)]
    return {"color": first["color"], "linestyle": again["linestyle"]}


def house_style():
    """Return the context in which a figure of this package is drawn."""
    from matplotlib import rc_context

    return rc_context(HOUSE)


def new_figure(*, height, width=7.2):
    """Return an empty figure, height and width in inches."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    class HouseFigure(Figure):
        """A figure that a notebook shows although pyplot does not know it."""

        def _repr_png_(self):
            buffer = io.BytesIO()
            self.savefig(buffer, format="png", dpi=110)
            return buffer.getvalue()

    figure = HouseFigure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure
