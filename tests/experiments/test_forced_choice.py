"""Whole experiments on a simulated paddle, on a simulated board, and with a scripted person."""

import csv
import math
from dataclasses import replace

import numpy as np
import pytest

from hapticlab.device.setup.connect import connect
from hapticlab.device.setup.person import Person
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import AnalysisError
from hapticlab.experiments.forced_choice import ForcedChoice, Trial, forced_choice
from hapticlab.experiments.observers import SimulatedObserver
from hapticlab.experiments.psi import ConstantLevels, Grid, Psi
from hapticlab.experiments.psychometric import Intervals
from hapticlab.experiments.tasks import damping_task, stiffness_task, texture_task
from hapticlab.experiments.up_down import Levels, UpDown
from hapticlab.scene.laws.chapter_laws import wall

PADDLE = SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
QUICK = replace(stiffness_task(), duration=0.3)


class Remembering(SimulatedObserver):
    """Keeps what it felt."""

    def compare(self, task, logs, trial):
        felt.append([task.felt(log) for log in logs])
        return super().compare(task, logs, trial)


felt = []


def test_the_recorded_force_decides():
    """Both presentations are what the trial says, each stands first about as often, and seeds repeat."""
    felt.clear()
    asked = [ConstantLevels([0.2, 0.6], repeats=6, seed=1) for _ in range(2)]
    found = forced_choice(PADDLE, QUICK, Remembering(weber=0.01), asked[0], seed=5)
    shown = np.array([[t.first, t.second] for t in found.trials])
    np.testing.assert_allclose(felt, shown, rtol=1e-6)
    assert all(t.right for t in found.trials)  # differences of 18 and more standard deviations
    first = [t.first > t.second for t in found.trials]
    assert 2 <= sum(first) <= 10
    assert forced_choice(PADDLE, QUICK, SimulatedObserver(weber=0.01), asked[1], seed=5).trials == found.trials


@pytest.mark.parametrize("task", [QUICK, replace(damping_task(), duration=0.5), replace(texture_task(), duration=0.5)],
                         ids=lambda task: task.name)  # fmt: skip
@pytest.mark.always("damping")
def test_the_observers_weber_fraction_comes_back(task):
    observer = SimulatedObserver(weber=0.2, seed=2)
    found = forced_choice(PADDLE, task, observer, Psi(low=0.03, high=1.0, grid=Grid(slopes=(1.0,)), most_trials=25))
    assert math.log(found.estimate / math.log(1.2)) == pytest.approx(0.0, abs=0.9)  # 25 trials: deviation 0.32
    value, low, high = found.weber(slope=1.0, lapse=0.0, intervals=Intervals(bootstrap=100))
    assert low < 0.2 < high and low < value < high


@pytest.mark.slow
def test_a_long_experiment_measures_the_weber_fraction():
    asked = ConstantLevels(np.geomspace(0.05, 0.6, 6), repeats=100)
    found = forced_choice(PADDLE, QUICK, SimulatedObserver(weber=0.2, seed=7), asked)
    value, low, high = found.weber(slope=1.0, lapse=0.0)
    assert low < 0.2 < high and value == pytest.approx(0.2, rel=0.15)


def test_a_staircase_ends_by_itself():
    found = forced_choice(PADDLE, QUICK, procedure=UpDown(first=0.6, reversals=4, skip=0, factor=2))
    assert 5 < len(found.trials) < 40 and found.stopped is None
    assert "2 down, 1 up" in str(found) and "difference threshold" in str(found)
    assert [a.get_ylabel() for a in found.plot().axes] == ["difference in stiffness [%]"]


def test_on_a_board_the_motor_is_off_while_the_observer_is_asked():
    paddle = replace(SimulatedPaddle.from_profile("hapkit"), hand=QUICK.hand)
    duties = []
    with connect("sim://hapkit", paddle=paddle) as board:

        class Watching(SimulatedObserver):
            def ready(self, task, which):
                duties.append(board.exchange.port.board.duty)

            def told(self, right):
                duties.append(board.exchange.port.board.duty)

        found = forced_choice(board, replace(QUICK, duration=0.5), Watching(weber=0.02), ConstantLevels([0.5], repeats=3))
    assert len(duties) == 9 and set(duties) == {0.0}
    assert [t.right for t in found.trials] == [True] * 3 and found.stopped is None
    assert "host" in found.paddle


