"""The engine wasm in node (V8, as in Chromium) and in wasmtime: ``python tests/benchmarks/wasm_engine.py [--quick]``.

Scenes are linked with a simulated paddle. From a program: CPU time of writing the module, then until its first tick has run. A
tick: the best of several rounds, taking turns, one lane, and a lane of 64. In brackets the ratio to llvm in the same run. The
results are compared bit for bit. Prints markdown.
"""

import argparse
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1]), str(HERE.parent / "compiler")]

import numpy as np  # noqa: E402
from in_node import case, in_node  # noqa: E402
from timing import best_of  # noqa: E402

import hapticlab as hl  # noqa: E402
from hapticlab.compiler.engines.llvm import Llvm  # noqa: E402
from hapticlab.compiler.engines.wasm import Wasm  # noqa: E402
from hapticlab.compiler.engines.wasm_emit import emit  # noqa: E402
from hapticlab.device.simulated.closed_loop import link  # noqa: E402

LANES = 64
ROUNDS = 9


def scenes():
    """Yield what is measured: its name, the linked program and values of its parameters."""
    plain = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))
    rubbing = hl.SimulatedPaddle.from_profile("hapkit", coulomb=0.03, hand=hl.Hand("pinch", push=1.0))
    library, taylor = hl.library, {"method": "taylor", "dtype": "float64"}
    for name, paddle, scene, options in (
        ("wall", plain, hl.wall()(k=150, x_o=0.01), {}),
        ("wall, hapkit with friction and a hand", rubbing, hl.wall()(k=150, x_o=0.01), {}),
        ("two masses", plain, library.two_masses(), {}), ("cart-pole", plain, library.cart_pole(), {}),
        ("slider-crank", plain, library.slider_crank(), {}), ("four-bar", plain, library.four_bar(), {}),
        ("ball on the paddle", plain, library.ball_on_the_paddle(), {}),
        ("ball on the paddle, taylor", plain, library.ball_on_the_paddle(), taylor),
    ):  # fmt: skip
        program = paddle.program(scene, **options)
        yield name, link(program, paddle), (*program.values, *paddle.plant_values(0.0, 0.0))


def seconds(make):
    """Return what is made, and the CPU time it took [s]."""
    begun = time.process_time()
    made = make()
    return made, time.process_time() - begun


def measured(program, values, quick):
    """Return for a program the numbers of its row."""
    ticks = (200_000 if quick else 2_000_000) // len(program)
    inputs, parameters = np.zeros((ticks, len(program.inputs))), np.array(values)[:, None]
    many = np.repeat(parameters, LANES, 1)
    few = max(1, ticks // LANES)
    code, writing = seconds(lambda: emit(program))
    writing = min(writing, *(seconds(lambda: emit(program))[1] for _ in range(2)))
    wasm = Wasm(program)
    _, loading = seconds(lambda: wasm.run(1, inputs[:1], parameters))
    llvm = Llvm(program)
    calls = {
        f"{name} {lanes}": lambda e=engine, n=n, p=p: e.run(n, inputs[:n], p, None, n)
        for name, engine in (("wasmtime", wasm), ("llvm", llvm))
        for lanes, n, p in ((1, ticks, parameters), (LANES, few, many))
    }
    expected = {lanes: calls[f"llvm {lanes}"]()[0] for lanes in (1, LANES)}
    found = best_of(ROUNDS, **calls)
    asked = [case(program, n, inputs[:n], p, every=n, rounds=ROUNDS) for n, p in ((ticks, parameters), (few, many))]
    answers = in_node(asked)
    for lanes, (outputs, _, said) in zip((1, LANES), answers, strict=True):
        for other in (outputs, calls[f"wasmtime {lanes}"]()[0]):
            assert other.tobytes() == expected[lanes].tobytes()
        found[f"node {lanes}"] = said["best"] / 1e3
    a_tick = {name: s / (ticks if name.endswith(" 1") else few * LANES) * 1e9 for name, s in found.items()}
    return len(code), writing * 1e3, answers[0][2]["ready"], (loading - writing) * 1e3, a_tick


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--quick", action="store_true", help="a tenth of the ticks")
    quick = options.parse_args().quick
    heads = "program | instructions | bytes | written [ms] | first tick in node, wasmtime [ms] | llvm [ns] | node | wasmtime"
    print(f"| {heads} | {LANES} lanes: llvm [ns] | node | wasmtime |\n" + "| --- " * 11 + "|")
    for name, program, values in scenes():
        size, writing, ready, loading, a_tick = measured(program, values, quick)
        cells = [name, len(program), size, f"{writing:.1f}", f"{ready:.1f}, {loading:.0f}"]
        for lanes in (1, LANES):
            base, *others = (a_tick[f"{engine} {lanes}"] for engine in ("llvm", "node", "wasmtime"))
            cells += [f"{base:.3g}", *(f"{other:.3g} ({other / base:.2f})" for other in others)]
        print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main()
