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
from .figure_words import describe

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


def svg(figure, *, outlines=True):
    """Return a figure as an SVG without a background, for the inside of a page; its letters are outlines, or text."""
    from matplotlib import rc_context

    buffer = io.StringIO()
    with rc_context({} if outlines else {"svg.fonttype": "none", "svg.hashsalt": "hapticlab"}):  # a file is the same each time
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
