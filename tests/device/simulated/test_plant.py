"""The plant between samples, through delays, against an integration; the map itself is tested with transition.py."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.plant import delay_parts, plant_of, values
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle


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
    assert got[1:] == pytest.approx([at_switch, *y], rel=1e-12)


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
