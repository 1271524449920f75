"""The wall of the digital domain: poles of the sampled loop against the wall's own, from scipy and from closed forms."""

import math

import numpy as np
import pytest
from scipy.linalg import expm

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import AnalysisError, SceneError

HAND = hl.Hand(m=0.02, b=1.0, k=200.0)


def exact(m, b, k, T):
    """Return e^(A T) of m x'' = -b x' - k x."""
    return expm(np.array([[0.0, 1.0], [-k / m, -b / m]]) * T)


def held(m, b, k, T):
    """Return the sampled motion and the effect of a held force, from one exponential with the force as a state."""
    both = expm(np.array([[0.0, 1.0, 0.0], [-k / m, -b / m, 1 / m], [0.0, 0.0, 0.0]]) * T)
    return both[:2, :2], both[:2, 2]


@pytest.mark.parametrize("wT", [0.05, 0.4, 1.2, 2.5])
def test_an_undamped_wall_takes_a_softer_spring_and_half_a_period_of_damper(wT):
    m, T = 0.05, 2e-3
    K = m * (wT / T) ** 2
    gains = hl.design.digital_gains(hl.SimulatedPaddle(m=m, b=0.0, T=T), K=K)
    k1 = K * (math.sin(wT / 2) / (wT / 2)) ** 2
    assert gains.k1 == pytest.approx(k1, rel=1e-12) and gains.k2 == pytest.approx(k1 * T / 2, rel=1e-12)
    assert [abs(z) for z in gains.poles] == pytest.approx([1, 1], rel=1e-12)
    assert "% of K" in str(gains)


@pytest.mark.parametrize("B", [0.0, 0.7])
def test_the_sampled_loop_has_the_poles_of_handle_hand_and_wall(B):
    m, b, T, K = 0.05, 0.1, 3e-3, 1500.0
    gains = hl.design.digital_gains(hl.SimulatedPaddle(m=m, b=b, T=T, hand=HAND), K=K, B=B)
    Phi, gamma = held(m + HAND.m, b + HAND.b, HAND.k, T)
    loop = np.linalg.eigvals(Phi - np.outer(gamma, [gains.k1, gains.k2]))
    target = np.linalg.eigvals(exact(m + HAND.m, b + HAND.b + B, HAND.k + K, T))
    # a pair of poles of order one from gains of five digits' spread: some 100 roundings
    assert sorted(loop, key=np.imag) == pytest.approx(sorted(target, key=np.imag), abs=1e-12)


