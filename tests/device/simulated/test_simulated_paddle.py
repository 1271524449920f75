"""The simulated paddle: validation, sensing, limits, faults, energy and reproducibility."""

import dataclasses
import re

import numpy as np
import pytest

from hapticlab.compiler.engines.table import ENGINES
from hapticlab.compiler.tick.compile_scene import compile
from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import PaddleError
from hapticlab.scene.notation.symbols import n, parameters, v, x
from hapticlab.scene.scene import Scene

PLAIN = {"m": 0.05, "b": 0.1, "T": 1e-3}
NAN = float("nan")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"m": 0}, r"m = 0 kg; a paddle needs m > 0"),
        ({"m": -1}, r"m = -1 kg"),
        ({"m": NAN}, r"m = nan kg; a paddle needs m > 0 and finite"),
        ({"b": -0.1}, r"b = -0.1 N s/m; a paddle needs b >= 0\. A negative damper supplies energy to the user."),
        ({"T": 0}, r"T = 0 s; a paddle needs T > 0"),
        ({"T": -1e-3}, r"T = -0.001 s"),
        ({"T": float("inf")}, r"T = inf s"),
        ({"delay": -1e-4}, r"delay = -0.0001 s; a paddle needs delay >= 0"),
        ({"delay": 5}, r"delay = 5 s is 5000 samples; a simulated paddle stores at most 1000 delayed forces:"),
        ({"counts_per_metre": 0}, r"counts_per_metre = 0 1/m; a paddle needs counts_per_metre > 0"),
        ({"counts_per_metre": NAN}, r"counts_per_metre = nan"),
        ({"rounding": "up"}, r"rounding = 'up'; an encoder needs 'floor' or 'nearest'"),
        ({"coulomb": -1}, r"coulomb = -1 N; a paddle needs coulomb >= 0"),
        ({"force_max": 0}, r"force_max = 0 N; a paddle needs force_max > 0"),
        ({"noise": -1}, r"noise = -1 m"),
        ({"hand": 2.0}, r"hand = 2.0; needs a Hand"),
        ({"seed": 0.5}, r"seed = 0.5; needs a whole number"),
    ],
)
def test_bad_values_are_refused(given, said):
    with pytest.raises(PaddleError, match=said):
        SimulatedPaddle(**{**PLAIN, **given})


def test_frozen_and_keyword_only():
    with pytest.raises(TypeError):
        SimulatedPaddle(0.05, 0.1, 1e-3)
    with pytest.raises(dataclasses.FrozenInstanceError):
        SimulatedPaddle(**PLAIN).m = 1


@pytest.mark.parametrize("rounding", ["floor", "nearest"])
def test_encoder_counts(spring, rounding):
    counts = 3e4
    paddle = SimulatedPaddle(**PLAIN, counts_per_metre=counts, rounding=rounding)
    log = paddle.run(spring(90.0, dtype="float32", velocity="backward_difference"), duration=0.3, v=0.05)
    shift = 0.0 if rounding == "floor" else 0.5
    seen = np.floor(log.x_true * counts + shift).astype(np.float32) * np.float32(1 / counts)
    assert log.x.min() < -1e-3 and log.x.max() > 1e-3
    assert np.array_equal(log.x, seen)
    error = log.x - log.x_true
    low, high = (-1, 0) if rounding == "floor" else (-0.5, 0.5)
    assert error.min() * counts >= low - 1e-3 and error.max() * counts <= high + 1e-3
    assert np.ptp(error) * counts > 0.9
    steps = np.diff(log.x.astype(np.float32)) * np.float32(1 / paddle.T)
    assert log.v[0] == 0 and np.array_equal(log.v[1:], steps)


def test_without_encoder_the_scene_sees_the_handle(spring):
    log = SimulatedPaddle(**PLAIN).run(spring(90.0), duration=0.1, x=0.01, v=0.1)
    assert (log.x[0], log.v[0]) == (0.01, 0.1)
    with pytest.raises(AttributeError, match="was not recorded"):
        _ = log.x_true


def test_force_limit_is_felt_and_flagged(spring):
    paddle = SimulatedPaddle(m=0.05, b=0.0, T=1e-3, force_max=1.5)
    log = paddle.run(spring(400.0), duration=0.06, x=0.01)
    assert np.array_equal(log.F, np.clip(400.0 * log.x, -1.5, 1.5)) and log.saturated.any() and not log.saturated.all()
    assert np.array_equal(log.saturated, np.abs(log.F) == 1.5)
    assert np.diff(log.v) == pytest.approx(-log.F[:-1] * 1e-3 / 0.05, rel=1e-12)


def test_noise_is_seeded(spring):
    def sensed(seed):
        paddle = SimulatedPaddle(**PLAIN, noise=2e-5, seed=seed)
        return paddle.run(spring(0.0, velocity="backward_difference"), duration=4).x

    assert np.array_equal(sensed(3), sensed(3)) and not np.array_equal(sensed(3), sensed(4))
    assert sensed(3).std() == pytest.approx(2e-5, rel=0.05)  # the handle stays at zero; 4000 samples: 1.1 % one sigma


