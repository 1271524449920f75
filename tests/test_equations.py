"""One test per equation of the chapter: what runs is what the equation says."""

import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import T, n, t, v, x
from hapticlab.compiler.engines.engine import load

k, x_o = hl.parameters("k x_o", units="N/m m")
PERIOD, K, BOUNDARY = 1e-3, 230.0, 0.012
#: a push into the wall and out again, between samples of any kind
MOTION = BOUNDARY + 0.004 * np.sin(0.37 * np.arange(60.0)) + 0.001 * np.cos(1.9 * np.arange(60.0))
VELOCITY = 1.48 * np.cos(0.37 * np.arange(60.0)) - 1.9 * np.sin(1.9 * np.arange(60.0))


def forces(scene, velocity="backward_difference"):
    program = hl.compile(scene(k=K), T=PERIOD, dtype="float64", velocity=velocity)
    inputs = np.column_stack([MOTION, VELOCITY][: len(program.inputs)])
    return load(program).run(len(MOTION), inputs).outputs[:, 0, 0]


def depth(lag=0):
    """Return x(n - lag) - x_o, the samples before the first being equal to it."""
    return MOTION[np.maximum(np.arange(len(MOTION)) - lag, 0)] - BOUNDARY


def inside(force):
    return np.where(depth() >= 0, force, 0.0)


def test_23_1_the_plain_wall():
    written = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)))(x_o=BOUNDARY)
    np.testing.assert_allclose(forces(written), inside(K * depth()), rtol=1e-14, atol=1e-16)
    np.testing.assert_array_equal(forces(written), forces(hl.wall()(x_o=BOUNDARY)))


def test_23_2_and_23_4_the_mean_of_now_and_the_predicted_sample():
    average = hl.Scene(force=k / 2 * (x(n) + hl.laws.predicted_sample()))
    np.testing.assert_allclose(forces(average), K / 2 * (depth() + 2 * depth() - depth(1) + 2 * BOUNDARY), rtol=1e-13)


def test_23_3_a_virtual_damper_of_half_a_period():
    written = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o) + k * T / 2 * v(n)))(x_o=BOUNDARY)
    expected = inside(K * depth() + K * PERIOD / 2 * VELOCITY)
    np.testing.assert_allclose(forces(written, "measured"), expected, rtol=1e-12)
    np.testing.assert_allclose(forces(hl.wall("half_sample")(x_o=BOUNDARY), "measured"), expected, rtol=1e-12)


def test_23_4_the_line_through_two_samples_is_its_own_continuation():
    line = 0.3 + 0.02 * np.arange(6.0)
    program = hl.compile(hl.Scene(force=k * hl.laws.predicted_sample())(k=1.0), T=PERIOD, dtype="float64")
    predicted = load(program).run(6, line[:, None]).outputs[:, 0, 0]
    np.testing.assert_allclose(predicted[1:-1], line[2:], rtol=1e-14)


