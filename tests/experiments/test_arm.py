"""An arm's smooth paths against their conditions, and its intents against the simulated handle they move."""

from dataclasses import replace

import numpy as np
import pytest

from hapticlab.device.hand.hand import Hand
from hapticlab.device.hand.intents import MinimumJerk
from hapticlab.device.hand.reacting_hand import Reacting
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.experiments.arm import Arm, along, quintic
from hapticlab.scene.laws.chapter_laws import wall


def test_a_path_meets_both_ends():
    start, end = (0.01, -0.2, 3.0), (0.04, 0.5, -5.0)
    path = quintic(start, end, 0.37)
    assert along(path, 0.0) == pytest.approx(start, abs=1e-14)
    assert along(path, 0.37) == pytest.approx(end, abs=1e-12)
    h = 1e-5
    place, velocity, acceleration = along(path, 0.2)
    around = [along(path, 0.2 + s * h)[0] for s in (-1, 1)]
    assert velocity == pytest.approx((around[1] - around[0]) / (2 * h), rel=1e-7)
    assert acceleration == pytest.approx((around[1] - 2 * place + around[0]) / h**2, rel=1e-4)


def test_from_rest_to_rest_it_is_the_path_of_minimum_jerk():
    reach, path = MinimumJerk(end=0.03, duration=0.5), quintic((0, 0, 0), (0.03, 0, 0), 0.5)
    for t in (0.1, 0.25, 0.4):
        assert along(path, t) == pytest.approx([float(part) for part in reach.at(t)], abs=1e-13)


@pytest.mark.parametrize("b_hand", [0.0, 5.0])
def test_the_intent_moves_the_handle_along_the_path(b_hand):
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=Hand(m=0.1, b=b_hand, k=500.0))
    arm, path = Arm(m=0.15, b=0.1, b_hand=b_hand, k=500.0), quintic((0, 0, 0), (0.03, 0, 0), 0.4)

    def plan(t, seen, intent, every=1e-3):
        before, after = (arm.force(*along(path, min(at, 0.4))) for at in (t - every, t))
        return arm.intent(intent, before, after, every)

    held = replace(paddle, hand=replace(paddle.hand, intent=Reacting(plan=plan, interval=1e-3)))
    log = held.run(wall()(k=1, x_o=1), duration=0.4, engine="interpreter", progress=False)
    meant = np.array([along(path, t)[0] for t in log.t])
    assert np.abs(log.x - meant).max() < 1e-6  # the intent is linear within a millisecond
