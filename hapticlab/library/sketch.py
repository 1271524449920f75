"""Schematics of mechanisms, drawn on a display list.

Lengths are in metres, to scale where the mechanism has them. Whatever stands for a part without a size (a spring, a pin, the
handle) is measured in ``u``, a hundredth of the picture's width: some 8 pixels in a notebook.
"""

from functools import cache

import numpy as np

from .display_list import DASHES

INK, SOFT, HANDLE, BODY = "#000000", "#8a8a8a", "#3f5563", "#dbe6f0"
#: of the handle in u: half the height of its face, its thickness, height and radius of the knob
FACE, THICK, KNOB, ROUND = 5.5, 1.4, 8.3, 2.2
#: the way of the motor's largest force [u]
FULL = 18.0


class Sketch:
    """The parts of a schematic.

    Parameters
    ----------
    axes : DisplayList
    left, right, bottom, top : float
        What the picture shows [m].
    tilt : float
        Angle by which everything but the letters is turned about the origin [rad, counterclockwise].
    u : float, optional
        The unit of parts without a size [m], where it is not a hundredth of the width.
    """

    def __init__(self, axes, left, right, bottom, top, tilt=0.0, u=None):
        self.axes, self.u = axes, max((right - left) / 100, (top - bottom) / 26) if u is None else u
        level = isinstance(tilt, (int, float)) and tilt == 0
        self._turn = None if level else (np.cos(tilt), np.sin(tilt))
        self.left, self.right, self.bottom, self.top = left, right, bottom, top
        axes.set(xlim=(left, right), ylim=(bottom, top))

    @property
    def ends(self):
        """What is shown along the handle's way."""
        return (self.bottom, self.top) if self._upright else (self.left, self.right)

    @property
    def across(self):
        """What is shown across the handle's way."""
        return (-self.right, -self.left) if self._upright else (self.bottom, self.top)

    @property
    def _upright(self):
        return self._turn is not None and abs(self._turn[1]) > 0.9

    def place(self, points):
        """The points in the picture, turned where it is tilted."""
        if not self._turn:
            return points
        c, s = self._turn
        return [(c * x - s * y, s * x + c * y) for x, y in points]

    def add(self, kind, *points, zorder=3.0, **style):
        """Draw an item of :mod:`hapticlab.library.display_list`, ``shown`` where that is true."""
        self.axes.add(kind, self.place(points), zorder, **style)

    def line(self, *points, width=1.5, color=INK, linestyle="-", zorder=2.0):
        """Draw a line through points (x, y)."""
        self.add("line", *points, zorder=zorder, colour=color, width=width, dash=DASHES.get(linestyle, ()))

    def area(self, points, color=BODY, edge=INK, zorder=3.0, **style):
        """Fill a polygon."""
        self.add("area", *points, zorder=zorder, fill=color, edge="" if edge == "none" else edge, **style)

    def text(self, at, words, right=0.0, up=0.0, color=INK):
        """Name what is at a point; the name stands so many u from there if there is room."""
        beside = at[0] + right * self.u, at[1] + up * self.u
        self.add("label", at, beside, zorder=9, words=words, colour=color)

    def arrow(self, start, end, label="", color=INK, shown=True, **moved):
        """Draw an arrow; its label stands beyond the tip unless moved by ``right``, ``up`` [u]."""
        self.add("arrow", start, end, zorder=8, shown=shown, colour=color)
        if label:
            (x1, y1), (x2, y2) = start, end
            length = np.hypot(x2 - x1, y2 - y1)
            length = np.where(length == 0, 1.0, length)
            beyond = {"right": 2.6 * (x2 - x1) / length, "up": 2.6 * (y2 - y1) / length}
            self.text(end, label, **(moved or beyond), color=color)

    def coordinate(self, name, value, y, origin=0.0):
        """Draw a length along the picture from its origin: a tick at zero, an arrow to the value, the name beyond it."""
        u = self.u
        self.line((origin, y - 1.2 * u), (origin, y + 1.2 * u), width=1.0)
        end = origin + value
        self.arrow((origin, y), (end, y), shown=abs(value) > u)
        self.text((end, y), name, right=np.where(value >= 0, 2.2, -2.2))

    def handle(self, x, y=0.0, side=1, up=1, below=9.0):
        """Draw the handle with its face exactly at x.

        Parameters
        ----------
        side : int
            Where its face looks: 1 to the right, -1 to the left, 0 both ways, then it is a thin blade.
        up : int
            1 where its knob is above, -1 where it is below.
        below : float
            How far below it its coordinate is drawn [u].
        """
        u, back = self.u, x - side * THICK * self.u
        knob = (x + back) / 2, y + up * KNOB * u
        self.add("handle", (x, y), (back, y), knob, zorder=6, high=FACE * u, round=ROUND * u)
        self.text(knob, "handle", right=-6.5 if side >= 0 else 6.5, color=HANDLE)
        self.coordinate("$x$", x, y - below * u)
        # the motor pushes the back, below what may hold the handle there
        beside, away = y - 3.9 * u, -1 if side >= 0 else 1
        self.add("force", (back, beside), (back + away * FULL * u, beside), zorder=6)

    def track(self, height, x, name, points=401):
        """Draw a potential as a track, with a roller on it that the handle leads.

        Parameters
        ----------
        height : callable of positions [m] -> heights [m]
        name : str
            Names the track.
        points : int
            It is drawn through so many.
        """
        at, u = np.linspace(self.left, self.right, points), self.u
        heights = np.round(height(at) - self.bottom, 7).tolist()
        self.add("track", (self.left, self.bottom), (self.right, self.bottom), zorder=1, heights=heights)
        radius, near = 1.2 * u, np.linspace(-1, 1, 41)
        rest = np.max(height(x + radius * near) + radius * np.sqrt(1 - near**2))
        self.disc((x, rest), radius, zorder=5)
        self.slider(x, rest + radius, np.maximum(self.top - 3.5 * u, rest + 6 * u), self.bottom + 1.6 * u)
        self.text((self.left, np.max(height(at[: points // 7]))), name, right=4.5, up=2.6)

    def slider(self, x, foot, knob, low):
        """Draw a handle that stands on what it slides along, from its foot to its knob; its coordinate at a height ``low``."""
        u = self.u
        self.add("handle", (x, foot), (x, foot), (x, knob), zorder=6, high=0.0, round=ROUND * u)
        self.text((x, knob), "handle", right=6.5, color=HANDLE)
        self.coordinate("$x$", x, low)
        self.add("force", (x - ROUND * u, knob), (x - (ROUND + FULL) * u, knob), zorder=6)

    def wall(self, place, face, side, half, label=""):
        """Draw a wall that begins at a place, and gives where a face of some half height [m] is beyond it."""
        u, end, (low, high) = self.u, self.ends[side > 0], self.across
        deep = np.maximum((end - place) * side, 4 * u)
        middle, around = (high + low) / 2, (high - low) / 2
        self.add("wall", (place, 0), (face, 0), (place + side * deep, 0), zorder=1, high=around, middle=middle, face=half)
        if label:
            self.text((place, low + 1.5 * u), label, right=side * 2.6, up=0.8)

    def ground(self, start, end, depth=1.5):
        """Draw a line that does not move, hatched on its right as seen from start to end."""
        self.add("ground", start, end, zorder=2, deep=depth * self.u)

    def spring(self, start, end, label="", up=3.0, right=0.0, coils=6, height=1.2, **carries):
        """Draw a spring between two points, its label beside the middle."""
        self.add("spring", start, end, zorder=4, coils=coils, high=height * self.u, **carries)
        self._name_middle(start, end, label, right, up)

    def damper(self, start, end, label="", up=-3.0, right=0.0, height=1.2, **carries):
        """Draw a dashpot between two points, its label beside the middle."""
        self.add("damper", start, end, zorder=4, high=height * self.u, **carries)
        self._name_middle(start, end, label, right, up)

    def _name_middle(self, start, end, label, right, up):
        if label:
            self.text(((start[0] + end[0]) / 2, (start[1] + end[1]) / 2), label, right=right, up=up)

    def pair(self, start, end, spring="$K$", damper="$b_c$", apart=4.6, **carries):
        """Draw a spring above a damper between two points of one height: a virtual coupler, Fig. 23.4."""
        (x1, y), (x2, _), half = start, end, apart / 2 * self.u
        for place in (x1, x2):
            self.line((place, y - half), (place, y + half), width=1.2, zorder=4)
        self.spring((x1, y + half), (x2, y + half), spring, up=2.5, **carries)
        self.damper((x1, y - half), (x2, y - half), damper, up=-2.5, **{k: v for k, v in carries.items() if k == "carries"})

    def block(self, centre, width, height, label="", name=""):
        """Draw a body as a box, width and height in u."""
        self.area(_box(centre, width * self.u, height * self.u), name=name)
        if label:
            self.text(centre, label)

    def disc(self, centre, radius, turn=None, color=BODY, zorder=3.0, name=""):
        """Draw a disc, with a mark where it is told how far it has turned [rad, counterclockwise]."""
        way = 0.0 if turn is None else turn
        rim = centre[0] + radius * np.cos(way), centre[1] + radius * np.sin(way)
        self.add("disc", centre, rim, zorder=zorder, fill=color, edge=INK, mark=turn is not None, name=name)

    def gear(self, centre, radius, teeth, turn, deep, color=BODY):
        """Draw a gear whose tooth 0 points along ``turn`` [rad]; its teeth reach ``deep`` [m] to either side of the radius."""
        tip = centre[0] + (radius + deep) * np.cos(turn), centre[1] + (radius + deep) * np.sin(turn)
        self.add("gear", centre, tip, zorder=3, teeth=teeth, deep=deep, fill=color)

    def rod(self, start, end, label="", right=0.0, up=0.0, width=3.0):
        """Draw a rigid link, its label beside the middle."""
        self.line(start, end, width=width, zorder=4)
        self._name_middle(start, end, label, right, up)

    def pin(self, at, fixed=False):
        """Draw a pin joint; a fixed one stands on the ground."""
        u, (x, y) = self.u, at
        if fixed:
            self.area([(x, y), (x - 2 * u, y - 3 * u), (x + 2 * u, y - 3 * u)], color="#ffffff", zorder=4)
            self.ground((x - 3 * u, y - 3 * u), (x + 3 * u, y - 3 * u))
        self.disc(at, 0.7 * u, color="#ffffff", zorder=7)

    def angle(self, centre, radius, start, end, label):
        """Draw an angle as an arc with an arrow from start to end [rad], named beyond its middle or 45 degrees on."""
        reach, middle = radius * self.u, start + np.clip((end - start) / 2, -0.8, 0.8)
        turns = np.linspace(start, end, 12)
        arc = (np.stack(centre) + reach * np.column_stack([np.cos(turns), np.sin(turns)])).tolist()
        self.line(*arc, width=1.0, zorder=6)
        self.arrow(arc[-2], arc[-1], shown=abs(end - start) * radius > 2)
        tip = centre[0] + reach * np.cos(middle), centre[1] + reach * np.sin(middle)
        self.text(tip, label, right=2.4 * np.cos(middle), up=2.4 * np.sin(middle))


def clearance(x, z, spare=0.01):
    """Distance [m] by which a body at z is drawn farther to the right, so that the handle at x does not run into it."""
    return np.maximum(0.0, x - z - spare)


def ring(centre, radius, sides):
    """Corners of a polygon that is drawn for a circle; the last is the first."""
    return [(centre[0] + radius * c, centre[1] + radius * s) for c, s in _turns(sides)]


@cache
def _turns(sides):
    angles = np.linspace(0, 2 * np.pi, sides + 1)
    return np.column_stack([np.cos(angles), np.sin(angles)]).tolist()


def _box(centre, width, height):
    x, y = centre
    return [
        (x - width / 2, y - height / 2), (x + width / 2, y - height / 2),
        (x + width / 2, y + height / 2), (x - width / 2, y + height / 2),
    ]  # fmt: skip
