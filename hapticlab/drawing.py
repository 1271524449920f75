"""The house style of every figure, and the only place where matplotlib opens.

Figures are made as objects, without pyplot: no window, no backend to choose, no list of open figures that grows. A
notebook shows what is returned (``_repr_png_``); a script calls ``savefig``.
"""

import io

import numpy as np

#: readable on a projector and in grey print: lines differ in dash and darkness, not in colour alone
STYLES = [
    {"color": "#000000", "linestyle": "-"},
    {"color": "#c1440e", "linestyle": "--"},
    {"color": "#1f6fb4", "linestyle": "-."},
    {"color": "#6b8e23", "linestyle": ":"},
    {"color": "#7a4a9c", "linestyle": (0, (5, 1, 1, 1, 1, 1))},
    {"color": "#8a8a8a", "linestyle": (0, (8, 3))},
]
HOUSE = {
    "font.size": 11, "axes.grid": True, "grid.alpha": 0.35, "axes.spines.top": False, "axes.spines.right": False,
    "axes.axisbelow": True, "lines.linewidth": 1.6, "legend.frameon": False, "savefig.dpi": 150,
}  # fmt: skip
#: SI unit -> (what to multiply by, the unit an axis shows)
SHOWN = {"m": (1e3, "mm"), "J": (1e3, "mJ"), "s": (1e3, "ms")}
NAMES = {
    "x": "handle position x", "v": "handle velocity v", "F": "force F", "k": "stiffness k", "K": "stiffness K",
    "B": "virtual damping B", "T": "sampling period T", "m": "handle mass m", "b": "handle damping b", "delay": "delay",
    "x_o": "wall boundary x_o", "chatter": "chatter amplitude", "growth": "growth of the oscillation", "contacts": "contacts",
    "energy": "energy drawn from the environment", "peak_force": "peak force",
}  # fmt: skip
FRAME = {"frameon": True, "framealpha": 0.9, "edgecolor": "none"}


def style_of(number):
    """Return a line that differs from the others in colour or dash, also in grey print."""
    first, again = STYLES[number % len(STYLES)], STYLES[(number + number // len(STYLES)) % len(STYLES)]
    return {"color": first["color"], "linestyle": again["linestyle"]}


def house_style():
    """Return the context in which a figure of this package is drawn."""
    from matplotlib import rc_context

    return rc_context(HOUSE)


def colour_map(name):
    """Return a colour map by its matplotlib name; "cividis" is safe in grey print and for every eye."""
    from matplotlib import colormaps

    return colormaps[name]


def outline(width, colour="white"):
    """Return the effect that sets a line or a text off against a map, width in points."""
    from matplotlib.patheffects import withStroke

    return withStroke(linewidth=width, foreground=colour)


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


def log_scales(axes):
    """Make both scales logarithmic, with plain numbers: at 1, 2 and 5 within two decades, else at powers of ten."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    axes.set(xscale="log", yscale="log")
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high / low < 100 else (1,)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def scale_axis(axes, side, array):
    """Scale the x or y side as its values are spaced; a logarithmic one shows plain numbers at 1, 2 and 5."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    axes.set(**{f"{side}scale": spacing(array)})
    axis = getattr(axes, f"{side}axis")
    if spacing(array) == "log":
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def spacing(array):
    """Return "log" where the values grow by a ratio over more than a factor of five, else "linear"."""
    if len(array) < 3 or array.min() <= 0 or array.max() / array.min() < 5:
        return "linear"
    ratios = np.diff(np.log(array))
    return "log" if np.ptp(ratios) < 1e-6 * abs(ratios).max() else "linear"


def axis_label(name, unit):
    """Return what to multiply SI values by, and the label of their axis with the unit it shows."""
    scale, shown = SHOWN.get(unit, (1.0, unit))
    return scale, f"{NAMES.get(name, name)} [{shown}]"
