"""The house style of every figure, and the only place where matplotlib opens.

Figures are made as objects, without pyplot: no window, no backend to choose, no list of open figures that grows. A
notebook shows what is returned (``_repr_png_``); a script calls ``savefig``.
"""

import base64
import html
import io
import re
import sys
from typing import Any

import numpy as np

from ..errors import AnalysisError
from .shows_itself import upper

#: a light and a dark colour, told apart in grey print too
WARM, COLD = "#cc5a1a", "#1a4b84"
#: class of a picture that keeps its own light ground, and the rule that turns light and dark where a page is dark: hues stay.
#: Where a notebook says so itself its own ground shows through; where styles are stripped a picture stays light
PICTURE = "hapticlab-figure"
DARK = """<style>
@media screen {
:is([data-jp-theme-light="false"], .vscode-dark, .vscode-high-contrast, [theme="dark"]) .hapticlab-figure
{ filter: invert(1) hue-rotate(180deg); mix-blend-mode: screen }
}
@media screen and (prefers-color-scheme: dark) {
body:not([data-jp-theme-light], [class*="vscode-"], [theme]) .hapticlab-figure { filter: invert(.9) hue-rotate(180deg) }
}
</style>"""
#: readable on a projector and in grey print: neighbours differ in dash and by a fifth of the way from black to white at
#: least; each has a contrast of 3 on white
STYLES: list[dict[str, Any]] = [
    {"color": "#000000", "linestyle": "-"},
    {"color": WARM, "linestyle": "--"},
    {"color": COLD, "linestyle": "-."},
    {"color": "#7d9e30", "linestyle": ":"},
    {"color": "#553077", "linestyle": (0, (5, 1, 1, 1, 1, 1))},
    {"color": "#8a8a8a", "linestyle": (0, (8, 3))},
]
HOUSE: dict[str, Any] = {
    "font.size": 11, "axes.grid": True, "grid.alpha": 0.35, "axes.spines.top": False, "axes.spines.right": False,
    "axes.axisbelow": True, "lines.linewidth": 1.6, "legend.frameon": False, "savefig.dpi": 150, "hatch.linewidth": 0.7,
}  # fmt: skip
#: SI unit -> (what to multiply by, the unit an axis shows)
SHOWN = {"m": (1e3, "mm"), "J": (1e3, "mJ"), "s": (1e3, "ms")}
NAMES = {
    "x": "handle position x", "v": "handle velocity v", "F": "force F", "k": "stiffness k", "K": "stiffness K",
    "B": "virtual damping B", "T": "sampling period T", "m": "handle mass m", "b": "handle damping b", "delay": "delay",
    "x_o": "wall boundary x_o", "chatter": "chatter amplitude", "growth": "growth of the oscillation", "contacts": "contacts",
    "energy": "energy drawn from the environment", "peak_force": "peak force",
}  # fmt: skip
FRAME: dict[str, Any] = {"frameon": True, "framealpha": 0.9, "edgecolor": "none"}
#: what a limit forbids, or what is lacking; readable in grey print and above a map
HATCHED: dict[str, Any] = {"facecolor": "none", "edgecolor": WARM, "hatch": "///", "linewidth": 0}


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


def forbid(axes, level, words, *, below=False):
    """Hatch the side of a level that is not allowed, with words for the legend; room for it is made."""
    low, high = axes.get_ylim()
    room = 0.15 * (high - low)
    low, high = (min(low, level - room), high) if below else (low, max(high, level + room))
    axes.axhspan(low if below else level, level if below else high, label=words, zorder=0.5, **HATCHED)
    axes.set_ylim(low, high)


def legend_above(axes, lines):
    """Draw a legend of so many lines in room that is made for it above what is drawn."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.14 * lines * (high - low))
    axes.legend(fontsize="small", loc="upper left", **FRAME)


def log_scales(axes):
    """Make both scales logarithmic, with plain numbers."""
    for side in "xy":
        plain_log(axes, side)


def plain_log(axes, side, ends=None):
    """Make the x or y scale logarithmic, with plain numbers: at 1, 2 and 5 within two decades, else at powers of ten."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    axes.set(**{f"{side}scale": "log"})
    axis, (low, high) = getattr(axes, f"{side}axis"), sorted(ends or getattr(axes, f"get_{side}lim")())
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high / low < 100 else (1,)))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def scale_axis(axes, side, array):
    """Scale the x or y side as its values are spaced; a logarithmic one shows plain numbers."""
    if spacing(array) == "log":
        plain_log(axes, side, (array.min(), array.max()))
    else:
        axes.set(**{f"{side}scale": "linear"})


def spacing(array):
    """Return "log" where the values grow by a ratio over more than a factor of five, else "linear"."""
    if len(array) < 3 or array.min() <= 0 or array.max() / array.min() < 5:
        return "linear"
    ratios = np.diff(np.log(array))
    return "log" if np.ptp(ratios) < 1e-6 * abs(ratios).max() else "linear"


