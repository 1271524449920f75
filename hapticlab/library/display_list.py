"""A picture as data: a list of items in metres, which a canvas, matplotlib or SVG shows.

An item is (kind, points, style): points are pairs (x, y) [m] that move, the style is what stays, colours "#rrggbb".

=========  ===============================================  =================================================================
kind       points                                           style
=========  ===============================================  =================================================================
line       along it                                         width and dash [px], colour
area       its corners                                      fill, edge, name
disc       centre, a point of its rim                       fill, edge, name; mark: whether a radius shows how it has turned
gear       centre, the tip of tooth 0                       teeth, deep [m], fill
arrow      tail, tip                                        colour
label      what it names, where it stands if there is room  words, with TeX between dollars; colour
spring     both ends                                        coils; high [m], half its width; carries "F", or k [N/m] and rest [m]
damper     both ends                                        high [m]; carries "F"
ground     both ends, hatched on the right                  deep [m]
wall       its boundary, the face that meets it, its depth  high, face [m]: half heights of the wall and of the face
handle     its face, its back, its knob                     high, round [m]: half height of the face, radius of the knob
hand       the knob, where the hand aims                    round [m]
force      where the motor acts, tip of its largest force   full [N]
track      both ends of its level                           heights [m], evenly spaced between them
frame      lower left and upper right of what is shown
=========  ===============================================  =================================================================

What comes later covers what came before. :mod:`hapticlab.library.parts` makes lines, areas, arrows and labels of all others.
"""

import math
from operator import itemgetter

import numpy as np

DASHES = {"--": (6, 4), ":": (2, 3), "-.": (8, 3, 2, 3)}


class DisplayList:
    """What :class:`~hapticlab.library.sketch.Sketch` draws on. It also takes a few calls of matplotlib's Axes.

    Examples
    --------
    >>> from hapticlab.library.sketch import Sketch
    >>> drawn = DisplayList()
    >>> Sketch(drawn, -0.05, 0.05, -0.012, 0.012).line((0, 0), (0.01, 0))
    >>> drawn.items
    (('line', [(0.0, 0.0), (0.01, 0.0)], {'colour': '#000000', 'width': 1.5, 'dash': ()}),)
    """

    def __init__(self):
        self._kept = []
        self.xlim, self.ylim = (0.0, 1.0), (0.0, 1.0)

    def add(self, kind, points, zorder=3.0, shown=True, **style):
        """Keep an item; one that is not shown or lies nowhere is left out."""
        points = [(float(x), float(y)) for x, y in points]
        if shown and math.isfinite(sum(map(sum, points))):
            self._kept.append((zorder, (kind, points, style)))

    @property
    def items(self):
        """What was drawn, from the bottom up."""
        return tuple(item for _, item in sorted(self._kept, key=itemgetter(0)))

    # --- for drawings that are written for Axes

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

    def plot(self, xs, ys, *, color="#000000", linewidth=1.5, linestyle="-", zorder=2.0, **_):
        """Keep a line."""
        self.add("line", zip(xs, ys, strict=True), zorder, colour=color, width=linewidth, dash=DASHES.get(linestyle, ()))

    def fill(self, xs, ys, *, facecolor="#dbe6f0", edgecolor="", zorder=1.0, **_):
        """Keep a polygon."""
        self.add("area", zip(xs, ys, strict=True), zorder, fill=facecolor, edge="" if edgecolor == "none" else edgecolor)

    def fill_between(self, xs, high, low, *, color, zorder=1.0, **_):
        """Keep the area between a curve and a level."""
        self.fill([xs[0], *xs, xs[-1]], [low, *np.maximum(high, low), low], facecolor=color, zorder=zorder)

    def text(self, x, y, words, *, color="#000000", zorder=3.0, **_):
        """Keep a label."""
        self.add("label", [(x, y), (x, y)], zorder, words=words, colour=color)

    def annotate(self, words, tip, tail, *, arrowprops, zorder=3.0):
        """Keep an arrow, and the label at its tip."""
        self.add("arrow", [tail, tip], zorder, colour=arrowprops["color"])
        if words:
            self.text(*tip, words, color=arrowprops["color"], zorder=zorder)
