"""The largest force at 10 000 stiffnesses: hapticlab over lanes, C by hand with vectors, numba on scalar code."""

import numpy as np
import peers
import scenes
from floors import lanes
from timing import best_of, imported, row

import hapticlab as hl
from hapticlab.analysis.sweeps.sweep_measures import METRICS, WithFault
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.ir import cache
from hapticlab.device.simulated.closed_loop import link

POINTS, TICKS, V0 = 10_000, 1000, 0.1
FLOOR, OURS, SWEEP = "C by hand, SIMD", "hapticlab, the run", "hapticlab, hl.sweep with compiling"
CHATTER = ", metric chatter"
SECONDS = {"wall": "< 0.05 s", "wall, hand, encoder": "< 0.2 s"}


def rows(rounds):
    """Measure both paddles; the ratio is to the C by hand with vectors, one core for all."""
    return [line for name, paddle in scenes.paddles().items() for line in _paddle(name, paddle, rounds)]


def stiffnesses(points=POINTS):
    """Return the swept k [N/m]."""
    return np.geomspace(20, 2000, points)


def constants(paddle):
    """Return what the loops by hand need of a paddle: phi (x, v from x, v, u), the push [N] and the counts [1/m]."""
    values = dict(zip(*_linked(paddle, "peak_force")[1:], strict=True))
    phi = [float(values.get(f"plant.phi_{a}{b}", a == b)) for a in "xv" for b in "xvu"]
    return phi, values.get("plant.push", 0.0), values.get("plant.counts_per_metre", 0.0)


def _linked(paddle, metric):
    """Return the program of the wall on a paddle that measures a metric, and its parameters' names and values."""
    measure = METRICS[metric](TICKS, scenes.T)
    program = link(paddle.program(scenes.wall()(x_o=0.0, k=1.0)), paddle, WithFault(measure))
    return program, [c.name for c in program.parameters], program.values


def _run(paddle, k, metric):
    """Return a call of the compiled program over all lanes."""
    program, names, values = _linked(paddle, metric)
    given = {"k": k, "start.v": V0}
    points = np.array([np.broadcast_to(given.get(c, v), len(k)) for c, v in zip(names, values, strict=True)])
    loaded, inputs = load(program), paddle.inputs(TICKS)
    return lambda: loaded.run(TICKS, inputs, points, every=TICKS).outputs[0, 0]


def _sweep(paddle, k, metric):
    """Return a call of the sweep as a student writes it, for the first time: a second one finds the machine code made."""
    scene = scenes.wall()(x_o=0.0)

    def call():
        cache.clear()
        return hl.sweep(scene, paddle, metric=metric, v=V0, k=k, progress=False).values

    return call


def _paddle(name, paddle, rounds):
    k, (phi, push, counts) = stiffnesses(), constants(paddle)
    by_hand, peaks = lanes(TICKS, k, phi, V0, push, counts)
    calls = {FLOOR: by_hand, OURS: _run(paddle, k, "peak_force"), SWEEP: _sweep(paddle, k, "peak_force")}
    by_hand()
    for ours in (OURS, SWEEP):
        np.testing.assert_allclose(calls[ours](), peaks, rtol=1e-12)
    numba, found = imported(peers.numba_lanes), np.empty(POINTS)
    calls["numba, the run"] = numba and (lambda: numba(TICKS, k, np.array(phi), push, counts, V0, found))
    if numba:
        calls["numba, the run"]()
        np.testing.assert_allclose(found, peaks, rtol=1e-12)
    calls |= {OURS + CHATTER: _run(paddle, k, "chatter"), SWEEP + CHATTER: _sweep(paddle, k, "chatter")}
    return _table(name, best_of(5 * rounds, **calls))  # short calls: a burst of other work would cover a few rounds


def _table(name, seconds):
    """Return the lines; only the run with the metric of the C by hand has targets."""
    target = {OURS: [SECONDS[name], "<= 1.1 x"]}
    lines = [row(f"{name}: {c}", s, against=seconds[FLOOR], target=target.get(c, [])) for c, s in seconds.items()]
    numba = row(f"{name}: numba, ratio to hapticlab", seconds["numba, the run"], against=seconds[OURS], target=[">= 8 x"])
    return [*lines, numba]
