"""A scene at one instant: accelerations, force and surfaces in a state, for a solver of one's own to integrate.

Nothing here advances: comparisons are modes, reactions are unknowns, and both are asked of whoever integrates. So a
solver that shares no line with :mod:`hapticlab.compiler.events.located_step` can find the same motion, or show that it
is another.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from ...compiler.algebra.linear_solve import solve
from ...compiler.algebra.phase import TICKS, digit
from ...compiler.contacts.scene_contacts import InstantContacts
from ...compiler.events.flow import motion_of
from ...compiler.events.series_checks import numbers
from ...compiler.events.taylor_series import Series
from ...compiler.ir.program import Channel, Program
from ...compiler.ir.trace import Builder, Value, select
from ...compiler.prune.mass_matrix import start_of
from ...compiler.tick.motion_program import moving_scene
from ...errors import ProgramError
from ...scene.notation.symbols import acceleration, t
from .continuous_handle import DEGREE, Followed, between_samples

#: what is known of every reaction
ROWS = ("measure", "d1", "d2", "free", "inside", "lean")
PER_REACTION = len(ROWS)


class AtInstant(Followed):
    """A handle of which a sample may be taken at any time within the period, ``tau`` after its start."""

    def __init__(self, tracing):
        super().__init__(tracing)
        tracing.inputs.append(Channel("tau", "s", tracing.real))
        self.tau = tracing.tick.leaf("input", len(tracing.inputs) - 1, tracing.real)

    def sample(self, signal, lag=0):
        if lag:
            return super().sample(signal, lag)
        return self.leaves(self.tau)[signal(t)]

    def acceleration(self):
        return self.leaves(self.tau)[acceleration(t)]


@dataclass(frozen=True)
class Bounce:
    """What an impact of a contact needs: restitution, and the speed below which it rests (inf: always)."""

    e: float
    rest_speed: float


@dataclass(frozen=True, eq=False)
class Instant:
    """The program of an instant, and what its rows are.

    Attributes
    ----------
    program : Program
        Inputs: :func:`~hapticlab.analysis.accuracy.continuous_handle.coefficients` of the handle's period, and tau [s]
        in it. States: the number of the period in two digits, the state (q, w, s), a mode for every guard; for every
        reaction what pushes beside it, for every slip its side, for every reaction whether it is held. Outputs: F, the
        rates of (w, s), the measure of every guard, and the ``ROWS`` of every reaction: measure, first and second
        derivative of that, what it is when free, what is positive while it may be held, and which way it leans.
    second, first : int
        Coordinates of second and of first order.
    kinds : tuple of str
        "side" or "floor", one per guard.
    levels : tuple of int
        2 (a gap) or 1 (a slip), one per reaction.
    bounces : tuple of Bounce or None
        One per reaction.
    start : callable (x, v) -> array (states,)
        The state (q, w, s) at the first sample.
    digit : float
        Periods that the first digit of their number takes.
    """

    program: Program
    second: int
    first: int
    kinds: tuple
    levels: tuple
    bounces: tuple
    start: Callable
    digit: float


def instant(scene, *, T):
    """Trace the accelerations, the force and the surfaces of a scene in a state; see :class:`Instant`.

    Raises
    ------
    ProgramError
        The scene has a part that no state determines: a past sample, a micro-impulse, friction in an impact.
    """
    source, _ = between_samples(scene, T)
    moving = moving_scene(source, AtInstant)
    dynamics, tick = moving.dynamics, moving.tick.tracing.tick
    contacts, equations, touching = dynamics.contacts or InstantContacts(()), dynamics.equations, dynamics.touching()
    _check(contacts)
    unknowns = touching.unknowns if touching else {}

    def rates(tau, q, w, s):
        return dynamics.rates(tau, q, w, s, unknowns)

    motion = motion_of(tick, rates, len(equations.second), len(equations.first), touching and touching.reactions)
    F = dynamics.at(moving.tick.handle.tau, motion.q, motion.w, motion.s, unknowns).translate(moving.form.force)
    outputs = [F, *motion.a, *motion.ds, *(g.measure for g in motion.guards)]
    for r, derivatives in zip(motion.reactions, _derivatives(motion), strict=True):
        lean = r.lean if r.lean is not None else tick.const(0.0)
        outputs += [r.measure, *derivatives, r.free, r.inside, lean]
    bounces = [_bounce(c, moving.sample) for c in contacts.contacts]
    program = _program(scene.name, moving, contacts, motion, outputs)
    kinds, levels = tuple(g.kind for g in motion.guards), tuple(r.level for r in motion.reactions)
    bounces += [None] * (len(levels) - len(bounces))
    return Instant(program, len(motion.w), len(motion.s), kinds, levels, tuple(bounces), _start_of(moving), digit("f64"))


def _check(contacts):
    for c in contacts.hovering:
        raise ProgramError(f"{c.name}: micro-impulses act at the end of steps, not in time")
    rubbing = [c.name for c in contacts.contacts if c.contact_law.mu != 0]
    if rubbing:
        raise ProgramError(f"{rubbing[0]}: friction in an impact has only one solver, and a reference needs two")


def _bounce(contact, constant):
    speed = contact.contact_law.rest_speed
    least = 0.0 if speed is None else np.inf if speed == sp.oo else constant(speed).constant
    return Bounce(constant(contact.contact_law.e).constant, least)


def _derivatives(motion):
    """The first and second derivative of each reaction's measure along the motion."""
    rows = {p.id: [p, w, a * 0.5] for p, w, a in zip(motion.q, motion.w, motion.a, strict=True)}
    rows |= {w.id: [w, a] for w, a in zip((*motion.w, *motion.s), (*motion.a, *motion.ds), strict=True)}
    rows[motion.tau.id] = [motion.tau, 1.0, 0.0]
    rows |= {g.leaf.id: [g.leaf, 0.0, 0.0] for g in motion.guards}
    for r in motion.reactions:
        rows |= {leaf.id: [leaf, 0.0, 0.0] for leaf in (r.leaf, r.side) if leaf is not None}
    series, builder = Series(motion.builder.instructions, rows, motion.builder.result), motion.builder

    def value(c):
        return c if isinstance(c, Value) else builder.const(float(c))

    for r in motion.reactions:
        c = series.of(r.measure, r.level)
        yield value(c[1]), value(2.0 * c[2] if r.level == 2 else 0.0)


