"""Declared ranges of coordinates: what leaves one is a fault that names it, and a start outside is refused."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import SceneError

T = 1e-3
m, k, l, at = hl.parameters("m k l at", units="kg N/m m m", values=(0.05, 200, 0.1, 0.0))


def mass_on_a_spring(name="q", initial=0, **declared):
    q = hl.coordinate(name, unit="m", initial=initial, **declared)
    pull = k * (x(t) - q)
    return q, pull, sp.Eq(m * q.diff(t, 2), pull)


def forces(scene, displacement, **options):
    program = hl.compile(scene, T=T, dtype="float64", velocity="measured", **options)
    inputs = np.zeros((400, len(program.inputs)))
    inputs[:, 0] = displacement
    run = load(program).run(400, inputs)
    return program, dict(zip([c.name for c in program.outputs], run.outputs[:, :, 0].T, strict=True))


@pytest.mark.parametrize("method", ["rk4", "taylor", "exact"])
def test_the_force_is_no_number_beyond_a_declared_range(method):
    q, pull, motion = mass_on_a_spring(range=(-0.01, 0.01))
    scene = hl.Scene(force=pull, eom=[motion], watch={"q": q})
    options = {"live": ""} if method == "exact" else {}
    program, log = forces(scene, 0.0049, method=method, **options)  # swings to 9.8 mm
    assert np.isfinite(log["F"]).all() and log["q"].max() > 0.0097
    assert program.notes[-1] == "F is nan where q left -0.01..0.01 m"
    _, log = forces(scene, 0.006, method=method, **options)
    assert np.array_equal(np.isnan(log["F"]), abs(log["q"]) > 0.01 * (1 + 1e-6)) and np.isnan(log["F"]).any()
    free = hl.Scene(force=pull.subs(q, z := hl.coordinate("q", unit="m")), eom=[motion.subs(q, z)], watch={"q": z})
    assert len(program) <= len(hl.compile(free, T=T, dtype="float64", velocity="measured", method=method, **options)) + 5


def test_a_fault_says_which_range_was_left():
    _, pull, motion = mass_on_a_spring(range=(-0.01, 0.01))
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand(push=5))
    log = paddle.run(hl.Scene(force=pull, eom=[motion]), duration=0.3, progress=False)
    assert "the force F of scene was not finite" in log.fault and "q left -0.01..0.01 m" in log.fault


def test_what_a_program_leaves_out_is_not_watched_over():
    _, pull, motion = mass_on_a_spring()
    dead, _, shown = mass_on_a_spring("dead", range=(-0.01, 0.01))
    with_it, without = (hl.Scene(force=pull, eom=[motion, *more]) for more in ([shown], []))
    assert len(hl.compile(with_it, T=T)) == len(hl.compile(without, T=T))
    watched = hl.compile(hl.Scene(force=pull, eom=[motion, shown], watch=[dead]), T=T)
    assert watched.notes[0] == "F is nan where dead left -0.01..0.01 m"


def test_what_rests_at_the_end_of_its_range_stays_in_it():
    h = hl.coordinate("h", unit="m", initial=0.02, range=(0, 0.03))
    floor = hl.contact.Contact(h, hl.contact.impulse(e=0.5), name="floor")
    g = hl.parameters("g", units="m/s^2", values=9.81)
    scene = hl.Scene(force=0, eom=[hl.mechanics.lagrange(m * h.diff(t) ** 2 / 2 - m * g * h, contacts=[floor])], watch={"h": h})
    for dtype in ("float32", "float64"):
        program = hl.compile(scene, method="taylor", T=T, dtype=dtype)
        run = load(program).run(600, np.zeros((600, len(program.inputs))))
        assert np.isfinite(run.outputs).all() and abs(run.outputs[-1, 1, 0]) < 1e-7


@pytest.mark.parametrize("enforce", ["embed", "kkt"])
def test_a_coordinate_that_a_constraint_determines_keeps_to_its_range(enforce):
    """A bob at 0.1 m under its pivot, its place and height tied to an angle that the handle drives through a spring."""
    angle = hl.coordinate("angle", unit="rad")
    side = hl.coordinate("side", unit="m", range=(-0.05, 0.05))  # 30 degrees
    pull = k * (x(t) - l * angle)
    model = hl.mechanics.lagrange(m * side.diff(t) ** 2 / 2 + m * l**2 * angle.diff(t) ** 2 / 2, forces={angle: l * pull},
                        constraints=[sp.Eq(side, l * sp.sin(angle))], enforce=enforce)  # fmt: skip
    scene = hl.Scene(force=pull, eom=[model], watch={"angle": angle})
    _, log = forces(scene, 0.02)
    assert np.isfinite(log["F"]).all()
    _, log = forces(scene, 0.04)
    assert np.array_equal(np.isnan(log["F"]), abs(np.sin(log["angle"])) > 0.5 * (1 + 1e-6)) and np.isnan(log["F"]).any()


def test_a_start_outside_is_refused():
    _, pull, motion = mass_on_a_spring(initial=at, range=(-0.01, 0.01))
    scene = hl.Scene(force=pull, eom=[motion])
    hl.compile(scene(at="10 mm"), T=T)
    with pytest.raises(SceneError, match=r"q starts at 0.02 m, outside of its declared range -0.01..0.01 m; start it inside"):
        hl.compile(scene(at="20 mm"), T=T)
    _, pull, motion = mass_on_a_spring(initial=x(n), range=(0.01, 0.03))
    hl.compile(hl.Scene(force=pull, eom=[motion]), T=T)  # the handle may start there
