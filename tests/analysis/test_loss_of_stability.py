"""Where simulation loses stability, against the exact limit: by growth rate, within one step of a grid in K.

Amplitude would not tell: 1 % under the limit a decay takes 1e5 samples. The largest swing of the last quarter of a long
run over that of the quarter before is above one exactly where the closed loop grows.
"""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.scene.laws.taps import TAPS

PERIOD = 1e-3
STEP = 0.004  # relative step of the grid in K, which the limit must fall into
#: in twice as long, what decays fastest ends among the float32 numbers next to zero, where nothing decays any further
DURATION = 10.0


def growth(scene, paddle, K, **options):
    """Return the growth rates [1/s]; a run that overflowed, and so ended in a fault, has grown without bound."""
    rates = hl.sweep(scene, paddle, metric="growth", duration=DURATION, progress=False, k=K, **options).values
    unknown = np.isnan(rates)
    if unknown.any():
        at = {"x": options["x"], "k": K[unknown]}
        peaks = hl.sweep(scene, paddle, metric="peak_force", duration=DURATION, progress=False, **at).values
        rates[unknown] = np.where(np.isnan(peaks), np.inf, np.nan)  # where it faulted there is no peak
    return rates


@pytest.mark.parametrize("delay", [0.0, PERIOD])
@pytest.mark.parametrize("law", TAPS)
@pytest.mark.always("zoh-*", "ellis-0.001")
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
    rates = growth(hl.wall(), paddle, K, x=2.0 / exact + 1e-3)
    assert (rates[K < exact] < 0).all(), rates
    assert (rates[K > exact] > 0).all(), rates


@pytest.mark.parametrize(
    ("law", "m", "b", "delay", "share", "switched"),
    [
        ("half_sample", 0.05, 0.1, 0.0, 0.1, True),  # a tenth of its linear limit, and it bounces for ever
        ("backward_difference", 0.05, 0.1, 0.0, 0.9, True),
        ("backward_difference", 0.166, 0.057, 0.0, 0.96, True),
        # a sample of delay takes prediction's advantage: the limit falls to some 2b/T. The switch may still cost more
        ("ellis", 0.005, 2.0, PERIOD, 0.97, True),
        ("half_sample", 0.05, 0.1, PERIOD, 0.97, False),
        ("backward_difference", 0.05, 0.1, PERIOD, 0.97, False),
        ("ellis", 0.05, 0.1, PERIOD, 0.97, False),
    ],
)
@pytest.mark.always("half_sample-*-True", "ellis-*-True")
def test_a_predictive_law_behind_a_switch_chatters_earlier(law, m, b, delay, share, switched):
    """Under its linear limit the law that always acts comes to rest; the gated one may not."""
    paddle = hl.SimulatedPaddle(m=m, b=b, T=PERIOD, delay=delay, hand=hl.Hand(push=1.0))
    K = share * hl.stability_limit(paddle, law=law).K

    def swing(unilateral):
        wall = hl.wall(law, unilateral=unilateral)
        # the heavy paddle settles on its cycle from above, for longer than 12 s
        return hl.sweep(wall, paddle, duration=40.0, progress=False, k=[K], x=-0.02).values[0]

    assert swing(None) == 0
    assert swing("gate") > 1e-4 if switched else swing("gate") == 0


def test_clipping_calms_the_backward_difference():
    paddle = hl.SimulatedPaddle(m=0.166, b=0.057, T=PERIOD, hand=hl.Hand(push=1.0))
    K = 0.96 * hl.stability_limit(paddle, law="backward_difference").K
    gate, clip = (
        hl.sweep(
            hl.wall("backward_difference", unilateral=variant), paddle, duration=160.0, progress=False, k=[K], x=-0.02
        ).values
        for variant in ("gate", "clip")
    )
    assert gate[0] > 1e-4
    assert clip[0] == 0
