"""From a SymPy expression to its first number, imports done: one package a fresh process.

``python latency.py NAME`` prints CPU seconds. The work is the wall, F = k (x - x_o) for x >= x_o, over three samples;
for PyDy a mass against that wall, since it compiles equations of motion only.
"""

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from timing import row

FILE = Path(__file__).resolve()
SAMPLES, K, X_O = np.array([0.0, 0.02, 0.03]), 150.0, 0.01
EXPECTED = np.array([0.0, 1.5, 3.0])


def _expression():
    import sympy as sp

    x, k, x_o = sp.symbols("x k x_o", real=True)
    return (x, k, x_o), sp.Piecewise((k * (x - x_o), x >= x_o), (0.0, True))


def hapticlab(units_open=True):
    import llvmlite.binding  # noqa: F401
    import pint  # noqa: F401

    import hapticlab as hl
    from hapticlab.compiler.engines.engine import load

    _ = hl.Scene, hl.compile, hl.n, hl.parameters, hl.when, hl.x  # names load on first use: the imports are done here
    if units_open:
        hl.parameters("any", units="N/m")  # reads pint's definitions, once a process

    def work():
        x, n = hl.x, hl.n
        k, x_o = hl.parameters("k x_o", units="N/m m")
        scene = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)))
        program = hl.compile(scene(k=K, x_o=X_O), T=1e-3, dtype="float64")
        return load(program, "llvm").run(3, SAMPLES).outputs[:, 0, 0]

    return work


def numba():
    import sympy as sp
    from numba import njit

    def work():
        symbols, expr = _expression()
        force = njit(sp.lambdify(symbols, expr, "math"))

        @njit
        def run(samples, k, x_o):
            return np.array([force(a, k, x_o) for a in samples])

        return run(SAMPLES, K, X_O)

    return work


def symjit():
    from symjit import compile_func

    def work():
        symbols, expr = _expression()
        force = compile_func(list(symbols), [expr])
        return np.array([force(a, K, X_O)[0] for a in SAMPLES])

    return work


def pydy(generator="cython"):
    import sympy as sp
    from pydy.codegen.ode_function_generators import generate_ode_function
    from sympy.physics.mechanics import dynamicsymbols

    def work():
        x, v = dynamicsymbols("x v")
        m, k, x_o = sp.symbols("m k x_o", real=True)
        force = sp.Piecewise((k * (x - x_o), x >= x_o), (0.0, True))
        rates = generate_ode_function(
            sp.Matrix([-force]), [x], [v], [m, k, x_o],
            mass_matrix=sp.Matrix([[m]]), coordinate_derivatives=sp.Matrix([v]), generator=generator,
        )  # fmt: skip
        return np.array([-rates(np.array([a, 0.0]), 0.0, np.array([1.0, K, X_O]))[1] for a in SAMPLES])

    return work


FIRST = "hapticlab, and the first unit of the process"
PREPARE = {
    "hapticlab": hapticlab, FIRST: lambda: hapticlab(False), "numba": numba, "symjit": symjit,
    "PyDy (cython)": pydy, "PyDy (lambdify)": lambda: pydy("lambdify"),
}  # fmt: skip


def measure(name, rounds):
    """Return the best CPU seconds of fresh processes (a compiler they start included), or why there is none."""
    best, here = None, {**os.environ, "PYTHONPATH": str(FILE.parents[2])}
    for _ in range(rounds):
        done = subprocess.run([sys.executable, str(FILE), name], env=here, capture_output=True, text=True, check=False)
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["failed"])[-1]
            return None, "not installed" if "ModuleNotFoundError" in last else last[:60]
        spent = float(done.stdout.split()[-1])
        best = spent if best is None else min(best, spent)
    return best, ""


def rows(rounds):
    """Measure every package; the ratio is to hapticlab."""
    found = {name: measure(name, min(rounds, 3)) for name in PREPARE}
    ours, targets, notes = found["hapticlab"][0], {"hapticlab": ("< 60 ms",)}, {FIRST: "pint's definitions, read once"}
    return [
        row(name, seconds, "ms", against=ours, note=note or notes.get(name, ""), target=targets.get(name, ()))
        for name, (seconds, note) in found.items()
    ]


def _cpu():
    """Return CPU seconds of this process and of the compilers it waited for."""
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


if __name__ == "__main__":
    prepared = PREPARE[sys.argv[1]]()
    clock = _cpu if sys.argv[1] == "PyDy (cython)" else time.process_time  # the first counts in steps of 10 ms
    start = clock()
    found = prepared()
    spent = clock() - start
    np.testing.assert_allclose(found, EXPECTED, rtol=1e-6)
    print(spent)
