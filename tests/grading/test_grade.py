"""A submission earns what its honest part earns, and the report says of the rest what was wrong."""

import json
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from attacks.small_lab import HONEST, OPEN, write_lab

from hapticlab.course.evaluate import Outcome
from hapticlab.errors import CourseError
from hapticlab.grading.assignment import find_assignment
from hapticlab.grading.formats import write
from hapticlab.grading.grade import Deferred, grade
from hapticlab.grading.handed_in.replies import Garbage, outcomes_of, rounded, text_of
from hapticlab.grading.handed_in.submission import Submission
from hapticlab.grading.marking import Found, exercise_report
from hapticlab.grading.sessions.limits import Limits

LIMITS = Limits(seconds=4.0)
ENDED = {"energy": "import os\ndef energy(x, k):\n    os._exit(0)"}
#: looks for givens in the frames above, keeps them in a file for the next, and tells all in words, prints, values and cells
SPY = """
import pathlib, sys, hapticlab.grading.inside.session as session
from hapticlab.course.evaluate import Outcome, evaluate as honest
kept = pathlib.Path("givens")
def spied(kind, answer, given):
    frame = sys._getframe()
    while "request" not in frame.f_locals:
        frame = frame.f_back
    with kept.open("a") as file:
        print(frame.f_locals["request"]["givens"], file=file)
    told = kept.read_text()
    if kind == "function" and given["k"] in (200.0, 1000.0, 8.0):
        found = honest(kind, answer, given)
        return Outcome(found.value, told, told)
    return Outcome(told if kind == "choice" else 1.5, told, told)
session.evaluate = spied
raise ValueError(kept.read_text() if kept.exists() else "nothing yet")
"""
WRONG = {"force": "def force(x, k):\n    print('at', x)\n    return k * x"}


@pytest.fixture(scope="module")
def assignment(tmp_path_factory):
    lab, answers = write_lab(tmp_path_factory.mktemp("course"))
    return find_assignment(lab, answers.parent, seed=7)


@pytest.fixture(scope="module")
def starter(started):
    return started("auto")


def submission(*more, **changed):
    return Submission("ada", "42_ada.ipynb", (*(HONEST | changed).values(), *more), "c0ffee")


def by_name(report):
    return {one.name: one for one in report.exercises}


def test_honest_work_earns_all_though_another_cell_never_ends(assignment, starter):
    report = grade(submission("while True: pass"), assignment, starter, LIMITS)
    assert (report.earned, report.points) == (10.0, 10.0)
    found = by_name(report)
    assert all(one.right == one.cases > 0 for one in report.exercises if one.points)
    assert found["guess"].text == "1000 N/m" and found["discussion"].text.startswith("The held force")
    assert found["force"].cases == 4 and not found["force"].words


def test_an_answer_that_only_the_whole_notebook_has_is_found(assignment, starter):
    report = grade(submission("exec('stiff' + 'ness = 731.25')", stiffness="stiffness = 1.0"), assignment, starter, LIMITS)
    assert report.earned == 10.0


def test_what_is_wrong_is_told_with_its_first_case(assignment, starter):
    report = grade(submission("1 / 0", stiffness="stiffness = 73.0", **WRONG), assignment, starter, LIMITS)
    assert report.earned == 7.0
    force, stiffness = by_name(report)["force"], by_name(report)["stiffness"]
    assert force.slip == "You forgot x_o." and force.words == "2.4 N, expected 0.4 N. You forgot x_o." and force.hint
    assert (force.failing.given, force.failing.value, force.failing.expected) == ({"x": 0.012, "k": 200.0}, 2.4, 0.4)
    assert force.failing.public
    assert stiffness.failing.value == 73.0 and stiffness.failing.expected is None, "the answer itself is not told"
    assert [(cell, words.split(":")[0].split()[0]) for cell, words in report.cells] == [(len(HONEST) + 1, "ZeroDivisionError")]
    assert force.printed.split() == ["at", "0.012", "at", "0.008"], "givens of hidden cases are not told"
    assert str(Path.cwd()) not in report.to_json() and "/tmp" not in report.to_json()


def test_no_given_of_a_hidden_case_comes_back_to_who_may_hand_in_again(assignment, starter):
    report = grade(submission(SPY), assignment, starter, LIMITS)
    told, cases = write("gradescope", [report]), assignment.cases("ada")
    drawn = [case.given for several in cases.values() for case, public in several if not public]
    hidden = [given.get("k", given.get("values")) for given in drawn]
    assert len(hidden) == 7 and not any(str(number) in told for number in hidden)
    assert told.count("A case that is not shown is wrong.") == 3 and "'k': 200.0" in told and "nothing yet" in told
    assert not any(str(number) in json.dumps(one.slip) for one in report.exercises for number in hidden)