def axis_label(name, unit):
    """The factor of SI values on an axis, and its label with the unit it shows."""
    scale, shown = SHOWN.get(unit, (1.0, unit))
    return scale, f"{NAMES.get(name, name)} [{shown}]"


def typeset(words):
    """Refuse words with a formula, "$...$", that cannot be typeset."""
    from matplotlib.cbook import is_math_text
    from matplotlib.mathtext import MathTextParser

    if isinstance(words, str) and is_math_text(words):
        try:
            MathTextParser("path").parse(words)
        except ValueError as problem:
            reason = str(problem).strip().splitlines()[-1]
            raise AnalysisError(
                f"{words!r} has a formula between dollar signs that matplotlib cannot typeset ({reason}). "
                "Close its braces, or write plain words"
            ) from None


def png(figure):
    """Return a figure as the bytes of a PNG for a screen."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=110)
    return buffer.getvalue()


def svg(figure):
    """Return a figure as an SVG without a background, for the inside of a page; its letters are outlines."""
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
    # a style inside of an SVG is one of the whole page: every other drawing there would get these joins
    drawn = re.sub("<metadata>.*?</metadata>|<style.*?</style>", "", buffer.getvalue(), flags=re.S)
    drawn = drawn.replace("<g ", '<g stroke-linejoin="round" stroke-linecap="butt" ', 1)
    return drawn[drawn.index("<svg") :]


def bundle(figure, alt):
    """A notebook's bundle of a figure, and its metadata: the picture and the text that stands for it.

    JupyterLab shows the HTML, whose image carries the text; a PDF takes the PNG.
    """
    encoded = base64.b64encode(png(figure)).decode()
    image = f'<img class="{PICTURE}" src="data:image/png;base64,{encoded}" alt="{html.escape(alt)}" style="max-width: 100%">'
    shown = f"{DARK}{image}"
    return {"text/html": shown, "image/png": encoded, "text/plain": alt}, {"image/png": {"alt": alt}}


def forget(figure):
    """Take a figure from pyplot's list, if it is on it, so that a notebook does not show it once more."""
    pyplot = sys.modules.get("matplotlib.pyplot")
    if pyplot:
        pyplot.close(figure)


def describe(figure):
    """Alternative text of a figure: titles, axes with their ranges, and the course of each line.

    Examples
    --------
    >>> figure = new_figure(height=2)
    >>> axes = figure.subplots()
    >>> _ = axes.plot([0, 1, 2], [5, 3, 1])
    >>> _ = axes.set(xlabel="time t [s]", ylabel="height [m]")
    >>> describe(figure)
    'Height [m] over time t [s], 0 to 2: falls from 5 to 1.'
    """
    panels = [axes for axes in figure.axes if axes.get_label() != "<colorbar>" and axes.get_visible()]
    scales = [axes for axes in figure.axes if axes.get_label() == "<colorbar>"]
    told = [_panel(axes) for axes in panels]
    if len(told) > 1:
        told = [f"Panel {number} of {len(told)}: {text}" for number, text in enumerate(told, 1)]
    told += [_sentence(f"Colour: {_span(axes, 'y')}") for axes in scales]
    told += [_legend(figure.legends, panels)]
    return " ".join(filter(None, [_sentence(figure.get_suptitle()), *told]))


def _panel(axes):
    """Alternative text of one pair of axes."""
    title = _sentence(axes.get_title())
    if not axes.axison:
        named = dict.fromkeys(_plain(text.get_text()) for text in axes.texts if text.get_text())
        return " ".join(filter(None, [title, _sentence(f"a drawing: {', '.join(named)}")]))
    told = [_course(axes, line) for line in axes.lines]
    for bars in axes.containers:
        told += _bars(axes, bars)
    told = list(dict.fromkeys(filter(None, told)))
    across, up = _span(axes, "x"), _span(axes, "y")
    if any(getattr(bars, "orientation", "") == "horizontal" for bars in axes.containers):
        text = across
    else:
        text = f"{up.split(', ')[0] if told and axes.lines else up} over {across}"
    text += (": " if told else "") + "; ".join(told)
    marked = dict.fromkeys(word for word in (_plain(one.get_text()) for one in axes.texts) if re.search("[a-zA-Z]{3}", word))
    marked = [word for word in marked if word not in text and word not in {_plain(line.get_label()) for line in axes.lines}]
    marked = _sentence(f"Marked: {', '.join(marked)}") if marked else ""
    return " ".join(filter(None, [title, _sentence(text), marked, _legend([axes.get_legend()], [axes])]))