def test_the_hands_noise_is_a_seeded_force_held_over_each_sample(spring):
    def run(seed, **noise):
        paddle = SimulatedPaddle(m=0.05, b=0.0, T=1e-3, seed=seed, hand=Hand(m=0.03, push_noise=0.2), **noise)
        return paddle.run(spring(0.0, velocity=paddle.velocity), duration=4)

    log = run(7)
    force = 0.08 * np.diff(log.v) / 1e-3  # a free mass: M dv/dt is the force of each period
    assert force.std() == pytest.approx(0.2, rel=0.05)  # 4000 samples: 1.1 % one sigma
    assert np.array_equal(log.v, run(7).v) and not np.array_equal(log.v, run(8).v)
    assert np.array_equal(log.v, run(7, noise=1e-5).v_true)  # the sensor's noise is a stream of its own


@pytest.mark.parametrize("delay", [0.0, 4e-4, 2e-3])
@pytest.mark.parametrize("bad", [NAN, float("inf")])
def test_a_force_that_is_no_number_switches_the_motor_off(breaks_at, delay, bad):
    paddle = SimulatedPaddle(m=0.05, b=0.0, T=1e-3, delay=delay)
    log = paddle.run(breaks_at(100, bad), duration=0.2)
    assert log.fault == "tick 100 (t = 0.1 s): the force F of breaks was not finite; the motor is off from then on"
    felt = getattr(log, "F_applied", log.F)
    assert not felt[100:].any() and felt[10:100].all()
    assert not log.F[100:].any()
    coasting = np.diff(log.v[101:])
    assert not coasting.any() and log.v[101] < -1 and np.isfinite(log.x).all()


def test_a_state_that_is_not_finite_switches_the_motor_off(breaks_at):
    log = SimulatedPaddle(m=0.05, b=0.0, T=1e-3).run(breaks_at(7, float("inf"), state=True), duration=0.02)
    assert log.fault.startswith("tick 7 (t = 0.007 s): the state count of breaks was not finite")
    assert log.F.tolist() == [1.0] * 7 + [0.0] * 13


def quadrature(a, beta, v, T):
    """Return v at the end and the integrals of v^2 and |v| of v' = a - beta v over T, before any change of sign."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    times = (nodes + 1) * T / 2
    speeds = v * np.exp(-beta * times) + a * -np.expm1(-beta * times) / beta
    end = v * np.exp(-beta * T) + a * -np.expm1(-beta * T) / beta
    return end, weights @ speeds**2 * T / 2, weights @ np.abs(speeds) * T / 2


def dissipation(m, b, c, F, v, T):
    """Return the energy lost to b and to Coulomb friction in one period, from closed forms and Gauss quadrature."""
    beta, lost = b / m, 0.0
    while T > 0 and (v != 0 or abs(F) > c):
        sign = np.sign(v) if v else -np.sign(F)
        a = (-F - c * sign) / m
        until = np.log1p(-beta * v / a) / beta if a * sign < 0 else np.inf
        length = min(T, until)
        end, squares, path = quadrature(a, beta, v, length)
        lost += b * squares + c * path
        v, T = (0.0 if until <= T else end), T - length
    return lost


@pytest.mark.parametrize("coulomb", [0.0, 0.02, 0.3])
def test_energy_balance(spring, coulomb):
    """Kinetic energy changes by the work of the motor less what damper and friction take, in every period."""
    m, b, T = 0.05, 0.4, 1e-3
    paddle = SimulatedPaddle(m=m, b=b, T=T, coulomb=coulomb)
    log = paddle.run(spring(120.0), duration=0.4, x=0.01, v=-0.3)
    kinetic = m * log.v**2 / 2
    work = -log.F[:-1] * np.diff(log.x)
    lost = [dissipation(m, b, coulomb, F, v, T) for F, v in zip(log.F[:-1], log.v[:-1], strict=True)]
    assert np.abs(np.diff(kinetic) - (work - lost)).max() < 1e-15 < 1e-12 * kinetic.max()
    reversals = (log.v[:-1] * log.v[1:] < 0).sum() + (log.v == 0).any()
    assert reversals >= 1


def test_chatter_boundary_is_not_shifted(spring):
    """The closed loop's eigenvalues, from the trajectory by its two-term recurrence, are those of the exact map."""
    m, b, T = 0.05, 0.1, 1e-3
    a, tau = np.exp(-b * T / m), m / b
    g0, g1 = (tau * (1 - a) - a * T) / b, (T - tau * (1 - a)) / b
    limit = (1 - a) / g0  # z^2 - (1 + a - g1 K) z + a + g0 K reaches modulus one
    for K in (0.999 * limit, 1.001 * limit):
        log = SimulatedPaddle(m=m, b=b, T=T).run(spring(K), duration=2, x=0.01)
        x = log.x
        rows = np.column_stack([x[1:-1], -x[:-2]])
        (trace, determinant), *_ = np.linalg.lstsq(rows, x[2:], rcond=None)
        assert trace == pytest.approx(1 + a - g1 * K, abs=1e-9)
        assert np.sqrt(determinant) == pytest.approx(np.sqrt(a + g0 * K), abs=1e-9)
        assert (determinant > 1) == (K > limit)


