"""One tick with one RK4 step, in a loop of many ticks: hapticlab's engines and numba against C by hand."""

import numpy as np
import peers
import scenes
from floors import stepper
from timing import best_of, imported, row

from hapticlab.compiler.engine import load


def rows(rounds):
    """Measure the coupler and the pendulum; the ratio is to the C by hand in the same run."""
    return _coupler(rounds) + _pendulum(rounds)


def _ours(scene, values, inputs):
    """Return calls of the engines by name, after checking the machine code against the C by hand."""
    program, single = scenes.compiled(scene), scenes.compiled(scene, "float32")
    values = [values[c.name] for c in program.parameters]
    by_hand, force = stepper(scene.name, inputs, values, scenes.T)
    calls = {"C by hand, -O3": by_hand}
    for name, engine, of in (
        ("hapticlab llvm", "llvm", program), ("hapticlab llvm, float32", "llvm", single),
        ("hapticlab vm, float32", "vm", single),
    ):  # fmt: skip
        loaded = imported(lambda engine=engine, of=of: load(of, engine))
        calls[name] = loaded and (lambda loaded=loaded: loaded.run(len(inputs), inputs, values).outputs)
    by_hand()
    np.testing.assert_allclose(calls["hapticlab llvm"]()[:, 0, 0], force, rtol=0, atol=1e-12 * np.abs(force).max())
    interpreter, short = load(program, "interpreter"), max(2, 20_000 // len(program))
    calls["hapticlab interpreter"] = lambda: interpreter.run(short, inputs[:short], values)
    return calls, short, lambda: load(program, "llvm").run(1, inputs[:1], values)


def _table(scene, calls, ticks, short, compiling, rounds):
    seconds = best_of(rounds, **calls)
    a_tick = {name: s and s / (short if "interpreter" in name else ticks) for name, s in seconds.items()}
    floor = a_tick["C by hand, -O3"]
    compiled = row(f"{scene}: program to machine code", best_of(min(rounds, 3), llvm=compiling)["llvm"], "ms")
    return [compiled, *(row(f"{scene}: {name}", a_tick[name], "ns", against=floor) for name in calls)]


def _coupler(rounds):
    inputs = scenes.handle(20_000)
    calls, short, compiling = _ours(scenes.coupler(), scenes.COUPLER, inputs)
    run, force = imported(lambda: peers.numba_steps(peers.coupler_rates, 2, scenes.T)), np.empty(20_000)
    values = np.array(list(scenes.COUPLER.values()))
    calls["numba"] = run and (lambda: run(inputs, values, force))
    if run:
        run(inputs, values, force)
    return _table("coupler", calls, 20_000, short, compiling, rounds)


def _pendulum(rounds):
    inputs = scenes.handle(2000)[:, :1]
    calls, short, compiling = _ours(scenes.pendulum(), scenes.PENDULUM, np.ascontiguousarray(inputs))
    return _table("8-link pendulum", calls, 2000, short, compiling, rounds)
