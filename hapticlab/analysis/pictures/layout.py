"""Where the parts of a schematic stand: along the handle's way in metres; their sizes in u, a hundredth of its width."""

import math
from dataclasses import dataclass, field

import numpy as np

from ...library.sketch import THICK, Sketch, clearance

#: how far the handle goes to either side: along the picture, and upright, where there is less room [m]
REACH, UPRIGHT = 0.05, 0.02
#: a picture is so many u wide and high; upright so wide
WIDE, HIGH, NARROW = 100.0, 26.0, 44.0
#: the longest pendulum, and a dial [u]
ROD, DIAL = 14.0, 12.0
#: more bodies than these are drawn narrower
FEW = 3


@dataclass(frozen=True)
class Layout:
    """Places at rest, in u and in metres.

    Attributes
    ----------
    upright : bool
        The row stands on the handle.
    hangs : bool or None
        A pendulum hangs or stands; None where there is none.
    half : dict of str to float
        Half the length of each body along the row [u]; the handle's is 0, for its face is at x.
    rest : dict of str to (float, float)
        Middle of each body where all coordinates are zero: [u], and [m] more.
    before : dict of str to str
        Whom each body follows.
    stiff : set of str
        Bodies that a contact keeps at their place from the one before.
    right : tuple of float
        End of the row: [u], and [m] more.
    """

    upright: bool
    hangs: bool | None
    half: dict
    rest: dict = field(default_factory=dict)
    before: dict = field(default_factory=dict)
    stiff: set = field(default_factory=set)
    right: tuple = (0.0, 0.0)
    dials: int = 0

    @property
    def reach(self):
        """How far the handle goes [m]."""
        return UPRIGHT if self.upright else REACH

    def u(self, rod):
        """A hundredth of the picture's width [m], with a pendulum of this length [m] in it."""
        fixed, metres = self.right
        room = HIGH if self.upright else max(WIDE, 1.6 * fixed)  # a long row is drawn smaller
        return np.maximum((metres + self.reach) / (room - fixed - self._left), rod / ROD)

    @property
    def _left(self):
        return THICK + (1.2 if self.upright else 5.0)

    def sketch(self, axes, rod):
        """Return the sketch that shows all of it, with a pendulum of this length [m] in it."""
        u = self.u(rod)
        fixed, metres = self.right
        start, end = -self.reach - self._left * u, fixed * u + metres
        if self.upright:
            spare = (HIGH * u - (end - start)) / 2
            return Sketch(axes, -0.4 * NARROW * u, 0.6 * NARROW * u, start - spare, end + spare, tilt=0.5 * math.pi, u=u)
        top = {None: 0.5 * HIGH, True: 8.0, False: HIGH - 9.5}[self.hangs] * u
        return Sketch(axes, start, end, top - HIGH * u, top, u=u)

    def origins(self, state, u):
        """Where each coordinate's zero is drawn [m]: farther on where a body would be run into."""
        found = {"x": 0.0}
        for name, (fixed, metres) in self.rest.items():
            before = self.before[name]
            shift = found[before] - self._origin(before, u)
            free = metres - self._metres(before)
            away = 0.0 if name in self.stiff else clearance(state[before], state[name], spare=free)
            found[name] = fixed * u + metres + shift + away
        return found

    def _origin(self, name, u):
        fixed, metres = self.rest.get(name, (0.0, 0.0))
        return fixed * u + metres

    def _metres(self, name):
        return self.rest.get(name, (0.0, 0.0))[1]


def lay_out(bodies, *, upright, hangs, tied, meets, held, balls, start, dials):
    """Return the layout of a row of bodies.

    Parameters
    ----------
    bodies : list of str
        In their order from the handle on.
    tied, held : set of str
        Those with a spring or damper to the one before; those with one to the ground.
    meets : dict of str to (str, float)
        Whom a contact keeps each from passing, and the gap [m] where both coordinates are zero.
    balls : set of str
    start : dict of str to float
        Where they start [m].
    """
    half = {"x": 0.0} | {name: _half(name, upright, name in balls, meets) for name in bodies}
    spring, pressed = (2.2, 0.008) if upright else (9.0, 0.02)
    if len(bodies) > FEW:
        spring, half = 5.0, {name: min(one, 4.0) for name, one in half.items()}
    rest, before, stiff, place, last = {}, {}, set(), (0.0, 0.0), "x"
    for name in bodies:
        fixed, metres = place
        if name in meets:
            last, gap = meets[name]
            fixed, metres = rest.get(last, (0.0, 0.0))
            fixed, metres = fixed + half[last], metres + gap
            stiff.add(name)
        elif name in tied:
            fixed, metres = fixed + spring, metres + pressed
        else:
            fixed += 6.0
        rest[name], before[name] = (fixed + half[name], metres), last
        place, last = (fixed + 2 * half[name], metres), name
    reach = UPRIGHT if upright else REACH
    flight = max([start.get(name, 0.0) for name in bodies if name in meets], default=0.0)
    fixed, metres = place
    fixed += (7.0 if bodies and bodies[-1] in held else 0.0) + (0.8 if upright else 5.0)
    fixed += DIAL * dials + (0.0 if hangs is None else 6.0)
    return Layout(upright, hangs, half, rest, before, stiff, (fixed, metres + max(reach, 1.1 * flight)), dials)


def _half(name, upright, ball, meets):
    """Half the length of a body along its row [u]."""
    if ball:
        return 2.2 if upright else 3.5
    if not upright:
        return 6.5
    return 0.9 if any(other == name for other, _ in meets.values()) else 2.5
