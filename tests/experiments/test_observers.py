"""The simulated observer against the curve that signal detection theory gives it."""

import math

import numpy as np
import pytest

from hapticlab.device.setup.person import Person
from hapticlab.errors import AnalysisError
from hapticlab.experiments.observers import PersonObserver, SimulatedObserver
from hapticlab.experiments.tasks import stiffness_task

TRIALS = 3000


def part_right(observer, ratio, trials=TRIALS):
    """How often the stronger of two is told, first and second in turn."""
    told = [
        observer.decide((ratio, 1.0) if k % 2 else (1.0, ratio), k) == ("first" if k % 2 else "second") for k in range(trials)
    ]
    return float(np.mean(told))


@pytest.mark.parametrize("ratio", [1.05, 1.2, 1.5])
@pytest.mark.always("1.2")
def test_answers_follow_the_curve(ratio):
    observer = SimulatedObserver(weber=0.2, lapse=0.06, seed=4)
    expected = 0.94 * 0.5 * math.erfc(-math.log(ratio) / (2 * math.log(1.2))) + 0.03
    assert part_right(observer, ratio) == pytest.approx(expected, abs=4 * math.sqrt(0.25 / TRIALS))
    assert float(observer.curve()(math.log(ratio))) == pytest.approx(expected, rel=1e-12)


def test_only_the_ratio_matters_and_the_seed_decides():
    one, same, other = (SimulatedObserver(weber=0.2, seed=s) for s in (1, 1, 2))
    pairs = [(1.0, 1.1), (7.0, 7.7)]
    told = [[o.decide(pair, k) for k in range(60)] for o in (one, same, other) for pair in pairs]
    assert told[0] == told[1] == told[2] != told[4]


def test_a_bias_moves_the_answers():
    biased = SimulatedObserver(weber=0.2, bias=math.log(1.2), seed=3)
    seconds = np.mean([biased.decide((1.0, 1.0), k) == "second" for k in range(TRIALS)])
    # the difference of two samples of deviation sigma exceeds -sigma: Phi(1/sqrt(2))
    assert seconds == pytest.approx(0.5 * math.erfc(-0.5), abs=4 * math.sqrt(0.25 / TRIALS))


def test_a_person_is_asked_and_told():
    said, answers = [], iter(["", "first"])

    class Scripted(Person):
        def say(self, text):
            said.append(text)

        def ask(self, question):
            said.append(question)
            return next(answers)

    observer = PersonObserver(Scripted(), feedback=True)
    observer.ready(stiffness_task(), "first")
    assert observer.compare(stiffness_task(), [], 0) == "first"
    observer.told(False)
    assert "First one: hold the handle" in said[0] and "Which wall was stiffer?" in said[1] and said[-1] == "wrong"


def test_who_is_no_observer_is_refused():
    with pytest.raises(AnalysisError, match="weber > 0"):
        SimulatedObserver(weber=0.0)
    with pytest.raises(AnalysisError, match="magnitudes > 0"):
        SimulatedObserver(weber=0.1).decide((0.0, 1.0), 0)
