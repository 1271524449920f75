"""A schematic of any scene, drawn from its equations: the handle, its walls, a block or a pendulum a coordinate.

Blocks and pendulums are not to scale; walls stand where the face of what meets them touches.
"""

from functools import cache

import numpy as np
import sympy as sp

from ...errors import HapticlabError
from ...library.sketch import SOFT, Sketch, clearance
from ...scene.contact.contact import Contact
from ...scene.notation.symbols import n, t, v, x
from .plain_formulas import formula, plain_symbols
from .shape_outlines import Outline
from .wall_boundaries import boundaries

#: from one body to the next, its width, and from the handle to either end of the picture [m]
APART, WIDE, REACH = 0.055, 0.022, 0.06
WALL = "#efefef"
#: coordinates up to which couplings are looked for; more stand in a row, each coupled to the one before
LOOKED_AT = 4


class Schematic:
    """Draws a scene in a state: called with axes, x and what else ``names`` lists, as the functions of the library are.

    Parameters
    ----------
    scene : Scene
    shapes : sequence of Placed
        Drawn in their places; coordinates that they depend on get no block of their own.

    Attributes
    ----------
    names : set of str
        Coordinates and parameters that the picture depends on.
    start : dict of str to float
        Where it is drawn unless told: the handle at 0, each coordinate where it starts.
    """

    def __init__(self, scene, shapes=()):
        self.outlines = [Outline(shape) for shape in shapes]
        self.walls = boundaries(scene)
        placed = set().union(*(outline.names for outline in self.outlines)) if shapes else set()
        free = [q for q in scene.coordinates if type(q).__name__ not in placed]
        self.blocks = [type(q).__name__ for q in _chain(scene, [q for q in free if type(q).unit == "m"])]
        angles = [q for q in free if type(q).unit == "rad"]
        self.turning = {type(q).__name__: _carrier(scene, q) for q in angles}
        self.stands = {type(q).__name__: _stands(scene, q) for q in angles}
        self.springs = _springs(scene, self.blocks)
        self.held_by, self.meets = _held_by(scene), _meets(scene, self.blocks)
        self.start = _start(scene)
        self.names = placed.union(self.blocks, self.turning, *(wall.names for wall in self.walls))

    def __call__(self, axes, **state):
        state = {**self.start, **state}
        s = self._frame(axes)
        u, offset = s.u, {"x": 0.0}
        half = {"x": 1.5 * u} | dict.fromkeys(self.blocks, WIDE / 2)
        for place, name in enumerate(self.blocks):
            if name in self.meets:
                before, gap = self.meets[name]
                offset[name] = offset[before] + half[before] + half[name] + gap
            else:
                offset[name] = (0.8 + place) * APART + clearance(state["x"], state[name])
        at = {name: state[name] + away for name, away in offset.items()}
        for outline in self.outlines:
            outline.draw(s, state)
        for wall in self.walls:
            if wall.mover in at and wall.names <= set(state):
                self._wall(s, wall, offset[wall.mover] + wall.side * half[wall.mover], state)
        self._ties(s, state["x"])
        for first, second in self.springs:
            s.spring((at[first] + half[first], 0), (at[second] - half[second], 0))
        for name in self.blocks:
            s.block((at[name], 0), WIDE / u, 12)
            s.coordinate(_letters(name), state[name], -11 * u, origin=offset[name])
        self._turning(s, at, state)
        s.handle(state["x"])

    def _frame(self, axes):
        dials = sum(not carrier for carrier in self.turning.values())
        right = REACH + APART * (len(self.blocks) + 0.3 * bool(self.blocks)) + 0.04 * dials
        high = 0.022 * (right + REACH) / 0.12
        low = 2.0 * high if any(self.turning.values()) else 1.2 * high
        top = low if any(self.turning[name] and self.stands[name] for name in self.turning) else high
        return Sketch(axes, -REACH, right, -low, top)

    def _ties(self, s, x):
        """Draw what holds the handle itself, to the left of it."""
        u, place = s.u, s.left + 4 * s.u
        if self.held_by:
            s.ground((place, -4.5 * u), (place, 4.5 * u), depth=-1.5)
        if "spring" in self.held_by:
            s.spring((place, 2.8 * u), (x - 1.5 * u, 2.8 * u), height=1.2)
        if "damper" in self.held_by:
            s.damper((place, 0.0), (x - 1.5 * u, 0.0), height=1.2)

    @staticmethod
    def _wall(s, wall, away, state):
        place, high = wall.where(state)[0] + away, 6.8 * s.u
        end = s.right if wall.side > 0 else s.left
        if (end - place) * wall.side > 0:
            s.area([(place, -high), (end, -high), (end, high), (place, high)], color=WALL, edge="none", zorder=1)
        s.ground((place, wall.side * high), (place, -wall.side * high), depth=-1.5)
        s.text((place, -12.2 * s.u), _letters(wall.label))

    def _turning(self, s, at, state):
        """Draw what turns: hanging from or standing on what carries it, else a dial."""
        free = s.right
        for name, carrier in self.turning.items():
            turn, u = state[name], s.u
            if carrier in at:
                pivot, rest = np.array([at[carrier], 0.0]), (1 if self.stands[name] else -1) * np.pi / 2
                angle = rest + (turn if rest < 0 else -turn)
                bob = pivot + 22 * u * np.array([np.cos(angle), np.sin(angle)])
                s.line(pivot, pivot + [0, np.sign(rest) * 24 * u], width=0.8, color=SOFT, linestyle="--")
                s.rod(pivot, bob, width=2.5)
                s.disc(bob, 2.4 * u, zorder=5)
                s.pin(pivot)
                s.angle(pivot, 14, rest, angle, _letters(name))
            else:
                free -= 0.04
                s.disc((free + 0.02, 0), 0.015, np.pi / 2 - turn)
                s.text((free + 0.02, -0.015), _letters(name), up=-2.8)


