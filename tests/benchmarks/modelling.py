"""Modelling against its peers: ``python tests/benchmarks/modelling.py [--quick] [--links 8] [--kinds absolute] [--json FILE]``.

Planar pendulums of 1 to 8 links (absolute angles, relative angles, on a cart) from the Lagrangian or the equations to
running machine code, the operations of one right-hand side, and the time of a step; then balls in a column with penalty
contacts. Prints markdown; in brackets is the ratio to hapticlab in the same run.

``pip install "hapticlab[bench]" casadi mujoco`` brings the peers; some need gcc. A peer that is not installed is left out.
Before anything is timed every peer's accelerations are compared with the equations in closed form, to 1e-9.

Compile time is CPU time, subprocesses included, imports done and SymPy's cache empty, to the end of a first step; the
garbage collector is kept from what other peers left. Every mass and length is a live parameter. An operation is an
arithmetic operation or a function call, after the peer's own common subexpressions; an LU by NumPy is counted as the
operations of LAPACK's gesv. SymPy's LagrangesMethod is given LIMIT seconds of CPU time.
"""

import argparse
import functools
import gc
import json
import os
import platform
import signal
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import modelling_contacts as contacts  # noqa: E402
import modelling_peers as peers  # noqa: E402
import numpy as np  # noqa: E402
from sympy.core.cache import clear_cache  # noqa: E402
from timing import best_of  # noqa: E402

LIMIT = 60  # s of CPU time for SymPy's LagrangesMethod
OURS = "hapticlab"
PENDULUM = {
    OURS: peers.hapticlab,
    "CasADi, its VM": peers.casadi,
    "CasADi, its C by gcc -O3": functools.partial(peers.casadi, c_code=True),
    "PyDy, cython, NumPy's solve": functools.partial(peers.pydy, generator="cython"),
    "PyDy, cython, its symbolic LU": functools.partial(peers.pydy, generator="cython", linear_sys_solver="sympy:LU"),
    "PyDy, lambdify": functools.partial(peers.pydy, generator="lambdify"),
    "numba on lambdify(cse)": peers.numba,
    "MuJoCo": peers.mujoco,
}
OWN = "MuJoCo, its own contacts"
COLUMN = {
    OURS: contacts.hapticlab,
    "CasADi, its VM": contacts.casadi,
    "CasADi, its C by gcc -O3": functools.partial(contacts.casadi, c_code=True),
    "numba, a loop by hand": contacts.numba,
    "MuJoCo, tendons with a dead band": contacts.mujoco,
    OWN: functools.partial(contacts.mujoco, own=True),
}
LAGRANGE = "SymPy LagrangesMethod, derivation alone"
#: heading of a table -> where :func:`cells` finds its numbers
TABLES = {
    "Compile time [ms]": "compile",
    "Operations of one right-hand side: M, f and the solve": "operations",
    "Those of them that the parameters alone do not settle": "moving",
    "One RK4 step [ns]": "run",
    "One semi-implicit Euler step [ns]": "semi_implicit",
}


def spent():
    """Return the CPU seconds of this process and of those it waited for."""
    return time.process_time() + sum(os.times()[2:4])


def compiled(make, model, rounds):
    """Return what a peer makes of a model, and the least CPU seconds from the model to the end of a first step."""
    seconds = []
    for _ in range(rounds):
        clear_cache()
        gc.collect()
        gc.freeze()
        start = spent()
        made = make(model)
        made.run(1)
        seconds.append(spent() - start)
        gc.unfreeze()
    return made, min(seconds)


def checked(name, made, model, other):
    """Refuse a peer that does not solve the same equations as NumPy, or does not step as the ``other`` does."""
    if name == OWN:
        weight = [sum(model.numbers()[0]) * contacts.G]
        return np.testing.assert_allclose(made.accelerations(), weight, rtol=1e-3, err_msg=name)
    wanted, found = model.reference(), model.absolute(made.accelerations())
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9 * np.abs(wanted).max(), err_msg=name)
    for run, end in ((made.run, other.run(20)), (made.semi_implicit, other.semi_implicit(20))):
        if run:
            np.testing.assert_allclose(run(20), end, rtol=0, atol=1e-9, err_msg=name)


