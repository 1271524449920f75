"""A sensor's lag in the limits: the loop, simulated, turns from decay to growth where the limit says, within 0.5 %."""

from dataclasses import replace

import numpy as np
import pytest

import hapticlab as hl

PADDLES = {
    "light": {"m": 0.03, "b": 0.10, "T": 1e-3, "delay": 2.1e-4, "sensor_delay": 7.8e-4},
    "fast": {"m": 0.166, "b": 0.3, "T": 5e-4, "sensor_delay": 1e-4},
    "slow sensor": {"m": 0.05, "b": 0.5, "T": 1e-3, "delay": 1.3e-3, "sensor_delay": 1.8e-3, "hand": hl.Hand(m=0.1, b=2, k=300)},
    "whole samples": {"m": 0.08, "b": 0.2, "T": 2e-3, "delay": 9e-4, "sensor_delay": 2e-3, "hand": hl.Hand(m=0.02, b=1, k=100)},
}


def grows(paddle, K, law):
    """How much larger the swings of the last quarter are than those of the second."""
    wall = hl.wall(law=law, unilateral=None)(k=K)
    x = np.abs(paddle.run(wall, duration=6000 * paddle.T, x=1e-3, dtype="float64").x_true)
    return x[4500:].max() / x[1500:3000].max()


@pytest.mark.parametrize("law", ["zoh", "ellis"])
@pytest.mark.parametrize("name", PADDLES)
@pytest.mark.always("light-zoh", "slow sensor-ellis")
def test_the_border_of_stability_is_where_the_limit_says(name, law):
    paddle = hl.SimulatedPaddle(**PADDLES[name])
    limit = hl.stability_limit(paddle, law=law).K
    assert grows(paddle, 0.995 * limit, law) < 1 < grows(paddle, 1.005 * limit, law)
    assert hl.stability_limit(replace(paddle, sensor_delay=0.0), law=law).K > 1.3 * limit  # and the lag decides it


def test_passive_is_what_the_worst_hand_leaves():
    """No limit of stability in a hand lies below; a hand of a hundred times the mass and a soft spring comes within 2 %."""
    paddle = hl.SimulatedPaddle(**PADDLES["light"])
    passive = hl.passivity_limit(paddle).K
    hands = [hl.Hand(m=m, k=k) for m in (0.0, 0.3, 3.0) for k in (0.0, 1.0, 30.0, 1000.0)]
    stable = [hl.stability_limit(replace(paddle, hand=hand)).K for hand in hands]
    assert passive <= min(stable) < 1.02 * passive
    assert passive == hl.passivity_limit(replace(paddle, delay=9.9e-4, sensor_delay=0.0)).K


def test_a_device_a_profile_and_a_paddle_agree():
    """The lag is never left out, whatever a limit is given."""
    profile = hl.devices.PaddleProfile("late", m=0.05, b=0.1, sensor_delay=1e-3)
    kinds = profile, hl.Device(m=0.05, b=0.1, T=1e-3, sensor_delay="1 ms"), hl.SimulatedPaddle.from_profile(profile)
    for limit in (hl.stability_limit, hl.passivity_limit, hl.stability.damper_limit, hl.bounds.gil):
        found = {float(getattr(limit(kind), "K", limit(kind))) for kind in kinds}
        told = limit(hl.Device(m=0.05, b=0.1, T=1e-3, delay=1e-3))
        assert found == {float(getattr(told, "K", told))}, limit
    assert hl.passivity_limit(profile).K == pytest.approx(200 / 3)
