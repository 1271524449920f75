"""Hands drawn at random are passive, repeat with their seed, and are spread evenly over decades."""

import numpy as np
import pytest
from scipy.stats import kstest

from hapticlab.device.hand.random_hands import random_hands
from hapticlab.errors import PaddleError


def test_each_logarithm_is_uniform_between_its_ends():
    hands = random_hands(2000, m=(1e-3, 1.0), b=(0.01, 0.1), k=("10 N/m", 1e4), push=1.0, seed=1)
    drawn = np.log10([[hand.m, hand.b, hand.k] for hand in hands])
    for column, low, decades in zip(drawn.T, (-3, -2, 1), (3, 1, 3), strict=True):
        assert kstest(column, "uniform", (low, decades)).pvalue > 1e-3
    assert abs(np.corrcoef(drawn.T) - np.eye(3)).max() < 0.1
    assert {hand.push for hand in hands} == {1.0}


def test_a_seed_draws_the_same_hands_again():
    assert random_hands(3, seed=4) == random_hands(3, seed=4) != random_hands(3, seed=5)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"b": (0, 1)}, "least b = 0 N s/m; a range of hands needs least b > 0"),
        ({"m": (1, 0.1)}, "largest m = 0.1 kg; a range of hands needs largest m >= 1"),
        ({"m": 0.1}, r"m = 0.1; a range of hands needs two numbers, \(least, largest\), each > 0 kg"),
        ({"k": (1, 2, 3)}, r"k = \(1, 2, 3\); a range of hands needs two numbers"),
        ({"hands": 0}, "hands = 0; needs a whole number >= 1"),
    ],
)
def test_ranges_that_hold_no_hand_are_rejected(given, words):
    with pytest.raises(PaddleError, match=words):
        random_hands(**{"hands": 2, **given})
