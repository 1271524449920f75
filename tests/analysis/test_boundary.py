"""Where the simulated wall loses stability, against the exact limit of its closed loop: by growth, not by amplitude."""

import numpy as np
import pytest

from hapticlab.analysis.stability import stability_limit
from hapticlab.analysis.sweep import sweep
from hapticlab.device.hand import Hand
from hapticlab.device.simulated import SimulatedPaddle
from hapticlab.scene.laws import wall
from hapticlab.scene.taps import TAPS

STEP = 0.02
GRID = 1 + STEP * (np.arange(6) - 2.5)  # the limit lies in the middle of the middle step


@pytest.mark.parametrize("law", TAPS)
@pytest.mark.parametrize("delay", [0.0, 1e-3, 0.4e-3], ids=["prompt", "one sample", "0.4 of a sample"])
@pytest.mark.parametrize("hand", [None, Hand(m=0.02, b=1.0, k=200.0)], ids=["free", "held"])
def test_the_spring_that_always_acts(law, delay, hand):
    """Growth changes sign across the exact limit, within one step of 2 % of the stiffness."""
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, delay=delay, hand=hand)
    limit = stability_limit(paddle, law=law)
    duration = 0.4 if limit.frequency > 100 else 8.0  # whole cycles in a quarter
    found = sweep(
        wall(law, unilateral=None), paddle, metric="growth", duration=duration, progress=False, x=1e-3, k=limit.K * GRID
    )
    growth = np.where(np.isnan(found.values), np.inf, found.values)  # nan: it grew past the largest force of float32
    assert (growth[:3] < 0).all() and (growth[3:] > 0).all(), growth


def test_the_plain_unilateral_wall_held_against_a_push():
    """Pressed into the wall the handle does not leave it while the oscillation is small: the same limit."""
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=Hand(push=2.0))
    limit = stability_limit(paddle)
    rest = 2.0 / limit.K
    found = sweep(wall(), paddle, metric="growth", duration=8.0, progress=False, x=0.98 * rest, k=limit.K * GRID)
    assert (found.values[:3] < 0).all() and (found.values[3:] > 0).all(), found.values


@pytest.mark.parametrize("law, b, part", [("half_sample", 0.02, 0.05), ("backward_difference", 0.005, 0.8)])
def test_a_predictive_law_behind_a_switch_chatters_earlier(law, b, part):
    """Prediction acts inside the wall only, so the crossings leak: a lasting limit cycle where the linear loop decays."""
    paddle = SimulatedPaddle(m=0.05, b=b, T=1e-3, hand=Hand(push=2.0))
    k = part * stability_limit(paddle, law=law).K
    linear = sweep(wall(law, unilateral=None), paddle, metric="growth", duration=4.0, progress=False, x=0.0, k=k)
    switched = sweep(wall(law), paddle, duration=20.0, progress=False, x=-0.02, k=k)
    assert linear.values < -b / 2 / 0.05 * (1 - part) / 2
    assert switched.values > 5e-3
