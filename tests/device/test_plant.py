"""The map between samples: against arbitrary precision, and through delays against an event-located integration."""

import itertools
import math

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hapticlab.device.hand import Hand
from hapticlab.device.plant import PHI, delay_parts, plant_of, transition, values
from hapticlab.device.simulated import SimulatedPaddle


def mp_transition(M, b, k, h):
    """Return the same map from mpmath's own exponential, in 60 digits and SI units."""
    with mpmath.workdps(60):
        M, b, k, h = (mpmath.mpf(a) for a in (M, b, k, h))
        A = mpmath.matrix([[0, 1, 0, 0], [-k / M, -b / M, 1 / M, 0], [0, 0, 0, 1], [0, 0, 0, 0]])
        E = mpmath.expm(A * h, method="taylor")
        place = {name: position for position, name in enumerate("xvud")}
        return {e: E[place[e[0]], place[e[1]]] for e in PHI}


@pytest.mark.parametrize(
    ("M", "b", "k", "h"),
    [
        (0.05, 0.1, 0.0, 1e-3), (0.166, 0.057, 0.0, 1e-3), (0.266, 5.057, 500.0, 1e-3), (0.005, 2.0, 0.0, 1e-3),
        (0.03, 0.0, 0.0, 1e-7), (0.05, 1.1, 200.0, 1e-5), (0.03, 0.1, 900.0, 2e-2), (0.2, 0.0, 500.0, 5e-2),
        (1e-3, 0.99, 0.0, 1e-3), (1e-3, 1.01, 0.0, 1e-3), (1e-5, 0.1, 0.0, 2e-3), (1e12, 1e3, 0.0, 1e-5),
    ],
)  # fmt: skip
def test_transition_keeps_relative_accuracy(M, b, k, h):
    exact = mp_transition(M, b, k, h)
    for entry, value in transition(M, b, k, h).items():
        assert abs(value - exact[entry]) <= 1e-13 * abs(exact[entry]), entry


def test_a_handle_of_next_to_no_mass_is_dragged_at_once():
    """M = 1e-12 kg: e^-1e8 is 0, and what is left follows from x' = (u + d t)/b, less M/b of it."""
    phi, b, h, lag = transition(1e-12, 0.1, 0.0, 1e-3), 0.1, 1e-3, 1e-11
    expected = {"xx": 1.0, "xv": lag, "xu": (h - lag) / b, "xd": (h * h / 2 - lag * (h - lag)) / b}
    expected |= {"vx": 0.0, "vv": 0.0, "vu": 1 / b, "vd": (h - lag) / b}
    np.testing.assert_allclose([phi[e] for e in PHI], [expected[e] for e in PHI], rtol=2e-15)


def test_a_spring_far_faster_than_the_samples():
    """sqrt(k/M) h = 1414 rad: rounding of the angle alone is 1e-13 of a turn."""
    M, k, h = 1e-10, 200.0, 1e-3
    w, phi = math.sqrt(k / M), transition(M, 0.0, k, h)
    expected = {"xx": math.cos(w * h), "xv": math.sin(w * h) / w, "xu": (1 - math.cos(w * h)) / k}
    expected |= {"vx": -w * math.sin(w * h), "vv": math.cos(w * h), "vu": math.sin(w * h) / (M * w)}
    np.testing.assert_allclose([phi[e] for e in expected], [*expected.values()], rtol=1e-10)


def test_many_at_once_are_each_alone_to_the_bit():
    random = np.random.default_rng(8)
    M, h = random.uniform(0.01, 0.3, 200), random.uniform(1e-4, 0.2, 200)
    b, k = random.choice([0.0, 0.3, 90.0], 200), random.choice([0.0, 40.0, 3000.0], 200)
    many = transition(M, b, k, h)
    for j in range(200):
        assert {e: a[j] for e, a in many.items()} == transition(M[j], b[j], k[j], h[j])


def parameters_of(paddle):
    return dict(zip((c.name for c in plant_of(paddle).channels()), values(paddle), strict=True))


HANDS = {
    "none": None,
    "push": Hand(push=1.5),
    "grip": Hand(m=0.1, b=5, k=500, push=-0.3),
    "resting": Hand(k=300, intent=0.02),
    "moving": Hand(m=0.02, b=1, k=200, push=0.4, intent=np.sin),
    "dragging": Hand(b=2, intent=np.sin),
    "spring only": Hand(k=80, intent=np.sin),
}


@pytest.mark.parametrize(("hand", "delay"), list(itertools.product(HANDS.values(), (0.0, 3.1e-4, 2e-3, 2.75e-3))))
def test_step_is_the_differential_equation(hand, delay):
    paddle = SimulatedPaddle(m=0.05, b=0.3, T=1e-3, delay=delay, hand=hand)
    intent, rate = (0.013, -0.7) if hand is not None and hand.moves else (0.0, 0.0)
    x, v, F_before, F_after = 0.011, -0.23, 0.9, -1.7
    M, b, k = paddle.m + (hand.m if hand else 0), 0.3 + (hand.b if hand else 0), hand.k if hand else 0
    rest = 0.0 if hand is None or hand.moves or hand.intent is None else hand.intent

    def field(F):
        def right(t, y):
            drag = hand.b * rate if hand else 0
            force = (hand.push if hand else 0) - F - b * y[1] - k * (y[0] - rest - intent - rate * t) + drag
            return [y[1], force / M]

        return right

    part = delay % 1e-3 if delay not in (0.0, 2e-3) else 0.0
    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-17}
    y = np.array([x, v])
    if part:
        y = solve_ivp(field(F_before), (0, part), y, **options).y[:, -1]
    at_switch = y[0]
    y = solve_ivp(field(F_after), (part, 1e-3), y, **options).y[:, -1]
    got = plant_of(paddle).step(parameters_of(paddle), x, v, F_before, F_after, intent, rate)
    assert got == pytest.approx([at_switch, *y], rel=1e-12)


@pytest.mark.parametrize(
    ("delay", "whole", "fraction"),
    [
        (0, 0, 0), (1e-3, 1, 0), (3e-3, 3, 0), (0.3e-3, 0, 0.3), (2.5e-3, 2, 0.5), (7e-4 + 3e-4, 1, 0),
        (1.0001e-3, 1, 1e-4),
    ],
)  # fmt: skip
def test_delay_is_split_exactly(delay, whole, fraction):
    got = delay_parts(SimulatedPaddle(m=1, b=0, T=1e-3, delay=delay))
    assert got[0] == whole and got[1] == pytest.approx(fraction, abs=1e-12)
    assert (got[1] == 0) == (fraction == 0)


def test_only_what_the_paddle_has_is_a_parameter():
    def names(**given):
        plant = plant_of(SimulatedPaddle(m=1, b=0.1, T=1e-3, **given))
        return [c.name.removeprefix("plant.") for c in plant.channels()]

    assert names() == ["phi_xv", "phi_xu", "phi_vv", "phi_vu"]
    assert names(hand=Hand(push=1)) == ["push", "phi_xv", "phi_xu", "phi_vv", "phi_vu"]
    assert names(hand=Hand(m=1)) == names()
    assert "phi_xx" in names(hand=Hand(k=1)) and "phi_xd" not in names(hand=Hand(k=1))
    assert len(names(delay=1e-4)) == 8 and "coulomb" in names(coulomb=1)
