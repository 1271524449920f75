"""A scene at one instant: accelerations, force and surfaces in a state, for a solver of one's own to integrate.

Nothing here advances: comparisons are modes, reactions are unknowns, and both are asked of whoever integrates. So a
solver that shares no line with :mod:`hapticlab.compiler.located` can find the same motion, or show that it is another.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..errors import ProgramError
from ..scene.contact_laws import rigid
from ..scene.symbols import t
from .driven import DEGREE, Followed, lowering_of
from .flow import motion_of
from .ir import Block, Channel, Instruction, Program
from .phase import TICKS, digit
from .stiffness import numbers
from .taylor import Series
from .trace import Value


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
        Inputs: :func:`~hapticlab.compiler.driven.coefficients` of the handle's period, and tau [s] in it. States: the
        number of the period in two digits, the state (q, w, s), a mode for every guard, a reaction and a side for every reaction.
        Outputs: F, the rates of (w, s), the measure of every guard, and for every reaction its measure, the measure's
        first and second derivative, ``free``, ``inside`` and ``lean``.
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
    lowering, _ = lowering_of(scene, T, 1, None, AtInstant)
    dynamics, tick = lowering.dynamics, lowering.tracing.tick
    contacts = dynamics.contacts
    _check(contacts)
    events = contacts.reactions if contacts.located else None
    motion = motion_of(tick, dynamics.rates, len(dynamics.second), len(dynamics.first), events)
    F = dynamics.at(lowering.handle.tau, motion.q, motion.w, motion.s)(lowering.form.force)
    outputs = [F, *motion.a, *motion.ds, *(g.measure for g in motion.guards)]
    for r, derivatives in zip(motion.reactions, _derivatives(motion), strict=True):
        lean = r.lean if r.lean is not None else tick.const(0.0)
        outputs += [r.measure, *derivatives, r.free, r.inside, lean]
    bounces = [_bounce(c, contacts.constant) for c in contacts.contacts]
    return Instant(
        _program(scene.name, lowering, motion, outputs), len(motion.w), len(motion.s), tuple(g.kind for g in motion.guards),
        tuple(r.level for r in motion.reactions), (*bounces, *[None] * (len(motion.reactions) - len(bounces))),
        _start_of(lowering), digit("f64"),
    )  # fmt: skip


def _check(contacts):
    for c in contacts.hovering:
        raise ProgramError(f"{c.name}: micro-impulses act at the end of steps, not in time")
    rubbing = [c.name for c in contacts.contacts if c.law.mu != 0]
    if rubbing:
        raise ProgramError(f"{rubbing[0]}: friction in an impact has one solver here, not two")


def _bounce(contact, constant):
    e, speed = contact.law.e, contact.law.rest_speed
    if isinstance(contact.law, rigid):
        return Bounce(0.0, np.inf)
    return Bounce(constant(e).constant, 0.0 if speed is None else constant(speed).constant)


def _derivatives(motion):
    """Return the first and second derivative of each reaction's measure along the motion."""
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


def _program(name, lowering, motion, outputs):
    """Return the program with every leaf of the motion a state."""
    tracing, dynamics = lowering.tracing, lowering.dynamics
    own = [*motion.q, *motion.w, *motion.s]
    leaves = [*own, *(g.leaf for g in motion.guards), *(r.leaf for r in motion.reactions)]
    leaves += [r.side for r in motion.reactions if r.side is not None]
    block = tracing.tick.block(outputs)
    inputs = tracing.inputs
    place = {("input", 3 + k): ("input", k) for k in range(DEGREE + 2)}
    place[_key(motion.tau)] = ("input", DEGREE + 1)
    place |= {_key(leaf): ("state", len(TICKS) + k) for k, leaf in enumerate(leaves)}
    reactions = [e.force for e in (*dynamics.contacts.contacts, *dynamics.contacts.frictions)]
    for k, key in enumerate(tracing._states):
        if key in TICKS:
            place["state", k] = ("state", TICKS.index(key))
        elif key in dynamics.states:
            place["state", k] = ("state", len(TICKS) + dynamics.states.index(key))
        elif key in reactions:
            place["state", k] = place[_key(motion.reactions[reactions.index(key)].leaf)]
    instructions = tuple(_placed(i, place) for i in block.instructions)
    states = [
        *(Channel(name, "1", tracing.real) for name in TICKS),
        *(Channel(f"y_{k}", "1", leaf.type) for k, leaf in enumerate(leaves)),
    ]
    kept = [_leaf("state", c.type, k) for k, c in enumerate(states)]
    zero = [_leaf("const", c.type, 0, False if c.type == "bool" else 0.0) for c in states]
    n = len(instructions)
    tick = Block((*instructions, *kept), block.outputs, tuple(range(n, n + len(kept))))
    named = tuple(Channel(f"o_{k}", "1", tracing.real) for k in range(len(outputs)))
    init = Block(tuple(zero), (), tuple(range(len(zero))))
    return Program(name, tuple(inputs[3:]), (), tuple(states), named, init, tick, tracing.T).verify()


def _key(leaf):
    i = leaf.builder.instructions[leaf.id]
    return i.op, i.index


def _leaf(op, type, index, value=0):
    return Instruction(op, (), type, value, index)


def _placed(i, place):
    if i.op not in ("input", "state"):
        return i
    if (i.op, i.index) not in place:
        raise ProgramError("the force holds what impacts added up to, which no state determines")
    op, index = place[i.op, i.index]
    return replace(i, op=op, index=index)


def _start_of(lowering):
    firsts = [lowering.first_of(state).id for state in lowering.dynamics.states]

    def start(x, v):
        number = numbers(lowering.tracing.init.instructions, {("input", 0): x, ("input", 1): v})
        return np.array([float(number(p)) for p in firsts])

    return start
