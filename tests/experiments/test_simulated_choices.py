"""An experiment without a paddle: against the observer's own curve, and against a mistake that rewards a preference."""

import math

import numpy as np
import pytest

import hapticlab as hl


def share(bias, standard_first, level=0.1, trials=2000):
    asked = hl.people.ConstantLevels([level], repeats=trials)
    observer = hl.people.SimulatedObserver(weber=0.23, bias=bias)
    found = hl.people.simulate_choices(observer, asked, standard_first=standard_first, seed=1)
    return np.mean([trial.right for trial in found.trials])


def test_right_answers_are_as_frequent_as_the_curve_says():
    curve = hl.people.SimulatedObserver(weber=0.23).curve()
    for level in (0.05, 0.2, 0.4):
        assert share(0.0, False, level) == pytest.approx(float(curve(level)), abs=3 * 0.5 / math.sqrt(2000))


def test_a_preference_for_second_looks_sensitive_where_the_standard_always_comes_first():
    sigma = math.sqrt(2) * math.log(1.23)
    wrong = 0.5 * math.erfc(-(0.1 + 0.2) / sigma / math.sqrt(2))  # Phi of level and bias over the noise of two
    assert share(0.2, True) == pytest.approx(wrong, abs=0.03)
    assert share(0.2, False) < 0.65


def test_it_returns_what_a_forced_choice_returns():
    stairs = hl.people.UpDown(first=math.log(2))
    found = hl.people.simulate_choices(hl.people.SimulatedObserver(weber=0.23), stairs, standard=100.0, seed=2)
    assert found.estimate == stairs.estimate() and found.stopped is None
    assert all(100.0 in (trial.first, trial.second) for trial in found.trials)
    assert found.fit(slope=1.0, lapse=0.0).curve.threshold > 0
    stuck = hl.people.UpDown(first=0.01, most_trials=3)
    assert "3 trials" in hl.people.simulate_choices(hl.people.SimulatedObserver(weber=0.23), stuck).stopped
    with pytest.raises(hl.errors.AnalysisError, match="SimulatedObserver"):
        hl.people.simulate_choices("nobody", stairs)
