"""Multistep methods in a program: the rates of the steps before are states, whose first values RK4 finds backwards."""

from ...scene.notation.symbols import t, v, x
from ..algebra.expressions import Translator
from ..ir.channels import channel_of, short
from ..ir.program import Channel
from ..prune.mass_matrix import start_of
from .force_timing import IMPULSE
from .steps import before


def advanced(method, substeps, equations, tick, start, state, rates):
    """Trace one period, and keep the rates of its last steps for the next.

    Before the first sample the handle moved as it does at it, and the bodies as their equations of motion have it, so that
    the first step is as good as any and the tick has no branch for it.

    Parameters
    ----------
    method : Method
    substeps : int
    equations : Equations
    tick : Tick
    start : Translator
        What expressions are at the first sample.
    state : (q, w, s)
        At the sample, lists of values.
    rates : callable ``(tau, q, w, s) -> (a, ds)``

    Returns
    -------
    (q, w, s) at the next sample
    """
    tracing, h = tick.tracing, equations.h
    sizes, past = [len(part) for part in state], []
    for k, first in enumerate(_first(equations, tick, start, method.steps - 1)):
        states = [
            tracing.state(("past", k, j), _channel(of, k, tracing.real), rate)
            for j, (of, rate) in enumerate(zip(equations.states, first, strict=True))
        ]
        past.append(_parts(states, sizes))
    for step in range(substeps):
        state, past = method.step(rates, step * h, state, h, past)
    for k, last in enumerate(past):
        for j, rate in enumerate(rate for part in last for rate in part):
            tracing.set_next(("past", k, j), rate)
    return state


def _first(equations, tick, start, count):
    """The rates of the steps before the first sample, traced in the init block."""
    init = tick.tracing.init
    first = [init.const(0.0) if s == IMPULSE else start(start_of(s)) for s in equations.states]

    def rates(tau, q, w, s):
        position, velocity = start(x(t)), start(v(t))
        held = dict(zip(equations.states, [*q, *w, *s], strict=True)) | {x(t): position + velocity * tau, v(t): velocity}

        def otherwise(expr):
            return start(expr) + tau if expr == t else start(expr)

        def make(leaf):
            return Translator(init, leaf, None, tick.values, tick.graph, start)

        return equations.solved(equations.moment(make, held, otherwise), equations.damped)

    found = before(rates, equations.grouped(first), equations.h, count)
    return [[rate for part in past for rate in part] for past in found]


def _parts(values, sizes):
    first, second = sizes[0], sizes[0] + sizes[1]
    return values[:first], values[first:second], values[second:]


def _channel(state, k, real):
    of = channel_of(state, real)
    return Channel(f"rate of {short(of.name)}, {k + 1} back", "1/s" if of.unit == "1" else f"{of.unit}/s", real)