@pytest.mark.parametrize("delay", [0.0, 2e-3, 2.6e-3])
@pytest.mark.parametrize("velocity", [None, "model"])
@pytest.mark.always("None-0.002", "model-0.0026")
def test_under_a_delay_the_handle_keeps_the_wall_s_own_rhythm(delay, velocity):
    """Deep inside the wall, the samples obey the characteristic equation of the unsampled wall, delay or none."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, delay=delay, hand=HAND)
    scene = hl.laws.digital_wall(paddle, K=800.0, velocity=velocity)(x_o=-0.05)
    x = paddle.run(scene, duration=0.08, x=-0.036, v=0.3, progress=False, dtype="float64").x
    one = exact(0.07, 1.1, 1000.0, 1e-3)
    left = x[2:] - np.trace(one) * x[1:-1] + np.linalg.det(one) * x[:-2]
    left = left[8:] - left[-1]  # what is left is the constant that the place of rest makes
    assert np.ptp(x[8:]) > 2e-3 and x.min() > -0.05 and abs(left).max() < 1e-12


def test_a_known_push_rests_where_the_wall_would_hold_it():
    paddle = hl.SimulatedPaddle(m=0.05, b=2.0, T=5e-3, hand=hl.Hand(m=0.02, b=1.0, k=200.0, push=3.0, intent=0.004))
    K, x_o = 900.0, 0.002
    x = paddle.run(hl.laws.digital_wall(paddle, K=K)(x_o=x_o), duration=2.0, x=0.003, progress=False, dtype="float64").x
    assert x[-1] == pytest.approx((3.0 + 200 * 0.004 + K * x_o) / (K + 200), rel=1e-9)


def test_the_predictive_wall_feels_the_wall_half_a_period_after_its_force_begins():
    """With a delay: the motion until the force acts, by scipy under the forces under way, and half a period of the wall."""
    K, T, delay = 800.0, 4e-3, 6e-3
    hand = hl.Hand(m=0.02, b=1.0, k=200.0, push=1.0)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, delay=delay, hand=hand)
    log = paddle.run(hl.laws.predictive_wall(paddle, K=K), duration=0.06, x=0.004, v=0.4, progress=False, dtype="float64")
    state = np.array([log.x[3], log.v[3]])
    Phi, gamma = held(0.07, 1.1, 200.0, T / 2)
    for F in (log.F[1], log.F[2], log.F[2]):  # half a period each: 1.5 periods of delay, the oldest force first
        state = Phi @ state + gamma * (1.0 - F)
    inside, push = held(0.07, 1.1, 1000.0, T / 2)
    assert log.F[3] == pytest.approx(K * (inside @ state + push * 1.0)[0], rel=1e-10)
    assert (log.x[3:5] > 0).all()


def test_a_chosen_velocity_and_a_limit_are_obeyed():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=1e5, force_max=2.0)
    for make in (hl.laws.digital_wall, hl.laws.predictive_wall):
        scene = make(paddle, K=600.0, velocity=hl.velocity.filtered(tau="2 ms"), clamp=True)
        log = paddle.run(scene, duration=0.1, x=-1e-3, v=0.6, progress=False)
        assert log.F.max() == 2.0 and log.F.min() == 0.0 and log.limited.max() == 1.0
    with pytest.raises(SceneError, match="velocity = 'best'; needs None"):
        hl.laws.digital_wall(paddle, K=600.0, velocity="best")
    with pytest.raises(AnalysisError, match=r"K = 0 N/m; a wall needs K > 0"):
        hl.laws.digital_wall(paddle, K=0.0)
    moving = hl.Hand(k=100, intent=lambda t: 0 * t)
    with pytest.raises(AnalysisError, match="the hand moves,"):
        hl.laws.digital_wall(paddle, K=600.0, hand=moving)
    with pytest.raises(AnalysisError, match="a float has no m"):
        hl.laws.digital_wall(1.0, K=600.0)


@pytest.mark.parametrize("make", [hl.laws.digital_wall, hl.laws.predictive_wall, hl.laws.deadbeat_wall])
@pytest.mark.always("digital_wall", "predictive_wall")
def test_at_another_period_there_is_no_force_but_a_fault(make):
    scene = make(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), K=500.0)
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=1.1e-3).run(scene, duration=0.02, x=1e-3, progress=False)
    assert log.fault is not None and not log.F.any()
    assert "(made for T = 1 ms) was not finite" in log.fault


@pytest.mark.parametrize("make", [hl.laws.digital_wall, hl.laws.predictive_wall])
def test_they_run_bit_for_bit_in_the_firmware_core_and_fit_the_uno_at_1_khz(make):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=1e5)
    program = paddle.program(make(paddle, K=600.0, velocity="model"))
    path = (0.002 * np.sin(0.06 * np.arange(200))).astype(np.float32)[:, None]
    there, here = (load(program, engine).run(200, path).outputs for engine in ("vm", "interpreter"))
    np.testing.assert_array_equal(there, here)
    assert cost(program).fits


@pytest.mark.parametrize("make", [hl.laws.digital_wall, hl.laws.predictive_wall, hl.laws.deadbeat_wall, hl.design.digital_gains])
def test_the_name_of_a_hand_is_no_hand(make):
    with pytest.raises(AnalysisError, match=r"hand = 'pinch'; needs a Hand, such as hl\.Hand\(\"pinch\"\) or hl.Hand\(m=0.02,"):
        make(hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3), K=500, hand="pinch")
