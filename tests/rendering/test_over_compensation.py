"""Over-compensated dry friction: what simulation finds against closed forms, in and beyond their validity."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.rendering.over_compensation import LANES, over_compensation

pytest.importorskip("llvmlite")
DAMPING, COULOMB = 0.4, 0.02


def paddle(**changes):
    return hl.SimulatedPaddle(**{"m": 0.05, "b": DAMPING, "T": 1e-3, "coulomb": COULOMB, **changes})


@pytest.mark.parametrize("viscous", [0.0, 0.5])
@pytest.mark.parametrize("delay", [0.0, 2.5e-3])
@pytest.mark.always("*-0.5")
def test_a_free_handle_goes_on_where_its_steady_speed_leaves_the_dead_zone(viscous, delay):
    """(dry - 1) coulomb/(damping left) = speed; three times divided by 32 a range of 1 is known to 3e-5."""
    found = over_compensation(paddle(delay=delay), speed=0.002, viscous=viscous)
    assert found.limit == pytest.approx(1 + (1 - viscous) * DAMPING * 0.002 / COULOMB, abs=4e-5)
    moving = found.motion > 0
    assert 5 < np.count_nonzero(moving) < LANES - 5
    # exp(-25) of the kick is left; near rest the runs of float32 hold seven digits
    np.testing.assert_allclose(found.motion[moving], found.expected[moving], rtol=1e-5)


def test_about_a_spring_the_limit_tends_to_the_closed_form():
    """2/(1 + r) as period and width go to zero, and the error with them: a tenth of both, a tenth of it."""
    hand = hl.Hand(k=20)
    coarse = over_compensation(paddle(hand=hand), speed=2e-3)
    fine = over_compensation(paddle(hand=hand, T=1e-4), speed=2e-4)
    ratio = DAMPING / (2 * np.sqrt(20 * 0.05))
    kept = np.exp(-np.pi * ratio / np.sqrt(1 - ratio**2))
    errors = [found.limit - 2 / (1 + kept) for found in (coarse, fine)]
    assert errors[0] == pytest.approx(10 * errors[1], rel=0.15)
    assert 0.005 < errors[1] < 0.008
    moving = fine.motion > 0
    np.testing.assert_allclose(fine.motion[moving], fine.expected[moving], rtol=2e-3)
    np.testing.assert_array_equal(fine.expected > 0, fine.dry > 2 / (1 + kept))


def test_a_resting_hand_elsewhere_is_the_same():
    found = [over_compensation(paddle(hand=hl.Hand(k=20, intent=place)), speed=2e-3) for place in (None, 0.01)]
    assert found[0].limit == pytest.approx(found[1].limit, abs=1e-4)  # float32 samples of 10 mm


def test_a_handle_that_trembles_by_the_noise_of_its_sensor_does_not_hunt():
    """1 um, an error of 1.4 mm/s in each velocity: it trembles by up to 42 um, and then hunts by 0.9 mm, a little earlier."""
    quiet, noisy = (over_compensation(paddle(hand=hl.Hand(k=20), noise=one), speed=2e-3) for one in (0.0, 1e-6))
    assert noisy.motion[noisy.dry < 0.95 * quiet.limit].max() > 1e-5
    assert 0.9 * quiet.limit < noisy.limit <= quiet.limit


def test_a_velocity_that_lags_needs_more():
    """A window has no closed form of its own, and an encoder none at all: simulated all the same."""
    rough = paddle(counts_per_metre=5e4, hand=hl.Hand(k=20))
    found = over_compensation(rough, speed="10 mm/s", velocity=hl.velocity.window(deviation="20 um", longest=8), up_to=2.5)
    assert found.limit > 1.02 * found.ideal.hunts_from(0.0)
    assert "hunts about the hand's spring above dry = 1.6048 at viscous = 0," in str(found)


def test_the_picture_has_both_and_the_limit():
    axes = over_compensation(paddle(), speed=0.002).plot().axes[0]
    assert [line.get_label() for line in axes.lines] == ["closed form", "simulated", "simulated limit"]
    assert "[m/s]" in axes.get_ylabel()


@pytest.mark.parametrize(
    ("changes", "options", "words"),
    [
        ({"coulomb": 0.0}, {}, "coulomb = 0"),
        ({}, {"viscous": 1.0}, "viscous = 1 makes the handle run away by itself;"),
        ({}, {"up_to": 0.9}, "the handle comes to rest at all values up to dry = 0.9"),
        ({"hand": hl.Hand(k=9, intent=lambda t: 0 * t)}, {}, "intent of the hand moves,"),
        ({}, {"duration": 0.01}, "wait longer"),
    ],
)
def test_what_has_no_limit_is_refused(changes, options, words):
    with pytest.raises(AnalysisError, match=words):
        over_compensation(paddle(**changes), speed=0.002, **options)