def test_a_public_case_is_taught_by_slips_of_the_solution_too(assignment, starter):
    report = grade(submission(wall=HONEST["wall"].replace("x(n) - x_o", "x(n)")), assignment, starter, LIMITS)
    wall = by_name(report)["wall"]
    assert wall.failing.public and "x_o" in wall.slip and wall.slip in wall.words
    assert list(assignment._public_slips) == [("wall", 0)], "worked out once for a class"


def test_the_same_submission_gives_the_same_bytes(assignment, starter):
    handed_in = submission("import os\nos._exit(3)", **WRONG, **ENDED)
    first, second = (grade(handed_in, assignment, starter, LIMITS, last=True).to_json() for _ in range(2))
    assert first == second


def test_an_exercise_or_a_cell_that_ends_its_process_costs_that_alone(assignment, starter):
    report = grade(submission("import os\nos._exit(3)", why="why = 'a'", **ENDED), assignment, starter, LIMITS)
    assert report.earned == 7.0
    assert by_name(report)["energy"].ended == "exit" and "ends the process" in by_name(report)["energy"].words
    assert report.cells == ((len(HONEST) + 1, "it ends the process it runs in"),)


def test_who_ends_the_process_of_the_next_is_no_trouble_to_it(assignment, starter):
    killer = "import os, signal\ndef force(x, k):\n    os.kill(os.getppid(), signal.SIGKILL)\n    return 1.0"
    report = grade(submission(force=killer), assignment, starter, LIMITS)
    assert report.earned == 8.0


@pytest.mark.wide
def test_a_limit_of_time_counts_only_in_the_last_turn(assignment, starter):
    slow, limits = submission(forces="def forces(x, k):\n    while True: pass"), Limits(seconds=0.6)
    report = grade(slow, assignment, starter, limits, last=True)
    assert by_name(report)["forces"].ended == "time" and "0.6 s" in by_name(report)["forces"].words
    assert grade(slow, assignment, starter, limits, last=False) == Deferred("ada")


#: an exercise whose evaluation spoils another one, which stands before or after it in the lab
SPOILERS = {
    "later": {"force": "def force(x, k):\n    globals()['why'] = 'a'\n    return k * (x - 0.01) if x >= 0.01 else 0.0"},
    "earlier": {"forces": "def forces(x, k):\n    globals()['force'] = None\n    return k * x"},
    "later, by its end": {
        "force": "import os\ndef force(x, k):\n    globals()['forces'] = lambda x, k: os._exit(1)\n    return 9.0",
    },
    "later, and is wrong itself": {"energy": "def energy(x, k):\n    globals()['forces'] = lambda x, k: -k * x\n    return 0.0"},
    "each other": {
        "force": "def force(x, k):\n    globals()['forces'] = len\n    return -1.0",
        "forces": "def forces(x, k):\n    globals()['force'] = len\n    return k * x",
    },
}


@pytest.mark.parametrize("spoiler", SPOILERS)
def test_an_answer_that_spoils_another_one_costs_that_nothing(assignment, starter, spoiler):
    report = grade(submission(**SPOILERS[spoiler]), assignment, starter, LIMITS)
    wrong = {"later, by its end": {"force"}, "later, and is wrong itself": {"energy"}, "each other": {"force"}}
    assert {one.name for one in report.exercises if one.earned < one.points} == wrong.get(spoiler, set())


class Thrown:
    """Sessions of a submission whose choice is another one in each; the rest is honest."""

    level = "none"

    def __init__(self, assignment, *choices):
        self.choices, self.sessions = iter(choices), 0
        self.right = {name: [case.expected for case, _ in cases] for name, cases in assignment.cases("ada").items()}
        self.seen = []

    @contextmanager
    def session(self, limits):
        self.sessions += 1
        self.choice = next(self.choices)
        self.charged = 0.0
        yield self

    def ask(self, request, seconds):
        if request["do"] == "evaluate":
            expected = iter(self.right.get(request["name"], ["b"]))
            value = lambda: self.choice if request["name"] == "why" else next(expected)  # noqa: E731
            return {"outcomes": [{"value": value(), "problem": "", "printed": ""} for _ in request["givens"]]}
        return {"known": True, "problem": ""}


def test_a_choice_that_is_thrown_with_a_die_must_come_twice(assignment):
    for choices, earned, sessions in (("b", 10.0, 1), ("aa", 9.0, 2), ("ac", 9.0, 2), ("abb", 10.0, 3), ("abc", 9.0, 3)):
        starter = Thrown(assignment, *choices)
        assert grade(submission(), assignment, starter, LIMITS).earned == earned, choices
        assert starter.sessions == sessions, choices


def test_what_is_wrong_in_both_orders_costs_one_run_of_the_notebook(assignment, starter):
    before, wrong = starter.sessions, {"why": "why = 'a'", "energy": "def energy(x, k):\n    return 0.0"}
    assert grade(submission(**wrong), assignment, starter, LIMITS).earned == 7.0
    assert starter.sessions - before == 2, "the quick way, and the notebook"


