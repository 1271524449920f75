"""Staircases against published targets and against long runs of themselves."""

import math

import numpy as np
import pytest

from hapticlab.errors import AnalysisError
from hapticlab.experiments.response_curves import Psychometric
from hapticlab.experiments.up_down import Levels, UpDown


def walk(stairs, curve, seed, trials):
    rng = np.random.default_rng(seed)
    for chance in rng.random(trials):
        stairs.answer(bool(chance < float(curve(stairs.level))))
    return stairs


@pytest.mark.parametrize(("down", "part"), [(1, 0.5), (2, 0.707), (3, 0.794), (4, 0.841)])
def test_levitts_targets(down, part):
    assert UpDown(first=0.5, down=down).target == pytest.approx(part, abs=6e-4)


@pytest.mark.parametrize(("down", "ratio", "part"),
                         [(1, 0.2845, 0.7785), (2, 0.5488, 0.8035), (3, 0.7393, 0.8315), (4, 0.8415, 0.8584)])  # fmt: skip
def test_targets_of_unequal_steps(down, ratio, part):
    """Garcia-Perez (1998), abstract: steps down over steps up, and where they converge."""
    assert UpDown(first=0.5, down=down, weight=1 / ratio).target == pytest.approx(part, abs=6e-5)


def test_kaernbachs_weights():
    assert UpDown(first=0.5, down=1, weight=3).target == pytest.approx(0.75)


def test_steps_by_hand():
    stairs = UpDown(first=0.8, factor=2, down=2, weight=2, skip=1, reversals=3)
    told = []
    for right in (1, 1, 1, 0, 1, 1, 0):  # twice as long until the first turning point
        stairs.answer(bool(right))
        told.append(round(stairs.level, 9))
    assert told == [0.8, 0.2, 0.2, 0.8, 0.8, 0.4, 1.6]
    assert stairs.turned == pytest.approx([0.2, 0.8, 0.4]) and stairs.done
    assert stairs.estimate() == pytest.approx(math.sqrt(0.8 * 0.4))


@pytest.mark.parametrize(("down", "factor", "weight"), [(2, 1.25, 1.0), (1, 1.2, 3.0), (3, 1.5, 1.0)])
@pytest.mark.always("1-*")
def test_where_it_settles_is_where_a_long_run_turns(down, factor, weight):
    curve = Psychometric(0.2, 1.0, lapse=0.01)
    stairs = UpDown(
        first=0.2, factor=factor, down=down, weight=weight, skip=0, reversals=10**6, levels=Levels(low=0.03, high=1.0)
    )
    settled = stairs.settles(curve)
    turned = np.log(walk(stairs, curve, 5, 16_000).turned[50:])
    deviation = turned[: len(turned) // 50 * 50].reshape(50, -1).mean(axis=1).std() / math.sqrt(50)
    assert math.log(settled) == pytest.approx(turned.mean(), abs=4 * deviation)
    assert deviation < 0.025


def test_small_steps_settle_at_the_target_and_large_ones_below():
    curve = Psychometric(0.2, 1.0)
    parts = [
        float(curve(UpDown(first=0.2, factor=f, levels=Levels(low=0.02, high=1.0)).settles(curve))) for f in (1.05, 1.3, 2.0)
    ]
    assert parts[0] == pytest.approx(math.sqrt(0.5), abs=0.006)
    assert parts[0] > parts[1] > parts[2]


def test_levels_stay_within_their_range():
    stairs = UpDown(first=0.5, factor=2, levels=Levels(high=0.9, low=0.3))
    stairs.answer(False)
    assert stairs.level == 0.9
    for _ in range(10):
        stairs.answer(True)
    assert stairs.level == 0.3


@pytest.mark.parametrize(("right", "words"), [(True, "right 20 times in a row at the lowest"), (False, "wrong 20 times")])
def test_who_is_always_right_or_wrong_is_let_go(right, words):
    stairs, asked = UpDown(first=0.4, factor=2, levels=Levels(low=0.1, high=0.8)), 0
    while not stairs.done:
        stairs.answer(right)
        asked += 1
    # down 1: 0.4, 0.4 -> 0.1 in one doubled step of 4, then twenty there; up: one to 0.8, then twenty
    assert asked == (2 + 20 if right else 1 + 20) and words in stairs.gave_up
    with pytest.raises(AnalysisError, match="no estimate"):
        stairs.estimate()


def test_no_more_trials_than_said():
    stairs = UpDown(first=0.4, most_trials=9)
    for _ in range(9):
        assert not stairs.done
        stairs.answer(False)
    assert stairs.done and "0 of 12 turning points" in stairs.gave_up


def test_what_is_no_staircase_is_refused():
    for wrong in ({"factor": math.inf}, {"weight": math.inf}, {"weight": math.nan}):
        with pytest.raises(AnalysisError, match="both finite"):
            UpDown(first=0.5, **wrong)
    with pytest.raises(AnalysisError, match="low <= first <= high"):
        UpDown(first=3.0)
    for wrong in ({"high": math.inf}, {"low": 0.0}, {"low": 3.0}):
        with pytest.raises(AnalysisError, match="a staircase needs"):
            Levels(**wrong)
    with pytest.raises(AnalysisError, match="0 <= skip < reversals"):
        UpDown(first=0.5, reversals=4)
    with pytest.raises(AnalysisError, match="the estimate needs 6. Continue asking"):
        UpDown(first=0.5).estimate()
    with pytest.raises(AnalysisError, match="give per_step"):
        UpDown(first=0.5, weight=1.5).settles(Psychometric(0.2, 1.0))
