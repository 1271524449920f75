"""The psi method against Bayes' rule written out, and against the information in its answers."""

import math

import numpy as np
import pytest

from hapticlab.errors import AnalysisError
from hapticlab.experiments.psi import ConstantLevels, Grid, Psi
from hapticlab.experiments.response_curves import Psychometric


def small():
    return Psi(low=0.05, high=0.8, grid=Grid(levels=5, thresholds=4, slopes=(0.7, 1.4)), lapse=0.03, most_trials=9)


def test_belief_and_next_level_by_brute_force():
    psi, asked = small(), []
    for right in (True, False, True, True):
        asked.append((psi.level, right))
        psi.answer(right)
    pairs = [(a, s) for a in psi.thresholds for s in psi.slopes]

    def chance(pair, level, right):
        p = float(Psychometric(pair[0], pair[1], 0.5, 0.03)(level))
        return p if right else 1 - p

    belief = [math.prod(chance(pair, *answer) for answer in asked) for pair in pairs]
    belief = [b / sum(belief) for b in belief]
    np.testing.assert_allclose(psi.belief.ravel(), belief, rtol=1e-12)

    def entropy_left(level):
        left = 0.0
        for right in (True, False):
            joint = [b * chance(pair, level, right) for b, pair in zip(belief, pairs, strict=True)]
            some = sum(joint)
            left -= some * sum(j / some * math.log(j / some) for j in joint)
        return left

    np.testing.assert_allclose(psi.expected_entropy(), [entropy_left(a) for a in psi.levels], rtol=1e-10)
    assert psi.level == min(psi.levels, key=entropy_left)


def test_thresholds_are_found_about_as_well_as_answers_allow():
    """Errors of the logarithm over 40 observers, against Fisher's information at the best level, 60 trials each."""
    truth, errors = Psychometric(0.2, 1.0, 0.5, 0.02), []
    for seed in range(40):
        psi, rng = Psi(low=0.02, high=1.5, grid=Grid(slopes=(1.0,)), most_trials=60), np.random.default_rng(seed)
        while not psi.done:
            psi.answer(bool(rng.random() < float(truth(psi.level))))
        errors.append(math.log(psi.estimate() / 0.2))
    levels, h = np.geomspace(0.05, 1.0, 200), 1e-4
    slope = (Psychometric(0.2 * math.exp(h), 1.0, 0.5, 0.02)(levels) - truth(levels)) / h
    best = float(np.max(slope**2 / (truth(levels) * (1 - truth(levels)))))
    bound = 1 / math.sqrt(60 * best)
    rms = float(np.sqrt(np.mean(np.square(errors))))
    assert 0.75 * bound < rms < 1.5 * bound  # 40 runs tell rms to 11 %; the first answers look for the place
    assert abs(np.mean(errors)) < 3 * bound / math.sqrt(40)


def test_the_interval_holds_the_estimate():
    psi = small()
    for right in (True, False, True):
        psi.answer(right)
    low, high = psi.interval(0.9)
    assert psi.thresholds[0] <= low < psi.estimate() < high <= psi.thresholds[-1]


def test_answers_that_contradict_each_other_leave_a_belief():
    """No lapse, no guess, a slope of 20: after a right answer a wrong one is all but impossible, and not more."""
    psi = Psi(low=0.02, high=1.0, guess=0.0, lapse=0.0, grid=Grid(slopes=(20.0,)), most_trials=5)
    for right in (True, False, True, False, True):
        psi.answer(right)
    assert psi.belief.sum() == pytest.approx(1.0) and 0.02 < psi.estimate() < 1.0


def test_constant_levels_are_all_asked():
    asked = ConstantLevels([0.1, 0.2, 0.4], repeats=5, seed=2)
    seen = []
    while not asked.done:
        seen.append(asked.level)
        asked.answer(True)
    assert sorted(seen) == [0.1] * 5 + [0.2] * 5 + [0.4] * 5 and seen != sorted(seen)
    assert seen == ConstantLevels([0.1, 0.2, 0.4], repeats=5, seed=2).order


def test_what_cannot_be_asked_is_refused():
    with pytest.raises(AnalysisError, match="0 < low < high"):
        Psi(low=0.5, high=0.1)
    for wrong in ({"guess": 1.2}, {"lapse": -0.1}, {"guess": 0.5, "lapse": 0.5}, {"lapse": float("nan")}):
        with pytest.raises(AnalysisError, match="guess \\+ lapse < 1"):
            Psi(low=0.1, high=0.5, **wrong)
    with pytest.raises(AnalysisError, match="two points of each"):
        Grid(levels=1)
    with pytest.raises(AnalysisError, match="positive"):
        Psi(low=0.1, high=0.5, shape="normal")
    with pytest.raises(AnalysisError, match="one of each"):
        ConstantLevels([], repeats=1)
