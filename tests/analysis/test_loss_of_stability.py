"""Where simulation loses stability, against the exact limit: by growth rate, within one step of a grid in K.

Amplitude would not tell: 1 % under the limit a decay takes 1e5 samples. The swing of the second half of a long run over
that of the first is above one exactly where the closed loop grows.
"""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.scene.taps import TAPS

PERIOD = 1e-3
STEP = 0.004  # relative step of the grid in K, which the limit must fall into


def growth(scene, paddle, K, **options):
    return hl.sweep(scene, paddle, metric="growth", duration=20.0, progress=False, k=K, **options).values


@pytest.mark.parametrize("delay", [0.0, PERIOD])
@pytest.mark.parametrize("law", TAPS)
def test_a_spring_that_always_acts_loses_stability_at_the_exact_limit(law, delay):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.4, T=PERIOD, delay=delay)
    exact = hl.stability_limit(paddle, law=law).K
    K = exact * (1 + STEP * (np.arange(10) - 4.5))
    rates = growth(hl.wall(law, unilateral=None), paddle, K, x=1e-3)
    assert (rates[K < exact] < 0).all(), rates
    assert (rates[K > exact] > 0).all(), rates


@pytest.mark.parametrize("law", TAPS)
def test_with_a_hand_and_a_fraction_of_delay(law):
    hand = hl.Hand(m=0.02, b=1.0, k=200.0)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=PERIOD, delay=0.3e-3, hand=hand)
    exact = hl.stability_limit(paddle, law=law).K
    K = exact * (1 + STEP * (np.arange(10) - 4.5))
    rates = growth(hl.wall(law, unilateral=None), paddle, K, x=1e-3)
    assert (rates[K < exact] < 0).all(), rates
    assert (rates[K > exact] > 0).all(), rates


@pytest.mark.parametrize("delay", [0.0, PERIOD])
def test_the_plain_unilateral_wall_begins_to_chatter_at_the_exact_limit(delay):
    """A hand that leans on the wall: small swings stay inside, where the unilateral wall is the linear law."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=PERIOD, delay=delay, hand=hl.Hand(push=2.0))
    exact = hl.stability_limit(paddle).K
    K = exact * (1 + STEP * (np.arange(10) - 4.5))
    rates = np.array([float(growth(hl.wall(), paddle, [k], x=2.0 / k + 1e-3)[0]) for k in K])
    assert (rates[K < exact] < 0).all(), rates
    assert (rates[K > exact] > 0).all(), rates


@pytest.mark.parametrize("law", ["backward_difference", "ellis"])
def test_a_predictive_law_behind_a_switch_chatters_earlier(law):
    """The linear limit does not hold for a switched predictor: well under it, bouncing is already sustained."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.02, T=PERIOD, hand=hl.Hand(push=1.0))
    exact = hl.stability_limit(paddle, law=law).K
    K = exact * np.array([0.3, 0.5, 0.7, 0.9])
    linear = growth(hl.wall(law, unilateral=None), paddle, K, x=0.05)
    assert (linear < 0).all()
    switched = hl.sweep(hl.wall(law), paddle, metric="chatter", duration=20.0, progress=False, k=K, x=-0.05).values
    plain = hl.stability_limit(paddle).K
    assert (switched > 0).any(), switched
    assert K[switched > 0].min() > plain  # and still later than the wall without prediction