@pytest.mark.wide
@pytest.mark.parametrize("given", [{}, {"coulomb": 0.1, "delay": 1.4e-3, "noise": 1e-6}])
def test_chunks_do_not_change_the_run(spring, monkeypatch, given):
    paddle = SimulatedPaddle(**PLAIN, **given, hand=Hand(k=100, b=1, intent=lambda t: 0.01 * np.sin(9 * t)))
    program = spring(90.0, velocity=paddle.velocity)
    whole = paddle.run(program, duration=0.1, engine="interpreter", progress=False)
    monkeypatch.setitem(ENGINES, "interpreter", dataclasses.replace(ENGINES["interpreter"], chunk=7))
    pieces = paddle.run(program, duration=0.1, engine="interpreter")
    for name in whole.columns:
        assert np.array_equal(getattr(whole, name), getattr(pieces, name)), name


def test_a_short_run_shows_no_bar(spring, capfd):
    SimulatedPaddle(**PLAIN).run(spring(90.0), duration=0.6, engine="interpreter")
    assert capfd.readouterr() == ("", "")


def test_what_a_paddle_cannot_run_is_refused(spring):
    paddle = SimulatedPaddle(**PLAIN)
    with pytest.raises(PaddleError, match=r"spring was compiled for T = 0.002 s; this paddle samples every 0.001 s"):
        paddle.run(spring(1.0, T=2e-3), duration=1)
    with pytest.raises(PaddleError, match="method: a program is already compiled;"):
        paddle.run(spring(1.0), duration=1, method="rk4")
    with pytest.raises(PaddleError, match=r"x = nan m; a start needs a finite x"):
        paddle.run(spring(1.0), duration=1, x=NAN)


def test_a_measured_velocity_is_not_promised_by_an_encoder():
    B = parameters("B", units="N*s/m")
    damper = Scene(force=B * v(n), name="damper")(B=2)
    program = compile(damper, T=1e-3, velocity="measured")
    with pytest.raises(PaddleError, match="damper needs a measured v; this paddle has only its backward difference."):
        SimulatedPaddle(**PLAIN, counts_per_metre=1e4).run(program, duration=0.1)
    assert SimulatedPaddle(**PLAIN, counts_per_metre=1e4).run(damper, duration=0.1, v=1).F[1] > 1
    assert SimulatedPaddle(**PLAIN).run(program, duration=0.1, v=1).F[0] == 2


def test_what_belongs_to_the_paddle_or_to_no_run_is_refused(spring):
    paddle = SimulatedPaddle(**PLAIN)
    with pytest.raises(PaddleError, match="T is that of the paddle, 0.001 s."):
        paddle.run(Scene(force=parameters("k", units="N/m", values=1.0) * x(n)), duration=1, T=5e-4)
    with pytest.raises(PaddleError, match=r"is 1e\+11 samples; a run keeps at most 10000000 .*hl.sweep"):
        paddle.run(spring(1.0), duration=1e8)
    with pytest.raises(PaddleError, match="engine = 'vm'; a simulated paddle, float64 inside"):
        paddle.run(spring(1.0), duration=1, engine="vm")
    with pytest.raises(PaddleError, match=r"is 1e\+303 samples; a run"):
        paddle.run(spring(1.0), duration=1e300)
    with pytest.raises(PaddleError, match=r"duration = 1e\+308 s has too many samples"):
        paddle.run(spring(1.0), duration=1e308)


@pytest.mark.parametrize(
    ("given", "least"),
    [({"b": 0.0, "hand": Hand(k=1e13)}, 1e-11), ({"b": 0.1, "m": 5e-324}, 1e-303), ({"b": 0.1, "hand": Hand(k=1e13)}, None)],
)
def test_a_mass_that_no_number_can_move_is_refused(given, least):
    given = {"m": 1e-12, "T": 1e-3, **given}
    if least is None:
        assert SimulatedPaddle(**given)
        return
    with pytest.raises(PaddleError, match=r"m = .*needs m >= (\S+) kg") as refused:
        SimulatedPaddle(**given)
    said = float(re.search(r"m >= (\S+) kg", str(refused.value))[1])
    assert least <= said < 1.02 * least and SimulatedPaddle(**{**given, "m": said})


def test_a_hand_s_spring_moves_a_handle_without_mass():
    """x = push/k (1 - e^(-k t/b)): what is left of the motion without a mass."""
    paddle = SimulatedPaddle(m=1e-12, b=1e3, T=1e-3, hand=Hand(k=200.0, push=1.0))
    log = paddle.run(Scene(force=parameters("k", units="N/m", values=0.0) * x(n)), duration=2, progress=False)
    np.testing.assert_allclose(log.x[1:], -np.expm1(-0.2 * log.t[1:]) / 200, rtol=1e-7)  # recorded in single precision
