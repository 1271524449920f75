"""Draw every kind of figure of the package into a folder: `python tests/benchmarks/figures.py FOLDER [NAME ...]`.

Beside each PNG stands a text with its alternative text. Look at them after a change in a drawing.
"""

import sys
import time
from pathlib import Path

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab.base.figure_words import describe
from hapticlab.cli.demo import draw, study
from hapticlab.compiler.boards.cost import cost
from hapticlab.experiments.reaching import reach
from hapticlab.experiments.shared_control import assistance

PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("grip"))
REAL = hl.SimulatedPaddle(m=0.05, b=0.4, T=1e-3, coulomb=0.02, counts_per_metre=5e4, force_max=6.0)
LIGHT = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))


def thrown(k=500, **more):
    """Return a record of a handle thrown against a wall."""
    return PADDLE.run(hl.wall()(k=k, x_o=2e-3), duration=0.4, v=0.3, progress=False, **more)


def coupled():
    """Return a scene of a mass on a spring."""
    k, m = hl.parameters("k m", units="N/m kg", values=(500, 0.05))
    z = hl.coordinate("z", unit="m")
    F = k * (hl.x(hl.t) - z)
    return hl.Scene(name="mass on a spring", force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)], watch=[z])


def chain(count):
    """Return masses of 20 g in a row behind the handle."""
    masses = [hl.coordinate(f"z{i}", unit="m") for i in range(1, count + 1)]
    K, M = hl.parameters("k m", units="N/m kg", values=(2000, 0.02))
    pulls = [K * (before - after) for before, after in zip([hl.x(hl.t), *masses], masses, strict=False)]
    eom = [sp.Eq(M * z.diff(hl.t, 2), pull - after) for z, pull, after in zip(masses, pulls, [*pulls[1:], 0], strict=True)]
    return hl.Scene(name=f"chain of {count}", force=pulls[0], eom=eom)


def demonstration():
    return draw(study(quick=True, progress=False))


def books():
    scene = coupled()
    z, k, m = hl.coordinate("z", unit="m"), *hl.parameters("k m", units="N/m kg", values=(500, 0.05))
    stored = m * z.diff(hl.t) ** 2 / 2 + k * (hl.x(hl.t) - z) ** 2 / 2
    kept = hl.records.energy_books(scene, stored=stored)
    return hl.records.balance(PADDLE.run(kept, duration=0.4, v=0.2, progress=False))


def replayed():
    y, r = hl.coordinate("y", unit="m"), hl.parameters("r", units="1/s", values=5.0)
    shown = hl.Scene(force=0, eom=[sp.Eq(y.diff(hl.t), r * (hl.x(hl.t) - y))], watch=[y])
    return hl.records.replay(shown, thrown(), every=10).plot()


def velocities():
    hand = hl.Hand(k=400, b=3, intent=lambda t: 0.01 * np.sin(6 * t))
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=5e4, hand=hand)
    log = paddle.run(hl.wall()(k=0), duration=1.0, progress=False)
    return hl.velocity.compare(log, [hl.velocity.filtered(tau="4 ms"), hl.velocity.window(deviation="20 um")]).plot()


def chosen():
    asked = hl.people.ConstantLevels([0.1, 0.2, 0.5], repeats=6)
    bare = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    return hl.people.forced_choice(bare, hl.people.stiffness_task(), hl.people.SimulatedObserver(weber=0.2), asked).plot()


def traded(scene=None, *targets, **more):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3)
    tried = hl.methods.Tried(T=[5e-4, 1e-3, 2e-3])
    found = hl.methods.tradeoff(scene or coupled(), paddle, tried=tried, targets=["uno", "pc"], workers=1)
    return found.plot(*targets, **more)


def law(name="zoh", K=150.0, T=1e-3):
    return hl.laws.LinearLaw.of(name, K=K, T=T)