def _program(name, moving, contacts, motion, outputs):
    """The program with every leaf of the motion a state, its reactions found."""
    tracing, builder = moving.tick.tracing, Builder("f64")
    held = len(motion.reactions)
    leaves = [*motion.q, *motion.w, *motion.s, *(g.leaf for g in motion.guards), *(r.leaf for r in motion.reactions)]
    leaves += [r.side for r in motion.reactions if r.side is not None]
    raw = _block(tracing, moving.dynamics.equations.states, contacts, motion, outputs, leaves)
    types = [*["f64"] * len(TICKS), *(leaf.type for leaf in leaves), *["bool"] * held]
    states = [builder.leaf("state", k, type) for k, type in enumerate(types)]
    inputs = [builder.leaf("input", k, "f64") for k in range(DEGREE + 2)]
    at = {leaf.id: k for k, leaf in enumerate(leaves)}
    places = [len(TICKS) + at[r.leaf.id] for r in motion.reactions]

    def evaluated(pushes):
        given = dict(zip(places, pushes, strict=True))
        return builder.inline(raw, param=[], input=inputs, state=[given.get(k, s) for k, s in enumerate(states)])[0]

    found = _balanced(motion.reactions, evaluated, [states[p] for p in places], states[len(types) - held :])
    channels = tuple(Channel(f"state_{k}", "1", type) for k, type in enumerate(types))
    named = tuple(Channel(f"output_{k}", "1", "f64") for k in range(len(outputs)))
    init = Builder("f64")
    zero = init.block((), [init.const(False if type == "bool" else 0.0, type) for type in types])
    tick = builder.block(found, states)
    return Program(name, tuple(tracing.inputs[3:]), (), channels, named, zero, tick, tracing.T).verify()


def _block(tracing, states, contacts, motion, outputs, leaves):
    """The block of the outputs, each leaf of the motion a state: the period's number, then ``leaves``."""
    place = {("input", 3 + k): ("input", k) for k in range(DEGREE + 2)}
    place[_key(motion.tau)] = ("input", DEGREE + 1)
    place |= {_key(leaf): ("state", len(TICKS) + k) for k, leaf in enumerate(leaves)}
    reactions = [e.force for e in (*contacts.contacts, *contacts.frictions)]
    for k, key in enumerate(tracing.keys):
        if key in TICKS:
            place["state", k] = ("state", TICKS.index(key))
        elif key in states:
            place["state", k] = ("state", len(TICKS) + states.index(key))
        elif key in reactions:
            place["state", k] = place[_key(motion.reactions[reactions.index(key)].leaf)]
    block = tracing.tick.block(outputs)
    return replace(block, instructions=tuple(_placed(i, place) for i in block.instructions))


def _balanced(reactions, evaluated, extra, held):
    """The outputs with the reactions that keep the measures of those held, and what is given to the others."""
    if not reactions:
        return evaluated([])
    count, every = len(reactions), range(len(reactions))

    def part(out, i, name):
        return out[len(out) - PER_REACTION * (count - i) + ROWS.index(name)]

    def stays(out):
        return [part(out, i, "d2" if r.level == 2 else "d1") for i, r in enumerate(reactions)]

    free = [0.0] * count
    for _ in range(2):  # what is free may hold another reaction, as friction holds a normal force
        out = evaluated([select(h, 0.0, value) for h, value in zip(held, free, strict=True)])
        free = [part(out, i, "free") for i in every]
    start = [select(h, 0.0, value) for h, value in zip(held, free, strict=True)]
    rest = stays(evaluated(start))
    columns = [stays(evaluated([value + 1.0 if i == j else value for i, value in enumerate(start)])) for j in every]
    A = [[select(held[i], columns[j][i] - rest[i], float(i == j)) for j in every] for i in every]
    more = solve(A, [select(h, -r, 0.0) for h, r in zip(held, rest, strict=True)])
    return evaluated([a + b + c for a, b, c in zip(start, more, extra, strict=True)])


def _key(leaf):
    i = leaf.builder.instructions[leaf.id]
    return i.op, i.index


def _placed(i, place):
    if i.op not in ("input", "state"):
        return i
    if (i.op, i.index) not in place:
        raise ProgramError("the force contains the sum of the impacts, which no state determines")
    op, index = place[i.op, i.index]
    return replace(i, op=op, index=index)


def _start_of(moving):
    firsts = [moving.start(start_of(state)).id for state in moving.dynamics.equations.states]

    def start(x, v):
        number = numbers(moving.tick.tracing.init.instructions, {("input", 0): x, ("input", 1): v})
        return np.array([float(number(p)) for p in firsts])

    return start