def cells(makers, model, rounds):
    """Return (where, peer) -> number of one model."""
    made, found = {}, {}
    for name, make in makers.items():
        try:
            made[name], seconds = compiled(make, model, rounds if name == OURS or "CasADi" in name else 1)
        except (ImportError, FileNotFoundError):  # not installed, or without gcc
            continue
        found["compile", name] = 1e3 * seconds
    for name, peer in made.items():
        checked(name, peer, model, made[OURS])
        if peer.operations:
            found["operations", name], found["moving", name] = peer.operations()
    for which in ("run", "semi_implicit"):
        steps = {name: 50 if "PyDy" in name else 2000 for name, peer in made.items() if getattr(peer, which)}
        calls = {name: functools.partial(getattr(made[name], which), many) for name, many in steps.items()}
        best_of(1, **calls)
        found |= {(which, name): 1e9 * s / steps[name] for name, s in best_of(rounds + 1, **calls).items()}
    return found


def lagranges_method(model):
    """Return the CPU seconds that SymPy's LagrangesMethod takes, or None past LIMIT."""

    def late(*_):
        raise TimeoutError

    clear_cache()
    signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, LIMIT)
    start = spent()
    try:
        peers.lagranges_method(model)
        return spent() - start
    except TimeoutError:
        return None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def pendulums(kind, links, rounds):
    """Return size -> cells of the pendulums of one kind."""
    found, late = {}, False
    for n in links:
        model = peers.Pendulum(n, kind)
        found[n] = cells(PENDULUM, model, rounds)
        seconds = None if late else lagranges_method(model)
        late = seconds is None
        found[n]["compile", LAGRANGE] = f"> {LIMIT} s" if late else 1e3 * seconds
    return found


def table(heading, where, found):
    """Return one table as markdown lines; the best peer but hapticlab is in bold, in brackets the ratio to hapticlab."""
    names = list(dict.fromkeys(name for by in found.values() for at, name in by if at == where and by[at, name] is not None))
    lines = ["", f"**{heading}**", "", f"| | {' | '.join(map(str, found))} |", "|---|" + "---:|" * len(found)]
    for name in names:
        row = []
        for by in found.values():
            value, ours = by.get((where, name)), by.get((where, OURS))
            if not isinstance(value, (int, float)):
                row.append(value or "-")
                continue
            others = [v for (at, who), v in by.items() if at == where and who != OURS and isinstance(v, (int, float))]
            mark = "**" if name != OURS and value == min(others) else ""
            ratio = "" if name == OURS or not ours else f" ({value / ours:.3g} x)"
            row.append(f"{mark}{value:.4g}{ratio}{mark}")
        lines.append(f"| {name} | {' | '.join(row)} |")
    return lines if names else []


def main(arguments=None):
    """Measure, print each section as it comes, and write the JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer sizes and rounds")
    parser.add_argument("--links", type=int, nargs="+", help="sizes of the pendulums; 1 to 8 without it")
    parser.add_argument("--contacts", type=int, nargs="+", help="sizes of the column; 1 to 16 without it")
    parser.add_argument("--kinds", nargs="+", default=peers.KINDS, choices=peers.KINDS)
    parser.add_argument("--json", metavar="FILE", help="also write the numbers to FILE")
    options = parser.parse_args(arguments)
    rounds = 1 if options.quick else 3
    links = options.links or ([1, 2, 4] if options.quick else range(1, 9))
    sizes = options.contacts or ([1, 4] if options.quick else [1, 2, 4, 8, 16])
    cells(PENDULUM, peers.Pendulum(1), 1)  # imports
    machine = f"{platform.processor() or platform.machine()}, Python {platform.python_version()}, {platform.system()}"
    print(f"{machine}; CPU time, the best of {rounds} or more", flush=True)
    results = {}
    for kind in options.kinds:
        _section(results, f"Pendulum, {kind}; links", pendulums(kind, links, rounds))
    _section(results, "Column of balls; contacts", {k: cells(COLUMN, contacts.Column(k), rounds) for k in sizes})
    if options.json:
        Path(options.json).write_text(json.dumps(results, indent=1) + "\n")


def _section(results, title, found):
    lines = [line for heading, where in TABLES.items() for line in table(heading, where, found)]
    print("\n".join(["", f"## {title}", *lines]), flush=True)
    results[title] = {n: {f"{where}: {name}": v for (where, name), v in by.items()} for n, by in found.items()}


if __name__ == "__main__":
    main()
