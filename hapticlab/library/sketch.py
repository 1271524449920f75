"""Schematics of mechanisms, drawn on matplotlib Axes that are given: this module only calls their methods.

Lengths are in metres, to scale where the mechanism has them. Whatever stands for a part without a size (a spring, a pin, the
handle) is measured in ``u``, a hundredth of the picture's width.
"""

import re

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
        self.turned = np.array([[np.cos(tilt), np.sin(tilt)], [-np.sin(tilt), np.cos(tilt)]])
        self.left, self.right, self.bottom, self.top = left, right, bottom, top
        self._shown = (left, right), (bottom, top)
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        axes.axis("off")

    def place(self, points, wide=1.0, high=1.0):
        """Return where points (x, y) are in the picture, which grows to show them and so many u around."""
        placed = np.asarray(points, float) @ self.turned
        wide, high, (left, bottom), (right, top) = wide * self.u, high * self.u, placed.min(axis=0), placed.max(axis=0)
        (l, r), (b, t) = self._shown
        if left - wide < l or right + wide > r or bottom - high < b or top + high > t:
            self._shown = (min(l, left - wide), max(r, right + wide)), (min(b, bottom - high), max(t, top + high))
            self.axes.set(xlim=self._shown[0], ylim=self._shown[1])
        return placed

    def line(self, *points, width=1.5, color=INK, **style):
        """Draw a line through points (x, y)."""
        self.axes.plot(*self.place(points).T, color=color, linewidth=width, solid_capstyle="round", **style)

    def area(self, points, color=BODY, edge=INK, zorder=3):
        """Fill a polygon."""
        self.axes.fill(*self.place(points).T, facecolor=color, edgecolor=edge, linewidth=1.4, zorder=zorder)

    def text(self, at, text, right=0.0, up=0.0, **style):
        """Write text centred at a point, moved by so many u."""
        letters = len(re.sub(r"\\\w+", "o", text).strip("$"))
        at = np.add(at, (right * self.u, up * self.u))
        self.axes.text(*self.place([at], 1 + 0.8 * letters, 2.0)[0], text, **{"ha": "center", "va": "center", **TEXT, **style})

    def arrow(self, start, end, label="", color=INK, **moved):
        """Draw an arrow; its label stands beyond the tip unless moved by ``right``, ``up`` [u]."""
        look = {"arrowstyle": "-|>", "color": color, "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}
        tail, tip = map(tuple, self.place([start, end]))
        self.axes.annotate("", tip, tail, arrowprops=look, zorder=8)
        if label:
            along = np.subtract(end, start) / (np.hypot(*np.subtract(end, start)) or 1.0)
            self.text(end, label, **(moved or {"right": 2.6 * along[0], "up": 2.6 * along[1]}), color=color)

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
        start, end, u = np.asarray(start, float), np.asarray(end, float), self.u
        length = np.hypot(*(end - start))
        along = (end - start) / length
        away = np.array([along[1], -along[0]])
        self.line(start, end, width=1.6)
        feet = start + np.outer(np.arange(1.5 * u, length + 0.1 * u, 1.5 * u), along)
        hatched = np.stack([feet, feet + depth * u * (away - along), feet], axis=1)  # there and back, in one line
        self.line(*hatched.reshape(-1, 2), width=0.8)

    def spring(self, start, end, label="", up=3.4, right=0.0, coils=6, height=1.6):
        """Draw a spring between two points, its label beside the middle."""
        start, end, u = np.asarray(start, float), np.asarray(end, float), self.u
        span = end - start
        across = np.array([-span[1], span[0]]) / (np.hypot(*span) or 1.0) * height * u
        lead = min(0.25, 2 * u / (np.hypot(*span) or 1.0))
        zigzag = [start, start + lead * span]
        zigzag += [
            start + (lead + (1 - 2 * lead) * (k + 0.5) / (2 * coils)) * span + (-1) ** k * across for k in range(2 * coils)
        ]
        self.line(*zigzag, end - lead * span, end, width=1.2, zorder=4)
        if label:
            self.text((start + end) / 2, label, right=right, up=up)

    def damper(self, start, end, label="", up=-3.4, right=0.0, height=1.5):
        """Draw a dashpot between two points, its label beside the middle."""
        start, end, u = np.asarray(start, float), np.asarray(end, float), self.u
        span = end - start
        along = span / (np.hypot(*span) or 1.0)
        across = np.array([-along[1], along[0]]) * height * u
        cup, open_end = start + 0.38 * span, start + 0.66 * span
        self.line(start, cup, width=1.2, zorder=4)
        self.line(open_end + across, cup + across, cup - across, open_end - across, width=1.2, zorder=4)
        piston = start + 0.54 * span
        self.line(piston + 0.7 * across, piston - 0.7 * across, width=2.0, zorder=4)
        self.line(piston, end, width=1.2, zorder=4)
        if label:
            self.text((start + end) / 2, label, right=right, up=up)

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
        angles = np.linspace(0, 2 * np.pi, 73)
        rim = np.asarray(centre) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
        self.area(rim, color=color, zorder=zorder)
        if turn is not None:
            mark = np.asarray(centre) + radius * np.array([np.cos(turn), np.sin(turn)])
            self.line(centre, mark, width=1.0, color=SOFT, zorder=zorder + 0.5)

    def rod(self, start, end, label="", right=0.0, up=0.0, width=3.0):
        """Draw a rigid link, its label beside the middle."""
        self.line(start, end, width=width, zorder=4)
        if label:
            self.text(np.add(start, end) / 2, label, right=right, up=up)

    def pin(self, at, fixed=False):
        """Draw a pin joint; a fixed one stands on the ground."""
        u, (x, y) = self.u, at
        if fixed:
            self.area([(x, y), (x - 2 * u, y - 3 * u), (x + 2 * u, y - 3 * u)], color="#ffffff", zorder=4)
            self.ground((x - 3 * u, y - 3 * u), (x + 3 * u, y - 3 * u))
        angles = np.linspace(0, 2 * np.pi, 25)
        self.area(np.column_stack([x + 0.8 * u * np.cos(angles), y + 0.8 * u * np.sin(angles)]), "#ffffff", zorder=7)

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
    """Return how much farther to the right [m] a body at z stands, so that the handle at x does not run into it."""
    return max(0.0, x - z - spare)


def _box(centre, width, height):
    x, y = centre
    return [
        (x - width / 2, y - height / 2), (x + width / 2, y - height / 2),
        (x + width / 2, y + height / 2), (x - width / 2, y + height / 2),
    ]  # fmt: skip
