"""The hand refuses what is no passive hand, in words, and samples its intent at the ticks."""

import numpy as np
import pytest

from hapticlab.device.hand.hand import Hand
from hapticlab.errors import PaddleError

NAN = float("nan")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"k": -50}, r"k = -50 N/m; a hand needs k >= 0\. A negative spring pushes the handle away"),
        ({"b": -1}, r"b = -1 N s/m; a hand needs b >= 0\. A negative damper supplies energy to the handle."),
        ({"m": -0.1}, r"m = -0.1 kg; a hand needs m >= 0"),
        ({"m": NAN}, r"m = nan kg; a hand needs m >= 0 and finite"),
        ({"push": NAN}, r"push = nan N; a hand needs a finite push"),
        ({"push": float("inf")}, r"push = inf N"),
        ({"k": "stiff"}, r"k = 'stiff'; a hand needs k >= 0. Give a number in N/m"),
        ({"intent": 0.1}, r"intent without k or b"),
        ({"intent": np.sin}, r"intent without k or b"),
        ({"intent": NAN, "k": 1}, r"intent = nan m"),
    ],
)
def test_bad_values_are_refused(given, said):
    with pytest.raises(PaddleError, match=said):
        Hand(**given)


def test_a_number_is_no_preset():
    with pytest.raises(PaddleError, match=r"no hand 0.1; the presets are pinch,.*hl.Hand\(m="):
        Hand(0.1)


def test_intent_is_sampled_at_the_ticks():
    hand = Hand(k=1, intent=lambda t: 3 * t**2)
    assert np.array_equal(hand.samples(4, 0.5), 3 * np.array([0, 0.5, 1, 1.5, 2]) ** 2)
    assert np.array_equal(Hand(b=1, intent=lambda t: 0.25).samples(2, 1.0), [0.25] * 3)


@pytest.mark.parametrize(
    ("intent", "said"),
    [
        (lambda t: t[:-1], r"intent gave shape \(4,\) for 5 times"),
        (lambda t: np.where(t > 1.2, np.nan, t), r"intent is not finite at t = 1.5 s"),
        (lambda t: NAN, r"intent is not finite at t = 0 s"),
    ],
)
def test_bad_intents_are_refused(intent, said):
    with pytest.raises(PaddleError, match=said):
        Hand(k=1, intent=intent).samples(4, 0.5)
