"""Multistep methods in a program: the rates of the steps before are states, whose first values RK4 finds backwards."""

from ...scene.notation.symbols import t, v, x
from ..algebra.expressions import Translator
from ..ir.channels import channel_of, short
from ..ir.program import Channel
from .force_timing import IMPULSE
from .steps import before


def advanced(dynamics, groups):
    """Return (q, w, s) after one period, and keep the rates of its last steps for the next.

    Before the first sample the handle moved as it does at it, and the bodies as their equations of motion have it, so that
    the first step is as good as any and the tick has no branch for it.
    """
    tracing, method = dynamics.lowering.tracing, dynamics.method
    sizes, past = [len(part) for part in groups], []
    first = _first(dynamics, method.steps - 1)
    for k, rates in enumerate(first):
        states = [
            tracing.state(("past", k, j), _channel(state, k, tracing.real), rate)
            for j, (state, rate) in enumerate(zip(dynamics.states, rates, strict=True))
        ]
        past.append(_parts(states, sizes))
    for step in range(dynamics.substeps):
        groups, past = method.step(dynamics.rates, step * dynamics.h, groups, dynamics.h, past)
    for k, rates in enumerate(past):
        for j, rate in enumerate(rate for part in rates for rate in part):
            tracing.set_next(("past", k, j), rate)
    return groups


def _first(dynamics, count):
    """Return the rates of the steps before the first sample, traced in the init block."""
    lowering = dynamics.lowering
    start = [lowering.tracing.init.const(0.0) if s == IMPULSE else lowering.first_of(s) for s in dynamics.states]
    n = len(dynamics.second)

    def rates(tau, *state):
        return dynamics.rates(tau, *state, at=at)

    def at(tau, q, w, s):
        position, velocity = lowering.at_start(x(t)), lowering.at_start(v(t))
        held = dict(zip(dynamics.states, [*q, *w, *s], strict=True)) | {x(t): position + velocity * tau, v(t): velocity}

        def make(leaf):
            return Translator(lowering.tracing.init, leaf, None, lowering.scene.values, lowering.graph, lowering.at_start)

        return dynamics.translator(held, tau, lowering.at_start, make)

    found = before(rates, (start[:n], start[n : 2 * n], start[2 * n :]), dynamics.h, count)
    return [[rate for part in past for rate in part] for past in found]


def _parts(values, sizes):
    first, second = sizes[0], sizes[0] + sizes[1]
    return values[:first], values[first:second], values[second:]


def _channel(state, k, real):
    of = channel_of(state, real)
    return Channel(f"rate of {short(of.name)}, {k + 1} back", "1/s" if of.unit == "1" else f"{of.unit}/s", real)
