"""A map of a million points, stiffness by damping of the handle, one second at 1 kHz: hapticlab, numba and JAX, and their memory.

``python tests/benchmarks/maps.py`` prints it alone. The peers get the handles' transition matrices ready made and only run;
``hl.sweep`` is called as a student calls it, and lays out, computes those matrices, compiles, runs and measures.
"""

import subprocess
import sys
import time
from pathlib import Path

if __name__ == "__main__":
    sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2])]

import footprint
import numpy as np
import peers
import scenes
from timing import SCALE, best_of, imported, row

import hapticlab as hl
from hapticlab.compiler.ir import cache
from hapticlab.device.simulated.transition import transition

SIDE, TICKS, V0 = 1000, 1000, 0.1
HAND = hl.Hand(m=0.1, b=2.0, k=200.0, push=1.0)
OURS = "hapticlab, hl.sweep with compiling"
#: points of which the memory is measured
MEMORY = (10_000, 100_000, 1_000_000)
#: each defines sweep(k), here over a map of len(k) points
DEFINE = """
import maps
def sweep(k):
    maps.{call}(len(k))()
"""


def axes(points):
    """Return k [N/m] and b [N s/m]: as nearly square as its sides are whole."""
    side = next(s for s in range(int(points**0.5), 0, -1) if points % s == 0)
    return np.geomspace(20, 2000, side), np.linspace(0.05, 1.0, points // side)


def ours(points, **given):
    """Return the sweep as it is for the first time: a second one finds the machine code made."""
    (k, b), paddle = axes(points), hl.SimulatedPaddle(m=0.05, b=0.1, T=scenes.T, hand=HAND)
    scene, fixed = scenes.wall()(x_o=0.0), {"metric": "peak_force", "progress": False, "v": V0}

    def call():
        cache.clear()
        return hl.sweep(scene, paddle, k=k, b=b, **fixed, **given).values.ravel()

    return call


def lanes(points):
    """Return each point's k, and the six coefficients of x, v from x, v, u, shape (6, points)."""
    k, b = axes(points)
    found = transition(0.05 + HAND.m, b + HAND.b, HAND.k, scenes.T)
    phi = np.array([found[e] for e in ("xx", "xv", "xu", "vx", "vv", "vu")])
    return np.repeat(k, len(b)), np.tile(phi, len(k))


def numba(points):
    """Return numba's run, one thread, compiled; None where it is not installed."""
    run = imported(peers.numba_map)
    if run is None:
        return None
    k, phi = lanes(points)
    peaks = np.empty(points)
    run(1, k[:1], phi[:, :1], HAND.push, V0, peaks[:1])
    return lambda: run(TICKS, k, phi, HAND.push, V0, peaks)


def jax(points):
    """Return JAX's run, compiled; None where it is not installed."""
    run = imported(peers.jax_map)
    if run is None:
        return None
    k, phi = lanes(points)
    compiled = run.lower(TICKS, k, phi, HAND.push, V0).compile()
    return lambda: np.asarray(compiled(k, phi, HAND.push, V0))


def rows(rounds):
    """Measure; the ratio is to hl.sweep on one thread, in CPU time of all threads."""
    points, everywhere = SIDE**2, "hapticlab, hl.sweep with workers=-1"
    calls = {OURS: ours(points), everywhere: ours(points, workers=-1)}
    calls |= {"numba, the run": numba(points), "JAX, the run": jax(points)}
    peaks = calls[OURS]()
    for call in filter(None, calls.values()):  # a peer may contract a product and a sum: a rounding to float32 apart
        np.testing.assert_allclose(call(), peaks, rtol=1e-5)
    seconds = best_of(max(1, rounds // 2), **calls)
    start = time.perf_counter()
    calls[everywhere]()
    notes = {everywhere: f"{time.perf_counter() - start:.2g} s by the clock"}
    targets = {"numba, the run": [">= 3 x"]}
    lines = [
        row(f"a million points: {name}", s, against=seconds[OURS], note=notes.get(name, ""), target=targets.get(name, []))
        for name, s in seconds.items()
    ]
    return [*lines, *_memory()]


def _memory():
    """Return what a map adds to the memory of a process that has run one of 16 points."""
    if sys.platform != "linux":
        return [row("memory of a map", None, "MB", note="measured on Linux only")]
    found = []
    for call, sizes in (("ours", MEMORY), ("numba", MEMORY[-1:]), ("jax", MEMORY[-1:])):
        for points in sizes:
            what = f"more memory for a map of {points} points: {'hapticlab' if call == 'ours' else call}"
            code = footprint.MEMORY.format(path=sys.path[:2], define=DEFINE.format(call=call), points=points)
            try:
                added = int(footprint._fresh(code).split()[-1])
            except subprocess.CalledProcessError as error:
                if "NoneType" not in error.stderr:
                    raise
                added = None
            found.append(row(what, added, "MB", note=f"its result is {8e-6 * points:g} MB" if added else ""))
    return found


if __name__ == "__main__":
    for line in rows(6):
        ratio = "" if line["ratio"] is None else f"{line['ratio']:6.2f} x"
        print(f"{line['what']:<66}{line['value'] * SCALE[line['unit']]:10.4g} {line['unit']} {ratio} {line['note']}", flush=True)
