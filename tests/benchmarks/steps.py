"""One tick with one RK4 step, in a loop of many ticks: hapticlab's engines, numba and PyDy against C by hand."""

import time

import numpy as np
import peers
import scenes
from floors import stepper
from timing import best_of, imported, row

from hapticlab.compiler.engines.engine import load

FLOOR, OURS = "C by hand, -O3", "hapticlab llvm"
NUMBA = {"8-link pendulum": "numba (lambdify with cse, np.linalg.solve)", "coupler": "numba (its rates by hand)"}
PYDY = "PyDy (cython, RK4 in Python)"


def rows(rounds):
    """Measure the coupler and the pendulum; the ratio is to the C by hand in the same run."""
    return _coupler(rounds) + _pendulum(rounds)


def _ours(scene, values, inputs):
    """Return calls of the engines by name, how many ticks each runs, what compiles, and the forces of the C by hand."""
    program, single = scenes.compiled(scene), scenes.compiled(scene, "float32")
    values = [values[c.name] for c in program.parameters]
    by_hand, force = stepper(scene.name, inputs, values, scenes.T)
    calls = {FLOOR: by_hand}
    for name, engine, of in (
        (OURS, "llvm", program), ("hapticlab llvm, float32", "llvm", single), ("hapticlab vm, float32", "vm", single),
    ):  # fmt: skip
        loaded = imported(lambda engine=engine, of=of: load(of, engine))
        calls[name] = loaded and (lambda loaded=loaded: loaded.run(len(inputs), inputs, values).outputs)
    by_hand()
    np.testing.assert_allclose(calls[OURS]()[:, 0, 0], force, rtol=0, atol=1e-12 * np.abs(force).max())
    interpreter, short = load(program, "interpreter"), max(2, 20_000 // len(program))
    calls["hapticlab interpreter"] = lambda: interpreter.run(short, inputs[:short], values)
    ticks = {name: short if "interpreter" in name else len(inputs) for name in calls}
    return calls, ticks, lambda: load(program, "llvm").run(1, inputs[:1], values), force


def _peer(make, inputs, values, force):
    """Return a call of a peer that gives the forces of the C by hand, and the CPU seconds it took to make and to check."""
    start = time.process_time()
    run, found, values = imported(make), np.empty(len(inputs)), np.array(list(values), float)
    if run is None:
        return None, None
    run(inputs, values, found)
    np.testing.assert_allclose(found, force[: len(inputs)], rtol=0, atol=1e-11 * np.abs(force).max())
    return lambda: run(inputs, values, found), time.process_time() - start


def _table(scene, calls, ticks, compiling, numba_makes, rounds):
    seconds = best_of(rounds, **calls)
    a_tick = {name: s and s / ticks[name] for name, s in seconds.items()}
    return [
        row(f"{scene}: program to machine code", best_of(min(rounds, 3), llvm=compiling)["llvm"], "ms"),
        row(f"{scene}: numba, from its source or SymPy to a first run", numba_makes, "ms"),
        *(
            row(f"{scene}: {name}", s, "ns", against=a_tick[FLOOR], target=["<= 1.3 x"] if name == OURS else [])
            for name, s in a_tick.items()
        ),
    ]


def _coupler(rounds):
    inputs, name = scenes.handle(20_000), NUMBA["coupler"]
    calls, ticks, compiling, force = _ours(scenes.coupler(), scenes.COUPLER, inputs)
    make = lambda: peers.numba_steps(peers.coupler_rates, peers.coupler_force, 2, scenes.T)  # noqa: E731
    calls[name], makes = _peer(make, inputs, scenes.COUPLER.values(), force)
    return _table("coupler", calls, {**ticks, name: len(inputs)}, compiling, makes, rounds)


def _pendulum(rounds):
    inputs, name, scene = np.ascontiguousarray(scenes.handle(2000)[:, :1]), NUMBA["8-link pendulum"], scenes.pendulum()
    calls, ticks, compiling, force = _ours(scene, scenes.PENDULUM, inputs)
    rates = lambda: peers.pendulum_rates(scene, scenes.PENDULUM)  # noqa: E731
    make = lambda: peers.numba_steps(rates(), peers.pendulum_force, 16, scenes.T)  # noqa: E731
    calls[name], makes = _peer(make, inputs, scenes.PENDULUM.values(), force)
    short = inputs[:100]  # PyDy's steps are Python's
    make = lambda: peers.pydy_steps(scene, scenes.PENDULUM, scenes.T)  # noqa: E731
    calls[PYDY], _ = _peer(make, short, scenes.PENDULUM.values(), force)
    ticks |= {name: len(inputs), PYDY: len(short)}
    return _table("8-link pendulum", calls, ticks, compiling, makes, rounds)
