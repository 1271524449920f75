"""Programs that advance a motion written as plain arithmetic, for the tests of the series and the located step."""

import numpy as np

from hapticlab.compiler.algebra.phase import digit
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.events.flow import motion_of
from hapticlab.compiler.events.located_step import Stepper
from hapticlab.compiler.ir.program import Channel, Program
from hapticlab.compiler.ir.trace import Builder, Value, select


def program(rates, q, w, first=(), *, T, substeps=1, order=16, events=3, contacts=None, impact=None, real="f64"):
    """Return the program whose outputs are (q, w, s, unlocated) after each step.

    ``rates(tau, q, w, s)`` as for a method; ``contacts(tau, q, w, s, new)`` and ``impact(motion)`` as for the stepper.
    """
    builder = Builder(real)
    motion = motion_of(builder, rates, len(q), len(first), contacts)
    stepper = Stepper(motion, T / substeps, order, events, impact and impact(motion))
    starts = [*q, *w, *first]
    values = [builder.leaf("state", k, real) for k in range(len(starts))]
    held = [builder.leaf("state", len(starts) + k, "bool") for k in range(len(motion.reactions))]
    count = builder.leaf("state", len(starts) + len(held), real)
    groups = values[: len(q)], values[len(q) : 2 * len(q)], values[2 * len(q) :]
    tau = builder.const(0.0) if contacts is None else count * T
    state, now, missed = groups, held, builder.const(0.0)
    for _ in range(substeps):
        state, now, unlocated = stepper.step(tau, state, now)
        missed = missed + (select(unlocated, 1.0, 0.0) if isinstance(unlocated, Value) else float(unlocated))
        tau = tau + T / substeps
    state = [builder._value(value) for group in state for value in group]
    now = [builder._value(h) for h in now]
    init = Builder(real)
    begin = [*map(init.const, starts), *(init.const(False) for _ in held), init.const(0.0)]
    names = [Channel(f"y{k}", "1", real) for k in range(len(starts))]
    states = (*names, *(Channel(f"held{k}", "1", "bool") for k in range(len(held))), Channel("count", "1", real))
    tick = builder.block([*state, missed], [*state, *now, count + 1.0])
    outputs = (*names, Channel("unlocated", "1", real))
    return Program("motion", (), (), states, outputs, init.block((), begin), tick, T)


def rows(motion, ticks):
    """Run, check that every event was located, and return the states, one row a tick."""
    outputs = load(motion).run(ticks).outputs[:, :, 0]
    assert not outputs[:, -1].any(), f"unlocated at {np.flatnonzero(outputs[:, -1])}"
    return outputs[:, :-1]


def at_tick(program, tick, states=None):
    """Return (states, 1), zeros by default, with the digits of a tick count in place."""
    states = np.zeros((len(program.states), 1)) if states is None else np.array(states)
    high, low = divmod(tick, int(digit(program.outputs[0].type)))
    for row, channel in zip(states, program.states, strict=True):
        row[:] = {"tick": low, "tick_high": high}.get(channel.name, row)
    return states
