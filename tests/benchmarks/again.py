"""What a scene costs the first time and every other time: compiled, run, swept and checked."""

import numpy as np
import scenes
from timing import best_of, row

import hapticlab as hl
from hapticlab.analysis.sweeps.sweep_measures import METRICS, WithFault
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.ir import cache
from hapticlab.course.felt import felt
from hapticlab.device.simulated.closed_loop import link

SCENES = {
    "8-link pendulum": (scenes.pendulum, scenes.PENDULUM),
    "mass on a coupler": (scenes.coupler, scenes.COUPLER),
    "wall": (scenes.wall, {"k": 300.0, "x_o": 0.01}),
}
#: what is swept of each scene, 10 000 values around its own; and for how many samples
SWEPT, POINTS, TICKS = {"mass on a coupler": "k_w", "wall": "k"}, 10_000, 1000
SAMPLES = np.linspace(0, 0.02, 50)


def rows(rounds):
    """Measure every scene; where a line is divided by another one, that stands in its name."""
    return [line for name, (make, values) in SCENES.items() for line in _scene(name, make()(**values), rounds)]


def _scene(name, scene, rounds):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=scenes.T)

    def compiled():
        return paddle.program(scene)

    def run():
        return paddle.run(scene, duration=0.1, progress=False)

    def check():
        return felt(scene, x=SAMPLES)

    def first(call, ready=lambda: None):
        """Return the CPU seconds of a call for the first time, after what was ``ready``."""
        best = None
        for _ in range(min(rounds, 3)):
            cache.clear()
            ready()
            spent = best_of(1, call=call)["call"]
            best = spent if best is None else min(best, spent)
        return best

    once = {"compile": first(compiled), "run after compile": first(run, compiled), "check": first(check)}
    again = {}
    for what, call in {"compile": compiled, "run after compile": run, "check": check}.items():
        call()
        again[what] = best_of(5 * rounds, call=call)["call"]
    lines = []
    for what, seconds in once.items():
        lines.append(row(f"{name}: {what}, the first time", seconds, "ms"))
        lines.append(row(f"{name}: {what}, again; to the first time", again[what], "ms", against=seconds))
    return lines + (_sweep(name, scene, paddle, SWEPT[name], first, rounds) if name in SWEPT else [])


def _sweep(name, scene, paddle, swept, first, rounds):
    values = np.geomspace(0.1, 10, POINTS) * scene.values[swept]
    measure = METRICS["peak_force"](TICKS, scenes.T)
    program = link(paddle.program(scene), paddle, WithFault(measure))
    given = {swept: values, "start.v": 0.1}
    named = zip(program.parameters, program.values, strict=True)
    points = np.array([np.broadcast_to(given.get(c.name, a), POINTS) for c, a in named])
    loaded, inputs = load(program), paddle.inputs(TICKS)

    def run():
        return loaded.run(TICKS, inputs, points, every=TICKS)

    def sweep():
        return hl.sweep(scene, paddle, metric="peak_force", v=0.1, progress=False, **{swept: values})

    np.testing.assert_array_equal(sweep().values, run().outputs[0, 0])
    seconds = best_of(5 * rounds, run=run, again=sweep)
    cold = first(sweep)
    return [
        row(f"{name}: 10 000 points, the run alone", seconds["run"], "ms"),
        row(f"{name}: 10 000 points, hl.sweep again; to the run", seconds["again"], "ms", against=seconds["run"]),
        row(
            f"{name}: 10 000 points, hl.sweep with compiling; to the run",
            cold,
            "ms",
            against=seconds["run"],
            target=["<= 2.5 x"],
        ),
    ]
