"""Memory of a sweep, sizes of a compiled program, and the import, each in a fresh process."""

import os
import subprocess
import sys

import scenes
import sweeps
from timing import row

import hapticlab as hl
from hapticlab.compiler.engines.bytecode import encode

CLOCK = "import time; start = time.process_time(); {}; print(time.process_time() - start)"
#: names load on first use, so the import alone says little: also what writing a scene needs, and everything
IMPORTS = {
    "import hapticlab": "import hapticlab",
    "import hapticlab and what writes a scene": "from hapticlab import Scene, parameters, coordinate, when, n, t, v, x",
    "import hapticlab and every public name": "from hapticlab import *",
}
TARGETS = {name: ["<= 1.3 x"] for name in list(IMPORTS)[:2]}
#: each defines sweep(k): the largest force of the wall at every stiffness, over one simulated second
SWEEPS = {
    "C by hand": """
from floors import lanes
def sweep(k):
    lanes({ticks}, k, {phi}, {v0})[0]()
""",
    "hapticlab": """
import hapticlab as hl, scenes
def sweep(k):
    hl.sweep(scenes.wall()(x_o=0.0), scenes.paddles()["wall"], metric="peak_force", v={v0}, k=k, progress=False)
""",
    "numba": """
from peers import numba_lanes
run = numba_lanes()
def sweep(k):
    run({ticks}, k, np.array({phi}), 0.0, 0.0, {v0}, np.empty(len(k)))
""",
}
#: the first, small sweep loads and compiles; Linux then forgets the peak, so that the second shows its own
MEMORY = """
import sys
sys.path[:0] = {path!r}
import numpy as np
def memory(name):
    return next(1024 * int(line.split()[1]) for line in open("/proc/self/status") if line.startswith(name))
{define}
sweep(np.geomspace(20, 2000, 16))
first = memory("VmHWM")
with open("/proc/self/clear_refs", "w") as file:
    file.write("5")
before, k = memory("VmRSS"), np.geomspace(20, 2000, {points})
sweep(k)
print(first, memory("VmHWM") - before)
"""


def rows(rounds):
    """Measure; the ratio is given where there is something to compare with."""
    found = _memory()
    for name, scene in (("wall", scenes.wall()), ("coupler", scenes.coupler())):
        found.append(row(f"bytecode of the {name}", len(encode(hl.compile(scene, T=scenes.T))), "B"))
    codes = {"import sympy": "import sympy", **IMPORTS}
    taken = {name: min(float(_fresh(CLOCK.format(code))) for _ in range(rounds)) for name, code in codes.items()}
    sympy = taken["import sympy"]
    return [*found, *(row(name, s, "ms", against=sympy, target=TARGETS.get(name, [])) for name, s in taken.items())]


def _memory():
    """Return the peak with everything loaded and compiled, its ratio to the C by hand, and what the sweep adds."""
    if sys.platform != "linux":
        return [row("memory of a sweep", None, "MB", note="measured on Linux only")]
    phi, _, _ = sweeps.constants(scenes.paddles()["wall"])
    known = {"ticks": sweeps.TICKS, "v0": sweeps.V0, "phi": phi}
    found = {name: _peak(define.format(**known)) for name, define in SWEEPS.items()}
    floor, more = found["C by hand"][0], f"more for a sweep of {sweeps.POINTS} points"
    note = "its two arrays are 80 kB each"
    return [
        *(row(f"peak memory, loaded and compiled: {name}", peak, "MB", against=floor) for name, (peak, _) in found.items()),
        *(
            row(f"{more}: {name}", added, "MB", note="" if added is None or added > 1e5 else note)
            for name, (_, added) in found.items()
        ),
    ]


def _peak(define):
    """Return the two numbers in bytes, or None twice where the package is not installed."""
    try:
        return [*map(int, _fresh(MEMORY.format(path=sys.path[:2], define=define, points=sweeps.POINTS)).split())]
    except subprocess.CalledProcessError as error:
        if "ModuleNotFoundError" in error.stderr:
            return [None, None]
        raise


def _fresh(code):
    here = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path[:2])}
    return subprocess.run([sys.executable, "-c", code], env=here, capture_output=True, text=True, check=True).stdout
