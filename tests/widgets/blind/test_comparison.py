"""A blind comparison: pairs, answers, what is hidden, and a board's motor, with the page's words said by the test."""

import math
import struct

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.device.link.messages import STATES
from hapticlab.widgets.blind.comparison import BlindComparison
from hapticlab.widgets.blind.head import KINDS
from hapticlab.widgets.session import STEADY

TASK = hl.people.stiffness_task()


class Page:
    """A comparison whose page, clock and turns are the test's."""

    def __init__(self, paddle, task=TASK, procedure=None, keep=None):
        self.now = 10.0
        procedure = procedure or hl.people.UpDown(first=math.log(2), reversals=2, skip=0)
        given = {"duration": 3.0, "pause": 1.0, "clock": lambda: self.now, "in_thread": False}
        self.blind = BlindComparison(paddle, task, procedure, 3, keep, **given)
        self.session = self.blind._session
        self.session.ready("page")
        self.go(STEADY)

    def go(self, seconds):
        until = self.now + seconds
        while self.now < until - 1e-9:
            self.now += 1 / 60
            self.session.alive("page")
            self.session.turn()
        return self

    def say(self, name, value=0, late=0.0):
        self.blind._heard(None, {}, [struct.pack("<3d", KINDS.index(name), value, self.now - late)])
        return self.go(1 / 60)

    def feel(self, which, to=0.01):
        """Uncover one, move the hand there, and return how stiff it was."""
        self.say("show", which)
        began = self.session.motion.place
        self.session.intend(to)
        self.go(1.0)
        log = self.session.motion.values()
        self.say("hide")
        return log["F"] / log["x"], began


@pytest.fixture
def paddle():
    return hl.SimulatedPaddle.from_profile("hapkit", counts_per_metre=None)


def test_an_observer_who_measures_is_always_right_and_begins_each_time_in_the_middle(paddle, tmp_path):
    page = Page(paddle, procedure=hl.people.ConstantLevels([0.1, 0.5], repeats=3), keep=tmp_path / "mine.csv")
    while not page.blind.done:
        felt, began = zip(*(page.feel(which) for which in (0, 1)), strict=True)
        assert max(np.abs(began)) < 1e-3
        page.say("answer", int(felt[1] > felt[0]))
    found = page.blind.result
    assert [trial.right for trial in found.trials] == [True] * 6 and found.stopped is None
    assert {min(trial.first, trial.second) for trial in found.trials} == {200.0}
    assert {trial.first > trial.second for trial in found.trials} == {True, False}  # the order is drawn
    assert len((tmp_path / "mine.csv").read_text().splitlines()) == 7


def test_an_answer_counts_once_and_only_after_both_were_felt(paddle):
    page = Page(paddle)
    page.say("answer", 0).say("show", 1).say("answer", 1)  # the second cannot come first
    page.feel(0)
    page.say("answer", 0)
    assert page.blind.result is None
    page.feel(1)
    page.say("answer", 0).say("answer", 0).say("answer", 1)
    assert len(page.blind.result.trials) == 1 and "asks for more" in page.blind.result.stopped


def test_nothing_moves_but_what_is_shown_and_no_picture_tells_which_it_is(paddle):
    page = Page(paddle).say("alive")
    assert not page.session.motion.running
    pictures = []
    for which in (0, 1):
        page.say("show", which)
        assert page.session.motion.running
        page.session.intend(0.01)
        page.go(0.5)
        pictures.append([item[0] for item in page.session.stage.drawn(0.01)])
        page.say("hide")
        assert not page.session.motion.running
    drawn = []
    for k in (200.0, 400.0):
        page.session.set(k=k)
        page.session.motion._last |= {"x": 0.006, "x_true": 0.006, "F": 0.006 * k}
        drawn.append(repr(page.session.stage.drawn(0.01)))
    assert drawn[0] == drawn[1]
    assert pictures[0] == pictures[1] and not any("motor" in str(item) for item in page.session.stage.drawn(0.01))
    told = page.session.description()
    assert told["parameters"] == [] and [trace["name"] for trace in told["traces"]] == ["x"]


def test_a_motor_at_its_limit_is_said_for_it_hides_the_difference(paddle):
    page = Page(paddle)
    page.feel(0, to=0.01)
    assert not page.blind._state()["limited"]
    page.say("show", 1)
    page.session.intend(0.05)
    page.go(1.0).say("alive")
    assert page.blind._state()["limited"]


def test_without_a_person_a_simulated_observer_answers_the_same_each_time(paddle):
    blind = hl.people.compare_blind(paddle, TASK, seed=3)
    observer = hl.people.SimulatedObserver(weber=0.23, seed=3)
    assert blind.rehearsal == hl.people.forced_choice(paddle, TASK, observer, seed=3)
    assert blind.result is None and "not begun" in repr(blind)


def test_a_boards_motor_is_on_during_a_presentation_alone_and_never_by_a_late_press():
    hand = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch", intent=0.005))
    with hl.connect("sim://hapkit", paddle=hand) as board:
        page = Page(board, hl.people.stiffness_task(standard=100.0))

        def runs():
            return board.state()["state"] == STATES["RUN"]

        assert not runs()
        page.say("alive").say("show", 0, late=1.0).go(0.5)
        assert not runs()
        page.say("show", 0)
        assert runs()
        page.go(0.5).say("hide")
        assert not runs()
        page.say("show", 1)
        assert runs()
        page.say("answer", 1)
        assert not runs() and len(page.blind.result.trials) == 1
        with pytest.raises(hl.errors.PaddleError, match="a board has no rehearsal"):
            hl.people.compare_blind(board, TASK).rehearsal  # noqa: B018


def test_a_presentation_that_did_not_start_is_not_felt_and_the_page_is_told_to_repeat_it():
    hand = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch", intent=0.005))
    with hl.connect("sim://hapkit", paddle=hand) as board:
        page = Page(board, hl.people.stiffness_task(standard=100.0))

        def told():
            state = page.blind._state()
            return state["felt"], state["missed"]

        page.say("alive").say("show", 0, late=1.0).go(0.3).say("hide")  # the board drops a late Start
        assert told() == (0, 1)
        page.say("show", 1).go(0.3).say("hide").say("answer", 1)
        assert told() == (0, 1) and page.blind.result is None and not page.session.motion.running
        page.say("show", 0).go(0.3).say("hide")
        page.say("show", 1, late=1.0).go(0.3).say("answer", 1)
        assert told() == (1, 2) and page.blind.result is None
        page.say("show", 1).go(0.3).say("answer", 1)
        assert told() == (0, 2) and len(page.blind.result.trials) == 1


def test_what_cannot_be_compared_is_refused(paddle):
    done = hl.people.ConstantLevels([0.1], repeats=1)
    done.answer(True)
    with pytest.raises(hl.errors.AnalysisError, match="make a fresh one"):
        hl.people.compare_blind(paddle, TASK, done)
    with pytest.raises(hl.errors.AnalysisError, match="needs duration"):
        hl.people.compare_blind(paddle, TASK, duration=0.01)


def test_of_the_live_view_in_a_comparison_no_button_has_a_key(paddle):
    _, view = Page(paddle).blind._front().children
    assert view.about["keys"] is False
