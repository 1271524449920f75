"""Hands by name say where they come from; a firmer grip stiffens and damps."""

from dataclasses import replace

import pytest

from hapticlab.device.hand.hand import Hand
from hapticlab.device.hand.hand_presets import PRESETS, hand_presets
from hapticlab.errors import PaddleError


@pytest.mark.parametrize("name", PRESETS)
def test_every_hand_is_passive_and_has_a_source(name):
    found = Hand(name)
    assert found.m > 0 and found.b >= 0 and found.k > 0 and found.push == 0 and found.intent is None
    assert PRESETS[name].source in hand_presets()


def test_a_firmer_grip_stiffens_and_damps_and_keeps_the_mass():
    firm, soft = Hand("grip", grip=3.0, push=2.0), Hand("grip")
    assert (firm.m, firm.b, firm.k, firm.push) == (soft.m, 15.0, 1500.0, 2.0)
    assert Hand("grip", grip=3.0, k=10.0).k == 10.0


def test_unknown_hands_and_grips_are_refused():
    with pytest.raises(PaddleError, match="no hand 'fist'; the presets are pinch, grip, arm,"):
        Hand("fist")
    with pytest.raises(PaddleError, match="grip = 0"):
        Hand("pinch", grip=0)
    with pytest.raises(TypeError, match="stiffness"):
        Hand("pinch", stiffness=3)
    with pytest.raises(PaddleError, match="grip = 2: grip makes a preset firmer"):
        Hand(grip=2, k=100)


def test_a_changed_hand_keeps_the_numbers_of_its_preset():
    firm = replace(Hand("grip", grip=3.0), push=2.0)
    assert (firm.m, firm.b, firm.k, firm.push) == (0.1, 15.0, 1500.0, 2.0)
