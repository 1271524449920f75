"""The house style of every figure, and the only place where matplotlib opens.

Figures are made as objects, without pyplot: no window, no backend to choose, no list of open figures that grows. A
notebook shows what is returned (``_repr_png_``); a script calls ``savefig``.
"""

import base64
import html
import io
import sys

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
        """A figure that a notebook shows although pyplot does not know it, with a text for who cannot see it."""

        alt = None

        def _repr_png_(self):
            return png(self)

        def _repr_mimebundle_(self, include=None, exclude=None):
            return bundle(self, self.alt or describe(self))

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


def png(figure):
    """Return a figure as the bytes of a PNG for a screen."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=110)
    return buffer.getvalue()


def bundle(figure, alt):
    """Return what a notebook keeps of a figure, and its metadata: the picture and the text that stands for it.

    JupyterLab shows the HTML, whose image carries the text; a PDF takes the PNG.
    """
    encoded = base64.b64encode(png(figure)).decode()
    shown = f'<img src="data:image/png;base64,{encoded}" alt="{html.escape(alt)}" style="max-width: 100%">'
    return {"text/html": shown, "image/png": encoded, "text/plain": alt}, {"image/png": {"alt": alt}}


def forget(figure):
    """Take a figure from pyplot's list, if it is on it, so that a notebook does not show it once more."""
    pyplot = sys.modules.get("matplotlib.pyplot")
    if pyplot:
        pyplot.close(figure)


def describe(figure):
    """Return what a figure shows, in words: titles, axes with their ranges, and the course of each line.

    Examples
    --------
    >>> figure = new_figure(height=2)
    >>> axes = figure.subplots()
    >>> _ = axes.plot([0, 1, 2], [5, 3, 1], label="falling body")
    >>> _ = axes.set(xlabel="time t [s]", ylabel="height [m]", xlim=(0, 2), ylim=(0, 5))
    >>> describe(figure)
    'Time t [s] from 0 to 2 across, height [m] from 0 to 5 up. Falling body: falls from 5 to 1.'
    """
    panels = [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]
    scales = [f"Colour: {axes.get_ylabel() or axes.get_xlabel()}." for axes in figure.axes if axes not in panels]
    told = [_panel(axes) for axes in panels]
    if len(told) > 1:
        told = [f"Panel {number} of {len(told)}: {text}" for number, text in enumerate(told, 1)]
    title = figure.get_suptitle()
    return " ".join(([_sentence(title)] if title else []) + told + scales)


def _panel(axes):
    """Return what one pair of axes shows."""
    told = [_sentence(axes.get_title())] if axes.get_title() else []
    if not axes.axison:
        named = dict.fromkeys(text.get_text().replace("$", "") for text in axes.texts if text.get_text())
        return " ".join([*told, f"A drawing of {', '.join(named)}." if named else "A drawing."])
    across, up = (_axis(axes, side) for side in "xy")
    told.append(_sentence(f"{across} across, {up} up"))
    for line in axes.lines:
        told += _course(axes, line)
    if axes.collections and axes.images:
        told.append("A map.")
    bars = [patch for box in axes.containers for patch in getattr(box, "patches", ())]
    if bars:
        told.append("Bars: " + ", ".join(f"{bar.get_height():.3g}" for bar in bars[:12]) + ".")
    return " ".join(dict.fromkeys(told))


def _axis(axes, side):
    low, high = sorted(getattr(axes, f"get_{side}lim")())
    label = getattr(axes, f"get_{side}label")() or "an axis"
    ticks = [text.get_text() for text in getattr(axes, f"get_{side}ticklabels")()]
    if any(word and not _is_number(word) for word in ticks):
        return f"{label} {', '.join(word for word in ticks if word)}" if label != "an axis" else ", ".join(filter(None, ticks))
    return f"{label} from {low:.3g} to {high:.3g}"


def _course(axes, line):
    """Return how one line runs, as a list of one sentence; none for what only guides the eye."""
    name, (xs, ys) = line.get_label(), map(np.asarray, line.get_data())
    if name.startswith("_") and len(xs) < 3:
        return []
    name = "A line" if name.startswith("_") else name
    if line.get_transform() != axes.transData:  # drawn right across: a level, or a place
        return [_sentence(name)]
    ys = np.asarray(ys, float)[np.isfinite(np.asarray(ys, float))]
    if not len(ys):
        return []
    rises, falls = (np.diff(ys) >= 0).all(), (np.diff(ys) <= 0).all()
    if rises and falls:
        course = f"stays at {ys[0]:.3g}"
    elif rises or falls:
        course = f"{'rises' if rises else 'falls'} from {ys[0]:.3g} to {ys[-1]:.3g}"
    else:
        course = f"from {ys[0]:.3g} to {ys[-1]:.3g}, between {ys.min():.3g} and {ys.max():.3g}"
    return [_sentence(f"{name}: {course}")]


def _is_number(word):
    return bool(word) and all(letter in "0123456789.,eE+-−×$\\mathdefault{}^ " for letter in word)


def _sentence(words):
    words = " ".join(words.replace("$", "").split())
    return (words[:1].upper() + words[1:]).rstrip(".") + "."
