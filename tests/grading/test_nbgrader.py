"""Two labs as assignments of a real nbgrader: made, handed out, marked, with feedback; and marks put into its gradebook."""

import csv
import importlib.util
import re

import pytest
from handed_in import INSTRUCTOR, LABS, WRONG, earned, handed_in, run, text

from hapticlab import cli
from hapticlab.course import notebook as notebooks
from hapticlab.course.notebook import code_of, read, write
from hapticlab.errors import CourseError, EngineMissingError
from hapticlab.grading.gradebook import push
from hapticlab.grading.nbgrader_source import nbgrader_notebook
from hapticlab.grading.report import ExerciseReport, Report

pytest.importorskip("nbgrader")
TWO = ("01", "02")


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """A course in which both labs are released, and handed in by three students: all right, partly wrong, untouched."""
    course = tmp_path_factory.mktemp("nbgrader") / "haptics"
    assert cli.main(["assign", str(course), "--for", "nbgrader", "--lab", *TWO, "--instructor", str(INSTRUCTOR)]) == 0
    for number in TWO:
        lab = LABS[number]
        run("nbgrader", "generate_assignment", lab.name, "--create", cwd=course)
        released = read(course / "release" / lab.name / lab.notebook.name)
        bob = handed_in(released, lab, WRONG[number])
        for student, given in (("ada", handed_in(released, lab)), ("bob", bob), ("eve", released)):
            folder = course / "submitted" / student / lab.name
            folder.mkdir(parents=True)
            write(folder / lab.notebook.name, given)
        run("nbgrader", "autograde", lab.name, "--create", cwd=course)
    return course


def scores(course):
    """Return what nbgrader exports: (lab, student) to score, and the greatest score of each."""
    run("nbgrader", "export", "--to", "grades.csv", cwd=course)
    with (course / "grades.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {float(row["max_score"]) for row in rows} == {10.0}
    return {(row["assignment"][:2], row["student_id"]): float(row["score"]) for row in rows}


@pytest.mark.parametrize("number", TWO)
def test_what_is_released_is_the_students_notebook(course, number, tmp_path):
    lab = LABS[number]
    came, released = read(lab.notebook), read(course / "release" / lab.name / lab.notebook.name)
    assert [text(cell).rstrip("\n") for cell in released["cells"]] == [text(cell).rstrip("\n") for cell in came["cells"]]
    assert (course / "release" / lab.name / "checks.py").read_bytes() == (lab.path / "checks.py").read_bytes()
    _, problems = notebooks.run(code_of(released), lab.path)
    assert problems == []


def test_marks_equal_what_was_right(course):
    expected = {}
    for number in TWO:
        expected |= {(number, "ada"): 10.0, (number, "bob"): earned(LABS[number], WRONG[number]), (number, "eve"): 0.0}
    assert {0 < points < 10 for (_, student), points in expected.items() if student == "bob"} == {True}
    assert scores(course) == expected


def test_feedback_says_what_is_wrong(course):
    lab = LABS["02"]
    run("nbgrader", "generate_feedback", lab.name, "--student", "bob", cwd=course)
    page = (course / "feedback" / "bob" / lab.name / f"{lab.name}.html").read_text("utf-8")
    words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", page))
    assert "a triangle, not a square" in words  # the sentence for k D^2
    assert "Score: 8.0 / 10.0" in words


def marked(student, number, **points):
    exercises = [one for one in LABS[number].lab().exercises if one.judged]
    made = [ExerciseReport(e.name, e.kind, points=e.points, earned=points.get(e.name, 0.0)) for e in exercises]
    return Report(student, number, "", "", exercises=tuple(made))


def test_marks_go_over_those_of_nbgrader(course):
    before = scores(course)
    lost = push(
        [
            marked("ada", "02", held_work=1.0, two_walls=2.0),  # nbgrader gave all
            marked("eve", "02", bounce_gain=2.0),  # nbgrader gave nothing
            marked("zoe", "01", thousand=1.0),  # never seen here
            marked("zoe", "05"),
        ],
        course / "gradebook.db",
    )
    assert lost == ["zoe, lab 05: the gradebook has no assignment of that lab; not written"]
    changed = {("02", "ada"): 3.0, ("02", "eve"): 2.0, ("01", "zoe"): 1.0, ("02", "zoe"): 0.0}
    after = scores(course)
    assert {key: after[key] for key in before if key not in changed} == {k: v for k, v in before.items() if k not in changed}
    assert {key: after[key] for key in changed if key in after} == {k: v for k, v in changed.items() if k in after}
    assert ("01", "zoe") in after


def test_an_exercise_without_a_cell_is_told(course):
    extra = ExerciseReport("new_one", "value", points=1.0, earned=1.0)
    report = Report("bob", "01", "", "", exercises=(*marked("bob", "01", thousand=1.0).exercises, extra))
    name = LABS["01"].name
    assert push([report], course / "gradebook.db", name) == [f"bob, lab 01: {name} has no cell for new_one; not written"]


def test_push_needs_a_gradebook_and_nbgrader(tmp_path, monkeypatch):
    with pytest.raises(CourseError, match="gradebook.db: no such file; name the gradebook.db of a course"):
        push([], tmp_path / "gradebook.db")
    assert not (tmp_path / "gradebook.db").exists()
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(EngineMissingError, match="pip install nbgrader"):
        push([], tmp_path / "gradebook.db")


def test_cells_of_every_lab_are_nbgraders():
    for lab in LABS.values():
        notebook = nbgrader_notebook(lab, INSTRUCTOR / lab.name)
        marked = [cell["metadata"]["nbgrader"] for cell in notebook["cells"] if "nbgrader" in cell["metadata"]]
        ids = [one["grade_id"] for one in marked]
        assert len(set(ids)) == len(ids) and all(re.fullmatch(r"[a-zA-Z0-9_\-]+", name) for name in ids)
        graded = {one["grade_id"]: one["points"] for one in marked if one["grade"]}
        judged = {f"check-{one.name}": one.points for one in lab.lab().exercises if one.judged}
        by_hand = {one.name: 0 for one in lab.lab().exercises if one.kind == "text"}
        assert graded == judged | by_hand
        assert {one["grade_id"] for one in marked if one["locked"]} == set(judged)
        predictions = {one.name for one in lab.lab().exercises if one.kind == "prediction"}
        assert predictions.isdisjoint(graded)