def test_a_fault_ends_it_and_keeps_what_was_answered():
    unstable = replace(QUICK, scene=wall(unilateral=None)(x_o=0), standard=1e35)
    found = forced_choice(PADDLE, unstable, SimulatedObserver(weber=0.1), ConstantLevels([0.5], repeats=3))
    assert found.trials == () and found.estimate is None
    assert "not finite" in found.stopped and "presentation" in found.stopped and "ended early" in str(found)


def test_who_feels_nothing_keeps_what_was_answered():
    class Numb(SimulatedObserver):
        def compare(self, task, logs, trial):
            if trial == 2:
                raise AnalysisError("nothing was felt: the hand never touched the wall")
            return super().compare(task, logs, trial)

    found = forced_choice(PADDLE, QUICK, Numb(weber=0.1), ConstantLevels([0.5], repeats=5))
    assert len(found.trials) == 2 and found.estimate is None and "nothing was felt" in str(found)


def test_no_answers_are_not_plotted():
    nothing = ForcedChoice("stiffness", "k", "N/m", 200.0, (), None, "a staircase", "somebody", "a paddle", 0, "felt nothing")
    with pytest.raises(AnalysisError, match="nothing to plot; it ended early: felt nothing"):
        nothing.plot()


def test_who_is_always_right_comes_to_an_end():
    found = forced_choice(PADDLE, QUICK, SimulatedObserver(weber=1e-9), UpDown(first=0.5, factor=2, levels=Levels(low=0.4)))
    assert len(found.trials) == 22 and found.estimate is None and "lowest level" in found.stopped


def test_every_trial_is_on_the_disk_at_once(tmp_path):
    path = tmp_path / "trials.csv"

    class Leaving(SimulatedObserver):
        def compare(self, task, logs, trial):
            if trial == 2:
                raise KeyboardInterrupt
            return super().compare(task, logs, trial)

    with pytest.raises(KeyboardInterrupt):
        forced_choice(PADDLE, QUICK, Leaving(weber=0.1), ConstantLevels([0.5], repeats=5), keep=path)
    rows = list(csv.reader(path.read_text().splitlines()))
    assert rows[0] == ["level [1]", "first [N/m]", "second [N/m]", "answer", "right"] and len(rows) == 3


def test_results_go_to_files_and_back(tmp_path):
    found = ForcedChoice("stiffness", "k", "N/m", 200.0, (Trial(0.1, 200.0, 221.0, "second", True),), 0.12, "psi", "me", "p", 3)
    assert ForcedChoice.load(found.save(tmp_path / "a.json")) == found
    rows = list(csv.reader(found.to_csv(tmp_path / "a.csv").read_text().splitlines()))
    assert rows[1] == ["0.1", "200.0", "221.0", "second", "1"]
    (tmp_path / "b.json").write_text("[]")
    with pytest.raises(AnalysisError, match=r"result\.save"):
        ForcedChoice.load(tmp_path / "b.json")


def test_a_person_answers_in_their_own_words():
    said = []

    class Scripted(Person):
        def say(self, text):
            said.append(text)

        def ask(self, question):
            said.append(question)
            return "" if "Enter" in question else "f"

    asked = ConstantLevels([0.5], repeats=4)
    found = forced_choice(PADDLE, QUICK, Scripted(), asked, seed=1)
    assert {t.answer for t in found.trials} == {"first"}
    assert [t.right for t in found.trials] == [t.first > t.second for t in found.trials]
    assert sum("hold the handle" in text for text in said) == 8 and found.observer == "a person"
    with pytest.raises(AnalysisError, match="new one"):
        forced_choice(PADDLE, QUICK, Scripted(), asked)


def test_what_is_no_task_or_observer_is_refused():
    with pytest.raises(AnalysisError, match="stiffness_task"):
        forced_choice(PADDLE, "stiffness")
    with pytest.raises(AnalysisError, match="SimulatedObserver"):
        forced_choice(PADDLE, QUICK, "me")
