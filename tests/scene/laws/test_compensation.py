"""Damping compensation against its formula, and against the coasting handle it is for."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import ParameterError, SceneError

T, M, DAMPING, COULOMB, WIDTH = 1e-3, 0.05, 0.1, 0.05, 0.004
SPEEDS = np.concatenate([np.linspace(-0.02, 0.02, 41), [0.004, -0.004, 0.5]])


@pytest.mark.parametrize("sign", ["smooth", "dead_zone"])
def test_the_force_is_its_formula(sign):
    scene = hl.laws.damping_compensation(b=DAMPING, coulomb=COULOMB, speed=WIDTH, sign=sign)(viscous=0.9, dry=0.7)
    program = hl.compile(scene, T=T, dtype="float64", velocity="measured")
    assert [c.name for c in program.inputs] == ["x", "v"]
    found = load(program).run(len(SPEEDS), np.column_stack([0 * SPEEDS, SPEEDS])).outputs[:, 0, 0]
    sign = SPEEDS / np.hypot(SPEEDS, WIDTH) if sign == "smooth" else np.sign(SPEEDS) * (abs(SPEEDS) > WIDTH)
    np.testing.assert_allclose(found, -0.9 * DAMPING * SPEEDS - 0.7 * COULOMB * sign, rtol=1e-12, atol=1e-16)


@pytest.mark.parametrize("part", [0.0, 0.5, 1.0, 1.2])
def test_a_handle_coasts_as_if_its_damper_were_smaller(part):
    """v[n+1] = (a + (1 - a) part) v[n], a = exp(-bT/m): at part = 1 the speed stays, to the last bits."""
    log = hl.SimulatedPaddle(m=M, b=DAMPING, T=T).run(
        hl.laws.damping_compensation(b=DAMPING)(viscous=part), duration=0.4, v=0.1, dtype="float64"
    )
    a = np.exp(-DAMPING * T / M)
    np.testing.assert_allclose(log.v, 0.1 * (a + (1 - a) * part) ** np.arange(400), rtol=1e-12)


def test_dry_friction_that_is_compensated_lets_the_handle_coast_on():
    """With viscous = 1 the handle slows by (1 - dry) coulomb (1 - a)/b a period alone, a = exp(-bT/m)."""
    paddle = hl.SimulatedPaddle(m=M, b=DAMPING, T=T, coulomb=COULOMB)
    scene = hl.laws.damping_compensation(b=DAMPING, coulomb=COULOMB, speed=WIDTH, sign="dead_zone")(viscous=1, dry=0.8)
    log = paddle.run(scene, duration=0.2, v=0.1, dtype="float64")
    np.testing.assert_allclose(log.v, 0.1 - 0.2 * COULOMB / DAMPING * -np.expm1(-DAMPING * T / M) * np.arange(200), rtol=1e-11)


def test_a_resting_handle_is_left_at_rest():
    """The dead zone is wider than a count per period: an encoder at rest, or one that flickers, is no motion."""
    paddle = hl.SimulatedPaddle(m=M, b=DAMPING, T=T, coulomb=COULOMB, counts_per_metre=1e6, noise=5e-7)
    scene = hl.laws.damping_compensation(b=DAMPING, coulomb=COULOMB, speed=WIDTH, sign="dead_zone")(viscous=0, dry=0.9)
    assert not paddle.run(scene, duration=0.3).F.any()


def test_it_is_felt_beside_a_wall():
    wall = hl.wall("ellis")(k=40, x_o=0.01, B=0.02)
    scene = hl.laws.damping_compensation(wall, b=DAMPING)(viscous=0.6)
    path = np.cumsum(np.random.default_rng(2).normal(0, 2e-4, 200))[:, None] + 0.01
    alone, both = (load(hl.compile(s, T=T, dtype="float64")).run(200, path).outputs[:, 0, 0] for s in (wall, scene))
    moved = np.diff(path[:, 0], prepend=path[0, 0])
    np.testing.assert_allclose(both - alone, -0.6 * DAMPING * moved / T, rtol=1e-9, atol=1e-12)
    assert scene.name == "ellis wall with damping compensation"


def test_it_takes_a_chosen_velocity_once():
    estimate = hl.velocity.filtered(tau="4 ms")
    wall = hl.wall(velocity=estimate)(k=40, B=0.1)
    assert hl.laws.damping_compensation(wall, b=DAMPING, velocity=estimate).eom == wall.eom


@pytest.mark.parametrize(("sign", "least"), [("smooth", 0.87e-3), ("dead_zone", 0.8e-3)])
def test_it_runs_in_the_firmware_core_and_fits_the_uno(sign, least):
    """The smooth sign is a square root and a division dearer, some 0.1 ms; beside a wall and a filter both fit 1 kHz."""
    scene = hl.laws.damping_compensation(
        hl.wall("backward_difference"), b=DAMPING, coulomb=COULOMB, speed=WIDTH, sign=sign,
        velocity=hl.velocity.filtered(tau="2 ms"),
    )(viscous=0.9, dry=0.8, k=100, x_o=0.01)  # fmt: skip
    program = hl.compile(scene, T=T)
    path = (0.01 + 0.003 * np.sin(0.05 * np.arange(300))).astype(np.float32)[:, None]
    there, here = (load(program, engine).run(300, path).outputs for engine in ("vm", "interpreter"))
    np.testing.assert_array_equal(there, here)
    assert cost(program).fits
    assert least < cost(program).T_needed() <= T


@pytest.mark.parametrize(
    ("make", "error", "words"),
    [
        (lambda: hl.laws.damping_compensation(b=-1), SceneError, "b = -1 N\\*s/m; friction needs b >= 0"),
        (lambda: hl.laws.damping_compensation(b=1, coulomb=1), SceneError, "coulomb without speed"),
        (
            lambda: hl.laws.damping_compensation(b=1, coulomb=1, speed=0),
            SceneError,
            "speed = 0 m/s; friction needs speed > 0",
        ),
        (lambda: hl.laws.damping_compensation(b=1, sign="odd"), SceneError, "needs one of smooth, dead_zone"),
        (lambda: hl.laws.damping_compensation(b=1, velocity=3), SceneError, "needs an estimate"),
        (lambda: hl.laws.damping_compensation(b=1)(viscous=-0.5), ParameterError, "viscous = -0.5"),
    ],
)
def test_what_is_no_compensation_is_refused(make, error, words):
    with pytest.raises(error, match=words):
        make()
