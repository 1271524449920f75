"""The largest force at 10 000 stiffnesses: hapticlab over lanes, C by hand with vectors, numba on scalar code."""

import numpy as np
import peers
import scenes
from floors import lanes
from timing import best_of, imported, row

import hapticlab as hl
from hapticlab.analysis.measures import METRICS, WithFault
from hapticlab.compiler.engine import load
from hapticlab.device.simulated import link

POINTS, TICKS, V0 = 10_000, 1000, 0.1


def rows(rounds):
    """Measure both paddles; the ratio is to the C by hand with vectors, one core for all."""
    return [line for name, paddle in scenes.paddles().items() for line in _paddle(name, paddle, rounds)]


def _paddle(name, paddle, rounds):
    scene, k = scenes.wall()(x_o=0.0), np.geomspace(20, 2000, POINTS)
    sweep = lambda: hl.sweep(scene, paddle, metric="peak_force", v=V0, k=k, progress=False).values  # noqa: E731
    program = link(paddle.program(scene(k=1.0)), paddle, WithFault(METRICS["peak_force"](TICKS)))
    loaded, values = load(program), dict(zip((c.name for c in program.parameters), program.values, strict=True))
    phi = [values.get(f"plant.phi_{a}{b}", float(a == b)) for a in "xv" for b in "xvu"]
    push, counts = values.get("plant.push", 0.0), values.get("plant.counts_per_metre", 0.0)
    points = np.array([k if c == "k" else np.full(POINTS, V0 if c == "start.v" else v) for c, v in values.items()])
    inputs = paddle.inputs(TICKS)
    by_hand, peaks = lanes(TICKS, k, phi, V0, push, counts)
    by_hand()
    for found in (sweep(), loaded.run(TICKS, inputs, points, every=TICKS).outputs[0, 0]):
        np.testing.assert_allclose(found, peaks, rtol=1e-12)
    numba = imported(peers.numba_lanes)
    arguments = (TICKS, k, np.array(phi), push, counts, V0, np.empty(POINTS))
    if numba:
        numba(*arguments)
        np.testing.assert_allclose(arguments[-1], peaks, rtol=1e-12)
    calls = {
        "C by hand, SIMD": by_hand,
        "hapticlab, the run": lambda: loaded.run(TICKS, inputs, points, every=TICKS),
        "hapticlab, hl.sweep with compiling": sweep,
        "numba, the run": numba and (lambda: numba(*arguments)),
    }
    seconds = best_of(rounds, **calls)
    return [row(f"{name}: {call}", seconds[call], against=seconds["C by hand, SIMD"]) for call in calls]
