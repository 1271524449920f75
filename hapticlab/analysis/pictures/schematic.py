"""A schematic of any scene, drawn from its equations: handle, walls, bodies with springs and dampers, pendulums, weights.

Along the handle's way everything is to scale, and so are pendulums; bodies have no size of their own. Bodies stand in a row in
the order in which they follow the handle; where a weight acts along the row, it stands upright.
"""

from functools import cache

import numpy as np
import sympy as sp

from ...library.sketch import FACE, SOFT
from .elements import Elements, Tie, elements, value_of
from .layout import DIAL, ROD, lay_out
from .row_of_bodies import LOOKED_AT, chain, held_by, meetings, rubbed, stands, start_of
from .shape_outlines import Outline
from .wall_boundaries import boundaries

#: a body that others follow and the ground holds has the ground's spring so far below the middle, theirs above it [u]
LOW, RAISED = -6.2, 5.0


class Schematic:
    """Draws a scene in a state: called with a display list, x and what else ``names`` lists, as the library's drawings are.

    Parameters
    ----------
    scene : Scene
    shapes : sequence of Placed
        Drawn in their places; coordinates that they depend on get no body of their own.

    Attributes
    ----------
    names : set of str
        Coordinates, signals and parameters that the picture depends on.
    start : dict of str to float
        Where it is drawn unless told: the handle at 0, each coordinate and signal where it starts.
    """

    def __init__(self, scene, shapes=()):
        self.outlines = [Outline(shape) for shape in shapes]
        self.walls, self.start, self.values = boundaries(scene), start_of(scene), dict(scene.values)
        placed = set().union(*(outline.names for outline in self.outlines)) if shapes else set()
        free = [q for q in scene.coordinates if type(q).__name__ not in placed]
        self.bodies = [type(q).__name__ for q in chain(scene, [q for q in free if type(q).unit == "m"])]
        self.parts = elements(scene) if len(scene.coordinates) <= LOOKED_AT else _row(self.bodies)
        angles = [q for q in free if type(q).unit == "rad"]
        self.rods = {type(q).__name__: value_of(self.parts.rods.get(type(q).__name__)) for q in angles}
        self.stands = {type(q).__name__: stands(scene, q) for q in angles}
        self.carried = {name: self.parts.carriers.get(name, "") for name in self.rods}
        self.upright = any(name in self.parts.weights for name in self.bodies)
        self.held_by, self.meets, self.rough = held_by(scene), meetings(scene, self.bodies), rubbed(scene)
        movers = {"x", "", *self.bodies}
        self.ties = [(tie, *value_of(tie.spring)) for tie in self.parts.ties if {tie.first, tie.second} <= movers]
        self.layout = self._lay_out()
        needed = [wall.names for wall in self.walls] + [names for _, names in self.rods.values()] + [tie[2] for tie in self.ties]
        known = {type(q).__name__ for q in (*scene.coordinates, *scene.signals)} | set(scene.parameters)
        self.names = placed.union(self.bodies, self.rods, *needed) & known

    def _lay_out(self):
        tied = {tie.second for tie, *_ in self.ties}
        held = {tie.first for tie, *_ in self.ties if not tie.second}
        balls = {name for name in self.meets if name not in tied | held}
        hanging = [not self.stands[name] for name, carrier in self.carried.items() if carrier]
        dials = sum(not carrier for carrier in self.carried.values())
        return lay_out(
            self.bodies, upright=self.upright, hangs=hanging[0] if hanging else None, tied=tied, meets=self.meets, held=held,
            balls=balls, start=self.start, dials=dials,
        )  # fmt: skip

    def __call__(self, axes, **state):
        state = {**self.values, **self.start, **state}
        rods = {name: self._rod(name, state) for name in self.rods}
        s = self.layout.sketch(axes, sum(abs(rod) for rod, true in rods.values() if true))
        origin = self.layout.origins(state, s.u)
        at = {name: state[name] + zero for name, zero in origin.items()}
        for outline in self.outlines:
            outline.draw(s, state)
        for wall in self.walls:
            if wall.mover in at and wall.names <= set(state):
                self._wall(s, wall, origin[wall.mover], at[wall.mover], state)
        self._hold(s, state["x"])
        for tie, stiffness, _ in self.ties:
            self._tie(s, tie, stiffness(state), origin, at)
        for name in self.bodies:
            self._body(s, name, at[name])
            self._coordinate(s, name, state[name], origin[name])
        self._turning(s, at, state, rods)
        self._weight(s)
        sides = {wall.side for wall in self.walls if wall.mover == "x"}
        side = 0 if len(sides) == 2 else min(sides, default=1)
        hangs = self.layout.hangs
        below = 15.0 if self.upright else 9.2 if hangs is None else 13.0 if hangs else 8.0
        s.handle(state["x"], side=side, up=-1 if hangs else 1, below=below)

    def _wall(self, s, wall, origin, at, state):
        u, half = s.u, wall.side * self.layout.half[wall.mover] * s.u
        face = FACE if wall.mover == "x" else self._height(wall.mover) / 2
        place = wall.where(state)[0] + origin + half
        s.wall(place, at + half, wall.side, face * u, _letters(wall.label))
        if wall.stiffness is not None:
            s.text(((place + s.ends[wall.side > 0]) / 2, 0.0), _symbol(wall.stiffness), right=6.0 * wall.side, up=-1.0)

    def _hold(self, s, x):
        """Draw what holds the handle itself, to the left of it."""
        u, place = s.u, s.ends[0] + 3 * s.u
        if self.held_by:
            s.ground((place, 4.5 * u), (place, -4.5 * u))
        if "spring" in self.held_by:
            alone = {"carries": "F"} if len(self.held_by) == 1 else {}
            s.spring((place, 3.2 * u), (x - 1.4 * u, 3.2 * u), _symbol(self.held_by["spring"]), up=2.6, **alone)
        if "damper" in self.held_by:
            s.damper((place, 0.0), (x - 1.4 * u, 0.0), _symbol(self.held_by["damper"]), up=-2.6)

    def _level(self, name):
        """Height at which a body's middle is [u]."""
        followed = [tie.first for tie, *_ in self.ties if tie.second == name and tie.first != "x"]
        return RAISED if any(first in self._grounded() for first in followed) else 0.0

    def _grounded(self):
        return {tie.first for tie, *_ in self.ties if not tie.second and tie.first != self.bodies[-1]}

    def _height(self, name):
        """Height of a body across its row [u]."""
        if self.layout.hangs is not None or self._level(name):
            return 8.0
        return 19.0 if name in self._grounded() else 22.0 if self.layout.half[name] < 1 else 12.0

    def _tie(self, s, tie, stiffness, origin, at):
        """Draw a spring, a damper or both from a mover to the next, or to the ground."""
        u, half = s.u, self.layout.half
        start, end = at[tie.first] + half[tie.first] * u, 0.0
        level = self._level(tie.second) if tie.second else 0.0
        if tie.second:
            end, zero = at[tie.second] - half[tie.second] * u, origin[tie.second] - half[tie.second] * u
        else:
            reach = self.layout.reach if tie.first == self.bodies[-1] else 0.02
            end = zero = origin[tie.first] + half[tie.first] * u + 7 * u + reach
            level = LOW if tie.first in self._grounded() else 0.0
            s.ground((end, (level - 4.5) * u), (end, (level + 4.5) * u))
        rest = zero - origin[tie.first] - half[tie.first] * u
        carries = {"carries": "F"} if tie.first == "x" else {"k": stiffness, "rest": rest}
        names = _symbol(tie.spring), _symbol(tie.damper)
        if tie.spring is not None and tie.damper is not None:
            s.pair((start, level * u), (end, level * u), *names, apart=3.8 if level else 4.6, **carries)
        elif tie.spring is not None:
            s.spring((start, level * u), (end, level * u), names[0], **carries)
        else:
            s.damper((start, level * u), (end, level * u), names[1])

    def _body(self, s, name, at):
        u, half, level = s.u, self.layout.half[name], self._level(name)
        word = _symbol(self.parts.masses.get(name))
        if name in self.meets and not any(name in (tie.first, tie.second) for tie, *_ in self.ties):
            s.disc((at, level * u), half * u, name=name)
            s.text((at, level * u), word)
        else:
            s.block((at, level * u), 2 * half, self._height(name), name=name)
            if half < 1:  # too thin for its letter
                s.text((at, -self._height(name) / 2 * u), word, up=-2.0)
            elif word:
                s.text((at, level * u), word, right=-4.0 if name in self.carried.values() else 0.0)
        if name in self.parts.drives:
            self._drive(s, self.parts.drives[name], at, (level + self._height(name) / 2) * u)
        if name in self.rough:
            self._floor(s, at, half, name)
        elif self.layout.hangs is not None and name in self.carried.values():
            s.ground((at - 8.5 * u, -4.6 * u), (at + 10 * u, -4.6 * u))

    def _drive(self, s, force, at, top):
        """Draw a force that depends on time, above its body."""
        u = s.u
        s.line((at, top), (at, top + 1.4 * u), width=1.0)
        s.arrow((at, top + 1.4 * u), (at + 7 * u, top + 1.4 * u), _symbol(force) or "$F(t)$", right=6.5, up=0.0)

    @staticmethod
    def _floor(s, at, half, name):
        """Draw a rough floor below a body, and its friction."""
        u, floor = s.u, -6.0 * s.u
        rough = at + np.arange(-1.6 * half, 2 * half, 0.8) * u
        s.line(*np.column_stack([rough, floor - 0.3 * u * (1 + (-1.0) ** np.arange(len(rough)))]).tolist(), width=1.0, color=SOFT)
        s.ground((at - 1.6 * half * u, floor - 0.6 * u), (at + 2 * half * u, floor - 0.6 * u))

    def _coordinate(self, s, name, value, origin):
        place = self.bodies.index(name)
        hangs, rough = self.layout.hangs, name in self.rough
        below = 18.5 + 3.5 * place if self.upright else 9.6 if rough else 9.2 if hangs is None else -6.2 if hangs else 8.0
        s.coordinate(_letters(name), value, -(below if not self._grounded() or self.upright else 11.0) * s.u, origin=origin)

    def _rod(self, name, state):
        """Length of a pendulum, and whether that is true or only drawn so."""
        try:
            rod = self.rods[name][0](state)
        except (KeyError, TypeError, ValueError, ZeroDivisionError):
            rod = None
        true = rod is not None and _symbol(self.parts.rods[name]) and np.isfinite(rod) & (rod != 0)
        return (rod, True) if true else (1.0, False)

    def _turning(self, s, at, state, rods):
        """Draw what turns: hanging from or standing on what carries it, else a dial."""
        free, u = s.right, s.u
        pivots = {name: np.stack([place, 0.0]) for name, place in at.items()}
        for name, carrier in self.carried.items():
            turn, (rod, true) = state[name], rods[name]
            if carrier in pivots:
                rod = rod if true else np.sign(rod) * 0.9 * ROD * u
                pivot, rest = pivots[carrier], (1 if self.stands[name] else -1) * np.pi / 2
                angle = rest - np.sign(rest) * np.sign(rod) * turn
                pivots[name] = bob = pivot + abs(rod) * np.stack([np.cos(angle), np.sin(angle)])
                s.line(pivot, pivot + [0, np.sign(rest) * abs(rod)], width=0.8, color=SOFT, linestyle="--")
                letter = _symbol(self.parts.rods[name]) if true else "not to scale"
                aside = np.where(np.cos(angle) >= 0, 2.6, -2.6)
                s.rod(pivot, bob, letter, right=aside, width=2.5)
                s.disc(bob, 1.9 * u, zorder=5, name=name)
                s.text(bob, _symbol(self.parts.bobs.get(name)), right=4.2)
                s.pin(pivot)
                s.angle(pivot, 0.45 * abs(rod) / u, rest, angle, _letters(name))
            else:
                free -= DIAL * u
                s.disc((free + 0.5 * DIAL * u, 0), 0.42 * DIAL * u, np.pi / 2 - turn)
                s.text((free + 0.5 * DIAL * u, -0.42 * DIAL * u), _letters(name), up=-2.4)

    def _weight(self, s):
        """Draw which way a weight pulls."""
        u, words = s.u, [_symbol(weight) for weight in self.parts.weights.values() if weight.is_Symbol]
        if self.upright:
            top = s.ends[1] - 2 * u
            s.arrow((top, -9 * u), (top - 5 * u, -9 * u), words[0] if words else "$g$")
        elif self.layout.hangs is not None:
            place = s.right - 4 * u
            s.arrow((place, s.top - 4 * u), (place, s.top - 9 * u), "$g$", right=2.2, up=1.0)


def _row(names):
    """Return what is drawn of a long row that nobody looked into: each tied to the one before."""
    return Elements(ties=[Tie(first, second, sp.S.Zero) for first, second in zip(["x", *names], names, strict=False)])


@cache
def _symbol(part):
    """Return a coefficient as it is set; nothing where it has none, or a long one."""
    return f"${sp.latex(part)}$" if part is not None and part != 0 and sp.count_ops(part) <= 3 else ""


@cache
def _letters(name):
    """Return a name as it is set: theta_1 with the Greek letter."""
    return f"${sp.latex(sp.Symbol(name))}$" if name else ""