def test_23_5_follows_from_23_3_with_the_backward_difference():
    estimated = forces(hl.wall("half_sample")(x_o=BOUNDARY))
    by_law = forces(hl.wall("backward_difference")(x_o=BOUNDARY))
    np.testing.assert_allclose(by_law, inside(K * (1.5 * depth() - 0.5 * depth(1))), rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(estimated, by_law, rtol=1e-12, atol=1e-13)


def test_23_6_the_correction_enters_with_half_its_weight():
    """Eq. (23.7) follows from (23.4) and (23.6) with F = k/2 (x(n) + xp(n+1) + (x(n) - xp(n))), xp the prediction."""
    predicted_next = hl.laws.predicted_sample()
    predicted_now = 2 * x(n - 1) - x(n - 2)
    corrected = sp.expand(k / 2 * (x(n) + predicted_next + x(n) - predicted_now))
    taps = [corrected.coeff(x(n - lag)) / k for lag in range(3)]
    assert taps == [2, sp.Rational(-3, 2), sp.Rational(1, 2)]


def test_23_7_ellis():
    expected = inside(K * (2 * depth() - 1.5 * depth(1) + 0.5 * depth(2)))
    np.testing.assert_allclose(forces(hl.wall("ellis")(x_o=BOUNDARY)), expected, rtol=1e-12, atol=1e-13)


def test_23_8_the_filter_around_a_wall_and_around_a_body():
    plain, filtered = forces(hl.wall()(x_o=BOUNDARY)), forces(hl.laws.force_filter(hl.wall())(x_o=BOUNDARY))
    past = [plain[np.maximum(np.arange(len(plain)) - lag, 0)] for lag in range(3)]
    np.testing.assert_allclose(filtered, 2 * past[0] - 1.5 * past[1] + 0.5 * past[2], rtol=1e-12, atol=1e-13)
    always = hl.laws.force_filter(hl.wall(unilateral=None))
    np.testing.assert_allclose(
        forces(always(x_o=BOUNDARY)), forces(hl.wall("ellis", unilateral=None)(x_o=BOUNDARY)), rtol=1e-11, atol=1e-13
    )
    z = hl.coordinate("z", unit="m")
    m, b = hl.parameters("m b", units="kg N*s/m", values=(0.05, 1.0))
    F = hl.laws.virtual_coupler(z, K=k, b=b)
    body = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)])
    raw, smooth = forces(body), forces(hl.laws.force_filter(body))
    past = [raw[np.maximum(np.arange(len(raw)) - lag, 0)] for lag in range(3)]
    np.testing.assert_allclose(smooth, 2 * past[0] - 1.5 * past[1] + 0.5 * past[2], rtol=1e-10, atol=1e-12)


def test_23_9_a_damped_paddle_on_a_passive_wall_never_gives_energy_back():
    """With b > K T/2 the energy drawn from the wall is never more than the device's own damper has swallowed."""
    b = 0.5
    paddle = hl.SimulatedPaddle(m=0.05, b=b, T=PERIOD, hand=hl.Hand(push=1.0))
    log = paddle.run(hl.wall()(k=1.9 * b / PERIOD), duration=2.0, dtype="float64")
    work = np.cumsum(log.F[:-1] * np.diff(log.x))
    speed = np.diff(log.x) / PERIOD  # the cheapest motion through the samples dissipates least
    swallowed = np.cumsum(b * speed**2 * PERIOD)
    assert work.min() < 0 <= (work + swallowed).min()


@pytest.mark.parametrize("B", [0.0, 0.03, -0.03])
def test_23_10_the_passivity_bound(B):
    limit = hl.passivity_limit(hl.Device(b=0.1, T=PERIOD), B=B)
    assert float(limit) == pytest.approx(2 * (0.1 - abs(B)) / PERIOD, rel=1e-12)


def test_fig_23_4_the_coupler_pulls_body_and_handle_equally():
    """A handle held still: the body rings at sqrt(K/m) and its energy falls by what the coupler's damper takes."""
    z = hl.coordinate("z", unit="m", initial=0.01 * hl.parameters("unit_length", units="m", values=1.0))
    m, b, K_c = hl.parameters("m b K_c", units="kg N*s/m N/m", values=(0.05, 0.2, 500.0))
    F = hl.laws.virtual_coupler(z, K=K_c, b=b)
    program = hl.compile(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)]), "rk4", T=1e-4, dtype="float64")
    felt = load(program).run(401, np.zeros((401, 1))).outputs[:, 0, 0]
    decay, natural = 0.2 / 0.1, math.sqrt(500 / 0.05)
    ring = math.sqrt(natural**2 - decay**2)
    time = 1e-4 * np.arange(401)
    body = 0.01 * np.exp(-decay * time) * (np.cos(ring * time) + decay / ring * np.sin(ring * time))
    rate = -0.01 * np.exp(-decay * time) * natural**2 / ring * np.sin(ring * time)
    # RK4 at omega h = 0.01 is within 1e-8 of the swing of 5 N
    np.testing.assert_allclose(felt, -500 * body - 0.2 * rate, atol=1e-7)
