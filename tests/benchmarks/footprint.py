"""Memory of a sweep, sizes of a compiled program, and the import, each in a fresh process."""

import os
import subprocess
import sys

import scenes
from timing import row

import hapticlab as hl
from hapticlab.compiler.bytecode import encode

CLOCK = "import time; start = time.process_time(); {}; print(time.process_time() - start)"
#: names load on first use, so the import alone says little: also what writing a scene needs, and everything
IMPORTS = {
    "import sympy": "import sympy",
    "import hapticlab": "import hapticlab",
    "import hapticlab and what writes a scene": "from hapticlab import Scene, parameters, coordinate, when, n, t, v, x",
    "import hapticlab and every public name": "from hapticlab import *",
}
PEAK = """
import resource, sys
sys.path[:0] = {path!r}
import numpy as np, scenes, hapticlab as hl
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
small = dict(metric="peak_force", v=0.1, progress=False)
scene, paddle = scenes.wall()(x_o=0.0), scenes.paddles()["wall"]
hl.sweep(scene, paddle, duration=0.01, k=np.geomspace(20, 2000, 16), **small)
before = peak()
hl.sweep(scene, paddle, k=np.geomspace(20, 2000, 10_000), **small)
print(before, peak() - before)
"""


def rows(rounds):
    """Measure; the ratio is given where there is something to compare with."""
    found = []
    if sys.platform != "win32":
        before, more = map(int, _fresh(PEAK.format(path=sys.path[:2])).split())
        found += [row("peak memory, all imported", before, "MB"), row("more for a sweep of 10 000 points", more, "MB")]
    for name, scene in (("wall", scenes.wall()), ("coupler", scenes.coupler())):
        found.append(row(f"bytecode of the {name}", len(encode(hl.compile(scene, T=scenes.T))), "B"))
    taken = {name: min(float(_fresh(CLOCK.format(code))) for _ in range(rounds)) for name, code in IMPORTS.items()}
    sympy = taken.pop("import sympy")
    return [*found, row("import sympy", sympy, "ms"), *(row(name, t, "ms", against=sympy) for name, t in taken.items())]


def _fresh(code):
    here = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path[:2])}
    return subprocess.run([sys.executable, "-c", code], env=here, capture_output=True, text=True, check=True).stdout