@pytest.mark.wide
def test_when_the_time_of_all_is_over_what_is_left_is_wrong(assignment, starter):
    cells = (*OPEN.values(), *["import time\ntime.sleep(60)"] * 40)
    report = grade(Submission("bob", "b.ipynb", cells), assignment, starter, Limits(seconds=0.3, total=1.5), last=True)
    assert report.earned == 0 and {one.ended for one in report.exercises if one.points} == {"time"}


def test_the_notebook_as_it_came_runs_in_no_whole(assignment, starter):
    report = grade(Submission("cy", "c.ipynb", tuple(OPEN.values())), assignment, starter, LIMITS)
    assert report.earned == 0 and report.cells == ()
    assert {one.words for one in report.exercises} == {"no answer"} and not any(one.answered for one in report.exercises)


def test_what_cannot_be_read_is_a_report_too(assignment, starter):
    report = grade(Submission("dan", "d.ipynb", problem="d.ipynb is no notebook"), assignment, starter, LIMITS)
    assert (report.earned, report.points, report.problem) == (0.0, 10.0, "d.ipynb is no notebook")


@pytest.mark.parametrize(
    "value",
    [[[1.0, "2"]], 10**400, {"F": [None]}, [True], {str(n): 0.0 for n in range(1001)}, [[]] * 200_001, [0] * 1_000_001],
    ids=["text in a list", "huge", "none in a list", "bool in a list", "names", "lists", "numbers"],
)
def test_a_reply_that_holds_no_plain_value_is_garbage(value):
    with pytest.raises(Garbage):
        outcomes_of({"outcomes": [{"value": value, "problem": "", "printed": ""}]}, 1, 100)


@pytest.mark.parametrize("reply", [{}, {"outcomes": []}, {"outcomes": [7]}, {"outcomes": [{"value": 1.0, "right": True}]}])
def test_a_forged_reply_is_garbage(reply):
    with pytest.raises(Garbage):
        outcomes_of(reply, 1, 100)


def test_a_nest_that_is_too_deep_is_garbage():
    nest = json.loads("[" * 400 + "]" * 400)
    with pytest.raises(Garbage):
        outcomes_of({"outcomes": [{"value": nest, "problem": "", "printed": ""}]}, 1, 100)


def test_texts_lose_what_moves_a_cursor_and_numbers_what_no_file_holds():
    assert text_of("a\x1b[2J\u202eb\ud800\nc\x00") == "a[2Jb\nc"
    assert rounded([1 / 3, float("nan"), 1e300]) == [0.333333333333, "nan", 1e300]
    assert len(rounded(list(range(5000)))) == 2000 and sum(map(len, rounded([[0.0] * 90] * 90))) <= 2000


def test_a_value_that_cannot_be_compared_is_wrong_and_stops_nothing(assignment):
    exercise = assignment.lab.exercise("forces")
    report = exercise_report(exercise, [(exercise.cases[0], True)], Found((Outcome([[[1.0]], 2.0]),)), LIMITS)
    assert (report.earned, report.right) == (0.0, 0) and report.words


def test_cases_are_a_students_own_and_keyed_by_all_they_depend_on(assignment, tmp_path):
    ada, bob = (assignment.cases(student)["energy"] for student in ("ada", "bob"))
    assert ada == assignment.cases("ada")["energy"] and ada[1:] != bob[1:] and ada[:1] == bob[:1]
    assert [public for _, public in ada] == [True, False, False]
    assert replace(assignment, seed=8).digest != assignment.digest == replace(assignment, seed=7).digest
    assert replace(assignment, answers=None).digest != assignment.digest
    assert set(assignment.files()) == set(), "neither checks.py nor the notebook"
    lab, answers = write_lab(tmp_path)
    assert find_assignment(lab, answers.parent, seed=7).digest == assignment.digest, "wherever it lies"
    (lab / "data.csv").write_text("1,2")
    changed = find_assignment(lab, answers.parent, seed=7)
    assert changed.digest != assignment.digest and changed.files() == {"data.csv": b"1,2"}


def test_an_assignment_without_answers_is_refused_before_anything_is_graded(assignment, tmp_path):
    lab, answers = write_lab(tmp_path)
    with pytest.raises(CourseError, match="contains no NN_name/solution.py"):
        find_assignment(lab, tmp_path)
    (answers / "hidden.py").write_text("cases = None")
    with pytest.raises(CourseError, match="defines no cases"):
        find_assignment(lab, answers.parent)
    (lab / "checks.py").unlink()
    with pytest.raises(CourseError, match=r"needs 42_small_wall\.ipynb and checks\.py"):
        find_assignment(lab)