FIGURES = {
    "plot of a record": lambda: hl.plot(thrown()),
    "plot of three quantities": lambda: hl.plot(thrown(), "x", "v", "F"),
    "plot over position": lambda: hl.plot(thrown(), over="x"),
    "plot of curves": lambda: hl.plot(
        {"plain wall": ([20, 50, 100], [0.1, 0.2, 0.4], "both"), "with a brake": ([20, 50, 100], [0.1, 0.1, 0.12])},
        xlabel="stiffness [N/m]", ylabel="damping [N s/m]", log="x", at_y={"the paddle has 0.15": 0.15}),
    "chatter": lambda: hl.chatter(LIGHT.run(hl.wall()(k=800, x_o=1e-3), duration=1.0, progress=False)).plot(),
    "energy": lambda: hl.energy(thrown(800)).plot(),
    "staircase": lambda: hl.records.staircase(PADDLE.run(hl.wall()(k=500), duration=0.05, x=-0.25e-3, v=0.1)).plot(),
    "balance": lambda: books().plot(),
    "storage": lambda: hl.records.storage(
        PADDLE.run(hl.wall()(k=200), duration=0.1, x=-0.002, v=0.2), hl.laws.wall_energy()).plot(),
    "passivity trace": lambda: hl.passivity.trace(
        PADDLE.run(hl.laws.passivity_observer(hl.wall()(k=500)), duration=0.05, x=-0.002, v=0.2, progress=False)).plot(),
    "replay": replayed,
    "limit": lambda: hl.passivity_limit(hl.Device(b=0.1, T=1e-3)).plot(),
    "limit of nothing": lambda: hl.passivity_limit(hl.Device(b=0.1, T=1e-3), B=1.0).plot(),
    "stability limit": lambda: hl.stability_limit(PADDLE).plot(),
    "margin": lambda: hl.passivity.margin(hl.Device(b=0.06), law("backward_difference", 100.0)).plot(),
    "ledger": lambda: hl.passivity.ledger(hl.Device(b=0.2, T="1 ms"), K=200, B=0.05).plot(),
    "nyquist disk": lambda: hl.passivity.nyquist_disk(hl.Device(b=0.1), law()).plot(),
    "nyquist disk, not passive": lambda: hl.passivity.nyquist_disk(hl.Device(b=0.1), law("ellis", 300.0)).plot(),
    "nyquist disk, off the picture": lambda: hl.passivity.nyquist_disk(hl.Device(b=0.1), law("zoh", 2000.0)).plot(),
    "two port": lambda: hl.design.coupler(REAL, b_c=0.05).two_port.plot(),
    "coupler": lambda: hl.design.coupler(REAL, b_c=0.05).plot(),
    "admittance": lambda: hl.design.admittance(hl.SimulatedPaddle(m=0.05, b=5.0, T=1e-3), servo=2.0).plot(),
    "bounds": lambda: hl.bounds.table(REAL).plot(),
    "diolaiti": lambda: hl.bounds.diolaiti_plane(
        hl.Device(m=0.05, b=0.1, T="1 ms", coulomb=0.05, counts_per_metre=5000), K=300).plot(),
    "linear law": lambda: law("backward_difference", 300.0).plot(),
    "root locus": lambda: hl.stability.root_locus(PADDLE).plot(),
    "root locus, backward difference": lambda: hl.stability.root_locus(PADDLE, law="backward_difference").plot(),
    "wall map": lambda: hl.stability.wall_map(LIGHT, points=16).plot(),
    "wall map over delay": lambda: hl.stability.wall_map(LIGHT, points=16, over=("K", "delay")).plot(),
    "wall map with friction": lambda: hl.stability.wall_map(REAL, points=16).plot(),
    "step limit": lambda: hl.stability.step_limit(coupled(), "rk4", T=1e-3).plot(),
    "port passivity": lambda: hl.passivity.port(hl.SimulatedPaddle(m=0.05, b=0.15, T=1e-3), hl.wall()(k=400, x_o="10 mm")).plot(),
    "worst motion": lambda: hl.passivity.worst_motion(hl.Device(b=0.2, T="1 ms"), hl.wall()(k=500), samples=4).plot(),
    "sweep over one axis": lambda: hl.sweep(hl.wall(), LIGHT, metric="chatter", k=np.geomspace(50, 5000, 12)).plot(
        limits=hl.passivity_limit(LIGHT)),
    "sweep over two axes": lambda: hl.sweep(
        hl.wall(), LIGHT, metric="energy", v=0.1, k=np.geomspace(50, 1000, 12), T=np.linspace(5e-4, 2e-3, 8)).plot(),
    "compare laws": lambda: hl.design.compare_laws(REAL, K=500, entries=6).plot(),
    "law limits": lambda: hl.design.law_limits(REAL, laws=["zoh", "half_sample", "ellis"]).plot(),
    "compensation": lambda: hl.design.compensation(
        hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, coulomb=0.02, delay=0.5e-3)).plot(),
    "over compensation": lambda: hl.design.over_compensation(REAL, speed="2 mm/s").plot(),
    "hybrid wall": lambda: hl.laws.hybrid_wall(
        hl.SimulatedPaddle(m=0.05, b=0, T=1e-3), K=500, duration=0.1, x=-0.01, v=0.5).plot(),
    "velocities": velocities,
    "methods": lambda: hl.methods.table().plot("rk4", "semi_implicit_euler_damped"),
    "tradeoff": traded,
    "tradeoff of a wall": lambda: traded(hl.wall()(k=300, x_o=5e-3), "uno"),
    "tradeoff of detents": lambda: traded(hl.library.detents(), "uno", passive=False),
    "handle motions": lambda: hl.methods.handle_motions()[2].plot(),
    "reference": lambda: hl.methods.reference(coupled(), hl.methods.handle_motions()[1]).plot(hl.compile(coupled(), T=1e-3)),
    "cost": lambda: cost(hl.compile(coupled(), T=2e-3)).plot(),
    "reduction": lambda: hl.mechanics.reduction(chain(8), REAL, band=(0.1, 10)).plot(),
    "largest stiffness": lambda: hl.measure.largest_stiffness(REAL).plot(),
    "z-width": lambda: hl.measure.z_width(REAL, B=[0.0, 0.5, 1.0], search=hl.measure.Search(tolerance=0.1)).plot(),
    "displays": lambda: hl.people.compare_displays(PADDLE, [150, 300, 600]).plot(),
    "psychometric": lambda: hl.people.psychometric([0.05, 0.1, 0.2, 0.4], [22, 27, 32, 39], [40] * 4).plot(),
    "reach": lambda: reach(PADDLE, hl.wall()(k=0, x_o=1), end=0.02).plot(),
    "juggling": lambda: hl.people.juggle(PADDLE, duration=2.0).plot(),
    "forced choice": chosen,
    "fitts": lambda: hl.people.fitts(PADDLE, distances=[0.03, 0.02], widths=[0.005, 0.01], movements=6).plot(),
    "assistance": lambda: assistance(
        hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, hand=hl.Hand("pinch")), [hl.laws.tremor_filter()(B=10)],
        hl.people.MinimumJerk(end=0.02, duration=1.0, begin=1.0)).plot(),
    "demo": demonstration,
    "picture of a scene": lambda: hl.mechanics.picture(hl.library.mass_spring_damper()),
    "picture of an own scene": lambda: hl.mechanics.picture(coupled()),
}  # fmt: skip


def main(folder, *names):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name in names or FIGURES:
        begin = time.perf_counter()
        try:
            figure = FIGURES[name]()
        except Exception as problem:  # the others are drawn all the same
            print(f"{name}: {type(problem).__name__}: {problem}")
            continue
        picture = getattr(figure, "figure", figure)
        path = folder / f"{name.replace(', ', ' ').replace(' ', '_')}.png"
        path.write_bytes(picture._repr_png_())
        path.with_suffix(".txt").write_text(getattr(picture, "alt", None) or describe(picture), "utf-8")
        print(f"{name}: {time.perf_counter() - begin:.1f} s")


if __name__ == "__main__":
    main(*sys.argv[1:])
