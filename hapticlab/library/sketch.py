"""Schematics of mechanisms, drawn on matplotlib Axes that are given: this module only calls their methods.

Lengths are in metres, to scale where the mechanism has them. Whatever stands for a part without a size (a spring, a pin, the
handle) is measured in ``u``, a hundredth of the picture's width.
"""

import math
import re
from functools import cache, lru_cache

import numpy as np

INK, SOFT, HANDLE, BODY = "#000000", "#8a8a8a", "#c1440e", "#dbe6f0"
TEXT = {"fontsize": 11, "color": INK, "zorder": 9, "clip_on": False}


class Sketch:
    """The parts of a schematic.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    left, right, bottom, top : float
        What the picture shows [m]; more where the state that is drawn reaches farther.
    tilt : float
        Angle by which everything but the letters is turned about the origin [rad, counterclockwise].
    """

    def __init__(self, axes, left, right, bottom, top, tilt=0.0):
        self.axes, self.u = axes, (right - left) / 100
        self._turn = (math.cos(tilt), math.sin(tilt)) if tilt else None
        self.left, self.right, self.bottom, self.top = left, right, bottom, top
        self._shown = (left, right), (bottom, top)
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        axes.axis("off")

    def place(self, points, wide=1.0, high=1.0):
        """The xs and ys of points in the picture, which grows to show them with a margin in u."""
        placed = [(float(x), float(y)) for x, y in points]  # few points: plain floats are faster than arrays
        if self._turn:
            c, s = self._turn
            placed = [(c * x - s * y, s * x + c * y) for x, y in placed]
        xs, ys = zip(*placed, strict=True)
        if math.isfinite(sum(xs) + sum(ys)):
            self._show(min(xs) - wide * self.u, max(xs) + wide * self.u, min(ys) - high * self.u, max(ys) + high * self.u)
        return xs, ys

    def _show(self, left, right, bottom, top):
        (l, r), (b, t) = self._shown
        if left < l or right > r or bottom < b or top > t:
            self._shown = (min(l, left), max(r, right)), (min(b, bottom), max(t, top))
            self.axes.set(xlim=self._shown[0], ylim=self._shown[1])

    def line(self, *points, width=1.5, color=INK, **style):
        """Draw a line through points (x, y)."""
        self.axes.plot(*self.place(points), color=color, linewidth=width, solid_capstyle="round", **style)

    def area(self, points, color=BODY, edge=INK, zorder=3):
        """Fill a polygon."""
        self.axes.fill(*self.place(points), facecolor=color, edgecolor=edge, linewidth=1.4, zorder=zorder)

    def text(self, at, text, right=0.0, up=0.0, **style):
        """Write text centred at a point, moved by so many u."""
        at = at[0] + right * self.u, at[1] + up * self.u
        (x,), (y,) = self.place([at], 1 + 0.8 * _letters(text), 2.0)
        self.axes.text(x, y, text, **{"ha": "center", "va": "center", **TEXT, **style})

    def arrow(self, start, end, label="", color=INK, **moved):
        """Draw an arrow; its label stands beyond the tip unless moved by ``right``, ``up`` [u]."""
        look = {"arrowstyle": "-|>", "color": color, "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}
        tail, tip = zip(*self.place([start, end]), strict=True)
        self.axes.annotate("", tip, tail, arrowprops=look, zorder=8)
        if label:
            (x1, y1), (x2, y2) = start, end
            length = math.hypot(x2 - x1, y2 - y1) or 1.0
            beyond = {"right": 2.6 * (x2 - x1) / length, "up": 2.6 * (y2 - y1) / length}
            self.text(end, label, **(moved or beyond), color=color)

    def coordinate(self, name, value, y, origin=0.0):
        """Draw a length along the picture from its origin: a tick at zero, an arrow to the value, the name beyond it."""
        u = self.u
        self.line((origin, y - 1.2 * u), (origin, y + 1.2 * u), width=1.0)
        end = origin + value
        if abs(value) > u:
            self.arrow((origin, y), (end, y))
        self.text((end, y), name, right=2.4 if value >= 0 else -2.4)

    def handle(self, x, y=0.0, below=8.0, **moved):
        """Draw the handle at x and its coordinate ``below`` it [u]; its name stands above unless moved."""
        u = self.u
        self.area(_box((x, y), 3 * u, 9 * u), color=HANDLE, zorder=6)
        self.text((x, y), "handle", **(moved or {"up": 9.3}), color=HANDLE)
        self.coordinate("$x$", x, y - below * u)

    def ground(self, start, end, depth=1.5):
        """Draw a line that does not move, hatched on its right as seen from start to end."""
        (x1, y1), (x2, y2), u = start, end, self.u
        length = math.hypot(x2 - x1, y2 - y1)
        ax, ay = (x2 - x1) / length, (y2 - y1) / length
        self.line(start, end, width=1.6)
        feet = [1.5 * u * k for k in range(1, math.ceil((length - 1.4 * u) / (1.5 * u)) + 1)]
        hatched = []  # there and back, in one line
        for foot in feet:
            x, y = x1 + foot * ax, y1 + foot * ay
            hatched += (x, y), (x + depth * u * (ay - ax), y - depth * u * (ax + ay)), (x, y)
        self.line(*hatched, width=0.8)

    def spring(self, start, end, label="", up=3.4, right=0.0, coils=6, height=1.6):
        """Draw a spring between two points, its label beside the middle."""
        at, length = self._along(start, end, height)
        lead = min(0.25, 2 * self.u / length)
        turns = [lead + (1 - 2 * lead) * (k + 0.5) / (2 * coils) for k in range(2 * coils)]
        zigzag = [at(part, (-1) ** k) for k, part in enumerate(turns)]
        self.line(start, at(lead), *zigzag, at(1 - lead), end, width=1.2, zorder=4)
        if label:
            self.text(at(0.5), label, right=right, up=up)

    def damper(self, start, end, label="", up=-3.4, right=0.0, height=1.5):
        """Draw a dashpot between two points, its label beside the middle."""
        at, _ = self._along(start, end, height)
        self.line(start, at(0.38), width=1.2, zorder=4)
        self.line(at(0.66, 1), at(0.38, 1), at(0.38, -1), at(0.66, -1), width=1.2, zorder=4)
        self.line(at(0.54, 0.7), at(0.54, -0.7), width=2.0, zorder=4)
        self.line(at(0.54), end, width=1.2, zorder=4)
        if label:
            self.text(at(0.5), label, right=right, up=up)

    def _along(self, start, end, height):
        """(Function, length): the point at a fraction of the line from start to end and at heights [u] to its left."""
        (x, y), (x2, y2) = start, end
        dx, dy = x2 - x, y2 - y
        length = math.hypot(dx, dy) or 1.0
        away = height * self.u / length
        return lambda part, left=0.0: (x + part * dx - left * away * dy, y + part * dy + left * away * dx), length

    def pair(self, start, end, label="$K,\\ b_c$", apart=4.6):
        """Draw a spring above a damper between two points of one height: a virtual coupler, Fig. 23.4."""
        (x1, y), (x2, _), half = start, end, apart / 2 * self.u
        for place in (x1, x2):
            self.line((place, y - half), (place, y + half), width=1.2, zorder=4)
        self.spring((x1, y + half), (x2, y + half), label, coils=5, height=1.2)
        self.damper((x1, y - half), (x2, y - half), height=1.2)

    def block(self, centre, width, height, label=""):
        """Draw a body as a box, width and height in u."""
        self.area(_box(centre, width * self.u, height * self.u))
        if label:
            self.text(centre, label)

    def disc(self, centre, radius, turn=None, color=BODY, zorder=3):
        """Draw a disc, with a mark where it is told how far it has turned [rad, counterclockwise]."""
        self.area(ring(centre, radius, 72), color=color, zorder=zorder)
        if turn is not None:
            mark = centre[0] + radius * math.cos(turn), centre[1] + radius * math.sin(turn)
            self.line(centre, mark, width=1.0, color=SOFT, zorder=zorder + 0.5)

    def rod(self, start, end, label="", right=0.0, up=0.0, width=3.0):
        """Draw a rigid link, its label beside the middle."""
        self.line(start, end, width=width, zorder=4)
        if label:
            self.text(((start[0] + end[0]) / 2, (start[1] + end[1]) / 2), label, right=right, up=up)

    def pin(self, at, fixed=False):
        """Draw a pin joint; a fixed one stands on the ground."""
        u, (x, y) = self.u, at
        if fixed:
            self.area([(x, y), (x - 2 * u, y - 3 * u), (x + 2 * u, y - 3 * u)], color="#ffffff", zorder=4)
            self.ground((x - 3 * u, y - 3 * u), (x + 3 * u, y - 3 * u))
        self.area(ring(at, 0.8 * u, 24), "#ffffff", zorder=7)

    def angle(self, centre, radius, start, end, label):
        """Draw an angle as an arc with an arrow from start to end [rad], named beyond its middle or 45 degrees on."""
        reach, middle = radius * self.u, start + np.clip((end - start) / 2, -0.8, 0.8)
        turns = np.linspace(start, end, 40)
        arc = np.asarray(centre) + reach * np.column_stack([np.cos(turns), np.sin(turns)])
        self.line(*arc, width=1.0, zorder=6)
        if abs(end - start) * radius > 2:
            self.arrow(arc[-6], arc[-1])
        self.text(centre, label, right=(radius + 2.6) * np.cos(middle), up=(radius + 2.6) * np.sin(middle))


def clearance(x, z, spare=0.01):
    """Distance [m] by which a body at z is drawn farther to the right, so that the handle at x does not run into it."""
    return max(0.0, x - z - spare)


def ring(centre, radius, sides):
    """Corners of a polygon that is drawn for a circle; the last is the first."""
    return [(centre[0] + radius * c, centre[1] + radius * s) for c, s in _turns(sides)]


@cache
def _turns(sides):
    angles = np.linspace(0, 2 * np.pi, sides + 1)
    return np.column_stack([np.cos(angles), np.sin(angles)]).tolist()


@lru_cache(1000)
def _letters(text):
    """Approximate number of letters of a text once it is typeset."""
    return len(re.sub(r"\\\w+", "o", text).strip("$"))


def _box(centre, width, height):
    x, y = centre
    return [
        (x - width / 2, y - height / 2), (x + width / 2, y - height / 2),
        (x + width / 2, y + height / 2), (x - width / 2, y + height / 2),
    ]  # fmt: skip