def _start(scene):
    """Return where the handle and the coordinates are at the first sample; 0 where that is not known."""
    start = {"x": 0.0} | {type(q).__name__: 0.0 for q in scene.coordinates}
    for q in scene.coordinates:
        try:
            value, _ = formula(type(q).initial)
            start[type(q).__name__] = float(value({**start, **scene.values})[0])
        except (KeyError, TypeError, ValueError, ZeroDivisionError, NotImplementedError):
            continue
    return start


@cache
def _letters(name):
    """Return a name as it is set: theta_1 with the Greek letter."""
    return f"${sp.latex(sp.Symbol(name))}$" if name else ""


def _chain(scene, lengths):
    """Return the coordinates in the order in which they follow the handle."""
    order, waiting = [], list(lengths)
    while waiting:
        last = order[-1] if order else x(t)
        order.append(next((q for q in waiting if _coupled(scene, last, q)), waiting[0]))
        waiting.remove(order[-1])
    return order


def _springs(scene, names):
    """Return the pairs (left, right) of neighbours that pull on each other: the handle's name is x."""
    by_name = {"x": x(t)} | {type(q).__name__: q for q in scene.coordinates}
    row = ["x", *names]
    return [pair for pair in zip(row, row[1:], strict=False) if _coupled(scene, *(by_name[name] for name in pair))]


def _meets(scene, names):
    """Return name -> (neighbour to its left, gap [m] where both are at zero), of those that a contact keeps apart."""
    contacts, found, row = (getattr(entry, "contacts", ()) for entry in scene.eom), {}, ["x", *names]
    gaps = [plain_symbols(c.gap) for listed in contacts for c in listed if isinstance(c, Contact)]
    for before, name in zip(row, names, strict=False):
        here, there = sp.Symbol(before, real=True), sp.Symbol(name, real=True)
        for gap in gaps:
            if (gap.diff(there), gap.diff(here)) == (1, -1):
                rest = gap.xreplace({here: sp.S.Zero, there: sp.S.Zero}).subs(dict(scene.values))
                found[name] = (before, float(rest) if rest.is_number else 0.0)
    return found


def _coupled(scene, first, second):
    """Tell whether two movers pull on each other when apart, not in a contact or a case alone."""
    if len(scene.coordinates) > LOOKED_AT:
        return True
    if first == x(t):
        return _apart(scene.force).has(second) or any(expr.has(x, v) for expr in _acting(scene, second))
    return any(expr.has(first) for expr in _acting(scene, second)) or any(expr.has(second) for expr in _acting(scene, first))


def _acting(scene, q):
    """The force on a coordinate, without terms that act in cases alone."""
    try:
        form = scene.explicit()
    except HapticlabError:
        return ()
    if q not in form.coordinates:
        return ()
    return (_apart(form.f[form.coordinates.index(q)]),)


def _apart(expr):
    """Return a force without what acts in cases alone, as walls and contacts do."""
    expr = expr.doit()
    return expr.xreplace(dict.fromkeys(expr.atoms(sp.Piecewise, sp.Max, sp.Min), sp.S.Zero))


def _held_by(scene):
    """The elements between the handle and the ground, "spring" and "damper", wherever it is.

    A force that a shift of everything changes is a spring; one that a speed of the handle changes is a damper.
    """
    force, past, speed = _apart(scene.force), sp.Symbol("past"), sp.Symbol("speed")
    lengths = [q for q in scene.coordinates if type(q).unit == "m"]
    samples = {sample: sp.Symbol("x") - (n - sample.args[0]) * past for sample in force.atoms(x) if sample.args[0] != t}
    force = force.xreplace({**samples, x(t): sp.Symbol("x"), **dict.fromkeys(force.atoms(v), speed)})
    shifted = force.xreplace(dict.fromkeys([*lengths, sp.Symbol("x")], sp.Symbol("shift")))
    ties = [("spring", sp.Symbol("shift"), shifted), ("damper", speed, force), ("damper", past, force)]
    return {tie for tie, by, acts in ties if not sp.expand(acts.diff(by)).is_zero and not (tie == "damper" and lengths)}


def _carrier(scene, q):
    """The body an angle's pivot moves with: a coordinate in metres whose inertia it shares, the handle, or ""."""
    try:
        form = scene.explicit()
    except HapticlabError:
        return ""
    if len(form.coordinates) > LOOKED_AT or q not in form.coordinates:
        return ""
    row = form.M[form.coordinates.index(q)]
    shared = [type(p).__name__ for p, m in zip(form.coordinates, row, strict=True) if type(p).unit == "m" and m.doit() != 0]
    return shared[0] if shared else ""


def _stands(scene, q):
    """Tell whether an angle of zero is up: it falls away from there at the scene's own values."""
    acting = _acting(scene, q) if len(scene.coordinates) <= LOOKED_AT else ()
    try:
        moment, names = formula(*acting)
        return moment({**dict.fromkeys(names, 0.0), **scene.values, type(q).__name__: 0.01})[0] > 0
    except (TypeError, NotImplementedError, KeyError, ZeroDivisionError, IndexError):
        return False
