"""Linearised at operating points: the equations of motion, and the tick of the program that runs them.

Nothing is differenced: slopes come from the instructions, over all points at once (:mod:`hapticlab.compiler.tangents`).
"""

import numpy as np

from ..compiler.advance import Taylor
from ..compiler.channels import channel_of
from ..compiler.exact import EXACT
from ..compiler.guards import Leaves
from ..compiler.lower import compile
from ..compiler.lowering import Lowering
from ..compiler.phase import TICKS
from ..compiler.tangents import tangents
from ..compiler.trace import Value
from ..errors import AnalysisError


def motion_at(scene, points, T):
    """Return (J, n): y' = J y of a switched scene at P points, shape (P, S, S), of n positions, their rates, and the rest.

    Contacts of an instant are taken apart, and friction slipping.
    """
    lowering = Lowering(scene, scene.form, False, Taylor(), T, 1, "zoh", "float64", "backward_difference", None, "before")
    dynamics, tracing = lowering.dynamics, lowering.tracing
    if not dynamics.states:
        return np.zeros((len(points), 0, 0)), 0
    new, n, m = Leaves(tracing.tick), len(dynamics.second), len(dynamics.first)
    q, w, s = ([new() for _ in range(count)] for count in (n, n, m))
    tau = new()
    given = dynamics.contacts.reactions(tau, q, w, s, new) if dynamics.contacts.located else []
    rates = [r if isinstance(r, Value) else tracing.tick.const(r) for part in dynamics.rates(tau, q, w, s) for r in part]
    apart = {_leaf(r.leaf): 0.0 for r in given} | {_leaf(r.side): np.bool_(True) for r in given if r.side is not None}
    moving = [_leaf(value) for value in (*q, *w, *s)]
    names = [channel_of(state, "f64").name for state in dynamics.states]
    leaves = tracing.at_start(scene.values) | apart | {_leaf(tau): 0.0} | _handle(points)
    leaves |= _parameters(scene, [p.name for p in tracing.parameters], points)
    leaves |= {leaf: _column(points, name) for leaf, name in zip(moving, names, strict=True)}
    _, slopes = tangents(tracing.tick.instructions, [r.id for r in rates], leaves, moving, len(points))
    J = np.zeros((len(points), len(moving), len(moving)))
    J[:, :n, n : 2 * n] = np.eye(n)
    J[:, n:] = np.moveaxis(slopes, 2, 0)
    return J, n


def tick_at(scene, points, T, **options):
    """Return (maps, handle): the tick of a switched scene's program at each point, its cases held in their modes.

    A map is (A, B, C, D) with states' = A states + B x, F = C states + D x for small changes; ``handle`` are the numbers of
    the states that remember samples of the handle alone.

    Parameters
    ----------
    scene : Switched
    points : sequence of OperatingPoint
    T : float
        Sampling period [s].
    **options
        Of :func:`hapticlab.compile`, but for T, live, dtype and velocity.
    """
    method = options.get("method", "rk4")
    if not (isinstance(method, str) and method.startswith(EXACT)) or not scene.switches:
        live = tuple(s.name for s in scene.switches)
        return _tick(compile(scene, T=T, live=live, dtype="float64", **options), scene, points)
    programs, maps = {}, []
    for p in points:  # an exponential is that of one mode
        if p.mode not in programs:
            programs[p.mode] = compile(scene.set(p.mode), T=T, live=(), dtype="float64", **options)
        made, handle = _tick(programs[p.mode], scene, [p])
        maps += made
    return maps, handle


def _tick(program, scene, points):
    """Return what :func:`tick_at` returns, of a program that is compiled."""
    if len(program.inputs) != 1:
        raise AnalysisError(f"{program.name}: needs a program of x alone; leave velocity='measured' out")
    P = len(points)
    kept = [k for k, c in enumerate(program.states) if c.type not in ("i32", "bool") and c.name not in TICKS]
    leaves = _handle(points) | _parameters(scene, [c.name for c in program.parameters], points, program.values)
    first, _ = tangents(program.init.instructions, program.init.states, leaves, [], P)
    for k, channel in enumerate(program.states):
        known = channel.name in points[0].values
        kind = bool if channel.type == "bool" else float
        leaves["state", k] = _column(points, channel.name) if known else first[k].astype(kind)
    wanted = [program.tick.outputs[0], *(program.tick.states[k] for k in kept)]
    directions = [*(("state", k) for k in kept), ("input", 0)]
    _, slopes = tangents(program.tick.instructions, wanted, leaves, directions, P)
    whole = np.moveaxis(slopes, 2, 0)
    handle = np.array([k for k, state in enumerate(kept) if program.states[state].name.startswith(("x(n-", "v(n-"))], int)
    return [(one[1:, :-1], one[1:, -1], one[0, :-1], one[0, -1]) for one in whole], handle


def _leaf(value):
    i = value.builder.instructions[value.id]
    return i.op, i.index


def _column(points, name):
    return np.array([p.values[name] for p in points])


def _handle(points):
    return {("input", 0): _column(points, "x"), ("input", 1): _column(points, "v")}


def _parameters(scene, names, points, values=None):
    """Return what the parameters are at each point: the switches as the modes have them."""
    number = {s.name: k for k, s in enumerate(scene.switches)}
    bound = dict(zip(names, values, strict=True)) if values is not None else scene.values
    return {
        ("param", k): np.array([float(p.mode[number[name]]) for p in points]) if name in number else bound[name]
        for k, name in enumerate(names)
    }
