"""Linearised at operating points: the equations of motion, and the tick of the program that runs them.

Nothing is differenced: slopes come from the instructions, over all points at once (:mod:`hapticlab.compiler.algebra.tangents`).
"""

import numpy as np

from ...compiler.algebra.graph import Graph
from ...compiler.algebra.phase import TICKS
from ...compiler.algebra.tangents import tangents
from ...compiler.events.taylor_method import Taylor
from ...compiler.methods.chosen_method import ChosenMethod, chosen_method
from ...compiler.prune.excluded_modes import folded
from ...compiler.tick.compile_scene import compile
from ...compiler.tick.handle_samples import is_past_sample
from ...compiler.tick.motion_program import moving_scene
from ...compiler.tick.source import Options, Source
from ...errors import AnalysisError
from .slopes import Slopes


def slopes_of(scene, T, damped=False, exact=False):
    """The :class:`Slopes` of a switched scene's equations of motion; with ``exact``, of those that are not linear."""
    live = () if exact else None
    options, fixed = Options(ChosenMethod(exact, Taylor()), T, hold="zoh", dtype="float64", live=live), folded(scene, live)
    return Slopes(moving_scene(Source(scene, scene.form, options, fixed, Graph(fixed))), damped)


def motion_at(scene, points, T):
    """(J, n): y' = J y of a switched scene at P points, shape (P, S, S), of n positions, their rates, and the rest."""
    slopes = slopes_of(scene, T)
    return slopes.jacobian(_states(points), points=len(points), **_modes(scene, points)), slopes.seconds


def tick_at(scene, points, T, **options):
    """(maps, handle): the tick of a switched scene's program at each point, its cases held in their modes.

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
    return forces_and_ticks_at(scene, points, T, **options)[1:]


def forces_and_ticks_at(scene, points, T, **options):
    """(forces [N] of shape (P,), maps, handle): what :func:`tick_at` returns, and the force at each point."""
    if not (chosen_method(options.get("method")).exact and scene.switches):
        live = tuple(s.name for s in scene.switches)
        return forces_and_ticks_of(compile(scene, T=T, live=live, dtype="float64", **options), scene, points)
    forces, maps = np.zeros(len(points)), [None] * len(points)
    for mode in dict.fromkeys(p.mode for p in points):  # an exponential is that of one mode
        program = compile(scene.set(mode), T=T, live=(), dtype="float64", **options)
        those = [k for k, p in enumerate(points) if p.mode == mode]
        forces[those], made, handle = forces_and_ticks_of(program, scene, [points[k] for k in those])
        for k, one in zip(those, made, strict=True):
            maps[k] = one
    return forces, maps, handle


def forces_and_ticks_of(program, scene, points):
    """The same of a program that is compiled: of a Switched scene, or of one without switches."""
    if len(program.inputs) != 1:
        raise AnalysisError(f"{program.name}: needs a program of x alone; leave velocity='measured' out")
    P, modes = len(points), _modes(scene, points)
    kept = [k for k, c in enumerate(program.states) if c.type not in ("i32", "bool") and c.name not in TICKS]
    leaves = _handle(points) | {("param", k): value for k, value in enumerate(program.values)}
    leaves |= {("param", k): modes[c.name] for k, c in enumerate(program.parameters) if c.name in modes}
    first, _ = tangents(program.init.instructions, program.init.states, leaves, [], P)
    for k, channel in enumerate(program.states):
        known = channel.name in points[0].values
        kind = bool if channel.type == "bool" else float
        leaves["state", k] = _column(points, channel.name) if known else first[k].astype(kind)
    wanted = [program.tick.outputs[0], *(program.tick.states[k] for k in kept)]
    directions = [*(("state", k) for k in kept), ("input", 0)]
    values, slopes = tangents(program.tick.instructions, wanted, leaves, directions, P)
    whole = np.moveaxis(slopes, 2, 0)
    handle = np.array([k for k, state in enumerate(kept) if is_past_sample(program.states[state].name)], int)
    return values[0], [(one[1:, :-1], one[1:, -1], one[0, :-1], one[0, -1]) for one in whole], handle


def _column(points, name):
    return np.array([p.values[name] for p in points])


def _handle(points):
    return {("input", 0): _column(points, "x"), ("input", 1): _column(points, "v")}


def _states(points):
    """name -> array over points."""
    return {name: _column(points, name) for name in points[0].values}


def _modes(scene, points):
    """name -> array over points of the switches."""
    return {s.name: np.array([float(p.mode[k]) for p in points]) for k, s in enumerate(scene.switches)}
