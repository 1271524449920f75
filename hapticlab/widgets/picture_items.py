"""A stand-in for matplotlib's Axes that keeps what is drawn as plain items, in metres, for a canvas to show.

============================================  ==============================================================
item                                          what it is
============================================  ==============================================================
``("line", points, width, colour, dash)``     width in pixels; dash: lengths on and off in pixels, () for none
``("area", points, fill, edge)``              a filled polygon; edge "" for none
``("text", (x, y), words, colour)``           centred there
``("arrow", tail, tip, colour, label)``       the label stands beyond the tip
============================================  ==============================================================

Points are pairs (x, y), colours "#rrggbb". What comes later covers what came before.
"""

import math
import re
from functools import lru_cache
from operator import itemgetter

import numpy as np

DASHES = {"--": (6, 4), ":": (2, 3), "-.": (8, 3, 2, 3)}
GREEK = {
    "theta": "θ", "varphi": "φ", "phi": "φ", "psi": "ψ", "beta": "β", "alpha": "α", "rho": "ρ", "Omega": "Ω", "sin": "sin ",
    "omega": "ω", "mu": "µ", "gamma": "γ", "delta": "δ", "epsilon": "ε", "lambda": "λ", "eta": "η", "xi": "ξ",
}  # fmt: skip


class RecordingAxes:
    """What :class:`~hapticlab.library.sketch.Sketch` asks of Axes, kept as items.

    Examples
    --------
    >>> from hapticlab.library.sketch import Sketch
    >>> axes = RecordingAxes()
    >>> Sketch(axes, -0.05, 0.05, -0.02, 0.02).line((0, 0), (0.01, 0))
    >>> axes.items
    (('line', [[0.0, 0.0], [0.01, 0.0]], 1.5, '#000000', ()),)
    """

    def __init__(self):
        self._kept = []
        self.xlim, self.ylim = (0.0, 1.0), (0.0, 1.0)

    @property
    def items(self):
        """What was drawn, from the bottom up; what lies nowhere is left out."""
        return tuple(item for _, item in sorted(self._kept, key=itemgetter(0)))

    def set(self, *, xlim=None, ylim=None, **_):
        """Set what is shown."""
        self.xlim, self.ylim = xlim or self.xlim, ylim or self.ylim

    def get_xlim(self):
        """Return the left and right end of what is shown [m]."""
        return self.xlim

    def get_ylim(self):
        """Return the lower and upper end of what is shown [m]."""
        return self.ylim

    def axis(self, _):
        """Leave the axes away, as a canvas does."""

    def plot(self, xs, ys, *, color, linewidth, linestyle="-", zorder=2, **_):
        """Keep a line."""
        points = _points(xs, ys)
        if points:
            self._kept.append((zorder, ("line", points, linewidth, color, DASHES.get(linestyle, ()))))

    def fill(self, xs, ys, *, facecolor, edgecolor="", zorder=1, **_):
        """Keep a polygon."""
        points = _points(xs, ys)
        if points:
            self._kept.append((zorder, ("area", points, facecolor, "" if edgecolor == "none" else edgecolor)))

    def fill_between(self, xs, high, low, *, color, zorder=1, **_):
        """Keep the area between a curve and a level."""
        high = np.maximum(high, low)
        self.fill([xs[0], *xs, xs[-1]], [low, *high, low], facecolor=color, zorder=zorder)

    def text(self, x, y, words, *, color, zorder=3, **_):
        """Keep a text, the mathematics in it in plain letters."""
        if math.isfinite(x) and math.isfinite(y):
            self._kept.append((zorder, ("text", (float(x), float(y)), plain(words), color)))

    def annotate(self, words, tip, tail, *, arrowprops, zorder=3):
        """Keep an arrow."""
        if all(map(math.isfinite, (*tip, *tail))):
            tail, tip = tuple(map(float, tail)), tuple(map(float, tip))
            self._kept.append((zorder, ("arrow", tail, tip, arrowprops["color"], plain(words))))


@lru_cache(1000)
def plain(words):
    """Return a text in letters that need no typesetting: names as Python writes them, Greek letters as such.

    Examples
    --------
    >>> plain(r"$K,\\ b_c$"), plain(r"$\\varphi_2$"), plain("$P\\\\,P_{cr}$")
    ('K, b_c', 'φ_2', 'P P_cr')
    """
    if "$" not in words:
        return words
    words = re.sub(r"\\[ ,]", " ", words.replace("$", ""))
    words = re.sub(r"\\(\w+?)(?=_|\W|$)", lambda word: GREEK.get(word[1], word[1]), words)
    return re.sub(r"  +", " ", re.sub(r"[{}]", "", words))


def _points(xs, ys):
    points = list(map(list, zip(map(float, xs), map(float, ys), strict=True)))
    return points if math.isfinite(sum(map(sum, points))) else []