def _span(axes, side):
    """Return the label of one side with its range, or the words at its ticks."""
    peers = getattr(axes, f"get_shared_{side}_axes")().get_siblings(axes)
    labels = [getattr(peer, f"get_{side}label")() for peer in (axes, *peers)]
    label = _plain(next(filter(None, [*labels, getattr(axes.figure, f"get_sup{side}label")()]), ""))
    words = [_plain(text.get_text()) for text in getattr(axes, f"get_{side}ticklabels")()]
    words = [word for word in words if re.search("[a-zA-Z]{2}", word)]
    if words:
        return f"{label or 'cases'}, {', '.join(words)}"
    ends = [end for line in axes.lines if line.get_transform() == axes.transData for end in _ends(line, side)]
    low, high = sorted(getattr(axes, f"get_{side}lim")())
    if side == "x" and ends and not _is_map(axes):
        low, high = max(low, min(ends)), min(high, max(ends))
    return f"{label or 'values'}, {low:.3g} to {high:.3g}"


def _is_map(axes):
    """Whether axes hold an image or a mesh of values, which fills them, beyond the lines over it."""
    return any(part.get_array() is not None for part in (*axes.images, *axes.collections))


def _ends(line, side):
    values = np.asarray(line.get_data(orig=False)["xy".index(side)], float)
    values = values[np.isfinite(values)]
    return (values.min(), values.max()) if len(values) else ()


def _course(axes, line):
    """The course of one line in words; nothing for what only guides the eye."""
    name, (xs, ys) = _plain(line.get_label()), (np.asarray(part, float) for part in line.get_data(orig=False))
    guide = name.startswith("_")
    if line.get_transform() != axes.transData:  # drawn right across: a level, or a place
        side, at = ("y", ys[0]) if np.ptp(ys) == 0 else ("x", xs[0])
        return "" if guide else f"{name}: {side} at {at:.3g}"
    left, right = sorted(axes.get_xlim())
    known = np.isfinite(xs) & np.isfinite(ys) & (left <= xs) & (xs <= right)
    xs, ys = xs[known], np.where(abs(ys[known]) < 1e-9 * np.ptp(axes.get_ylim()), 0.0, ys[known])
    alone = sum(not _plain(other.get_label()).startswith("_") for other in axes.lines) == 0 and len(axes.lines) <= 2
    if (guide and not alone) or not line.get_xdata(orig=False).size:
        return ""
    name = "" if guide else f"{name}: "
    if not np.isfinite(line.get_ydata(orig=False)).any():
        return f"{name}not known anywhere"
    if not len(ys):
        return ""
    if len(ys) == 1:
        return f"{name}at {xs[0]:.3g}, {ys[0]:.3g}"
    if line.get_linestyle() == "None":
        return f"{name}{_points(ys)}"
    if (np.diff(xs) < 0).any() and (np.diff(xs) > 0).any():
        return f"{name}a curve" if name else ""
    return name + _trend(ys)


def _points(ys):
    if len(ys) <= 6:
        return f"points at {', '.join(f'{y:.3g}' for y in ys)}"
    return f"{len(ys)} points between {ys.min():.3g} and {ys.max():.3g}"


def _trend(ys):
    rises, falls = (np.diff(ys) >= 0).all(), (np.diff(ys) <= 0).all()
    if rises and falls:
        return f"stays at {ys[0]:.3g}"
    if rises or falls:
        return f"{'rises' if rises else 'falls'} from {ys[0]:.3g} to {ys[-1]:.3g}"
    return f"from {ys[0]:.3g} to {ys[-1]:.3g}, between {ys.min():.3g} and {ys.max():.3g}"


def _bars(axes, container):
    """Return the lengths of bars, each with the word at its foot."""
    bars, flat = getattr(container, "patches", ()), getattr(container, "orientation", "") == "horizontal"
    axis = axes.yaxis if flat else axes.xaxis
    feet = dict(zip(axis.get_ticklocs(), (_plain(text.get_text()) for text in axis.get_ticklabels()), strict=False))
    told = []
    for bar in bars:
        at, length = (bar.get_y(), bar.get_width()) if flat else (bar.get_x(), bar.get_height())
        middle = at + (bar.get_height() if flat else bar.get_width()) / 2
        foot = min(feet, key=lambda place: abs(place - middle), default=None)
        told.append(f"{feet.get(foot, '')} {length:.3g}".strip())
    return told


def _legend(legends, panels):
    """Names in legends beyond those that the lines were told by."""
    told = {_plain(line.get_label()) for axes in panels for line in axes.lines}
    words = [_plain(text.get_text()) for legend in legends if legend for text in legend.get_texts()]
    words = [word for word in dict.fromkeys(words) if word not in told]
    return _sentence(f"also shown: {', '.join(words)}") if words else ""


def _plain(words):
    """Return a text without typesetting."""
    return " ".join(re.sub(r"[${}\\]|mathdefault", "", words).split())


def _sentence(words):
    words = _plain(words)
    return upper(words).rstrip(".") + "." if words else ""
