"""Two labs as assignments of a real nbgrader: made, handed out, marked, with feedback; and marks put into its gradebook."""

import csv
import importlib.util
import json
import re
import sys
from dataclasses import replace

import pytest
from hand_in import INSTRUCTOR, LABS, WRONG, earned, handed_in, run, start, text

from hapticlab.cli import main
from hapticlab.course import notebook as notebooks
from hapticlab.course.notebook import code_of, read, write
from hapticlab.errors import CourseError, EngineMissingError
from hapticlab.grading.export.gradebook import push
from hapticlab.grading.export.nbgrader_source import nbgrader_notebook
from hapticlab.grading.report import ExerciseReport, Report

if importlib.util.find_spec("nbgrader") is None:  # to import it takes two seconds of every process that collects
    pytest.skip("needs nbgrader", allow_module_level=True)
TWO = ("01", "02")
#: nbgrader needs four seconds to load: what one process can do is done in one, by the calls behind its commands
CALLS = """
import json, sys
from nbgrader.apps import NbGraderAPI
from traitlets.config.loader import PyFileConfigLoader
api = NbGraderAPI(config=PyFileConfigLoader("nbgrader_config.py").load_config())
for line in sys.stdin:
    name, *given = json.loads(line)
    print(json.dumps(getattr(api, name)(*given)), flush=True)
"""


def submit(course, lab, **several):
    for student, notebook in several.items():
        folder = course / "submitted" / student / lab.name
        folder.mkdir(parents=True)
        write(folder / lab.notebook.name, notebook)


def released(course, lab):
    return read(course / "release" / lab.name / lab.notebook.name)


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """A course with two labs released, handed in by bob, who is partly wrong, and marked."""
    course = tmp_path_factory.mktemp("nbgrader") / "haptics"
    assert main.main(["assign", str(course), "--for", "nbgrader", "--lab", *TWO, "--instructor", str(INSTRUCTOR)]) == 0
    first, second = LABS["01"], LABS["02"]
    run("nbgrader", "generate_assignment", first.name, "--create", cwd=course)  # these two as the command says
    submit(course, first, bob=handed_in(released(course, first), first, WRONG["01"]))
    run("nbgrader", "autograde", first.name, "--create", cwd=course)
    with start(sys.executable, "-c", CALLS, cwd=course) as calls:

        def call(*words):
            print(json.dumps(words), file=calls.stdin, flush=True)
            found = json.loads(calls.stdout.readline())
            assert found["success"], found["log"]

        call("generate_assignment", second.name)
        submit(course, second, bob=handed_in(released(course, second), second, WRONG["02"]))
        call("autograde", second.name, "bob")
        call("generate_feedback", second.name, "bob")
        calls.stdin.close()
    return course


def gradebook(course):
    from nbgrader.api import Gradebook

    return Gradebook(f"sqlite:///{course / 'gradebook.db'}")


def scores(course):
    """Return what the gradebook holds: (lab, student) to score."""
    with gradebook(course) as book:
        found = [one for assignment in book.assignments for one in assignment.submissions]
        return {(one.assignment.name[:2], one.student_id): one.score for one in found}


def exported(course):
    """Return what nbgrader exports: (lab, student) to score."""
    from nbgrader.plugins.export import CsvExportPlugin

    with gradebook(course) as book:
        CsvExportPlugin(to=str(course / "grades.csv")).export(book)
    with (course / "grades.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {float(row["max_score"]) for row in rows} == {10.0}
    return {(row["assignment"][:2], row["student_id"]): float(row["score"]) for row in rows}


@pytest.mark.parametrize("number", TWO)
@pytest.mark.wide
def test_what_is_released_is_the_students_notebook(course, number):
    lab = LABS[number]
    came, given = read(lab.notebook), released(course, lab)
    assert [text(cell).rstrip("\n") for cell in given["cells"]] == [text(cell).rstrip("\n") for cell in came["cells"]]
    assert (course / "release" / lab.name / "checks.py").read_bytes() == (lab.path / "checks.py").read_bytes()
    _, problems, _ = notebooks.run(code_of(given), lab.path)
    assert problems == []


@pytest.mark.wide
def test_marks_equal_what_was_right(course):
    bob = {(number, "bob"): earned(LABS[number], WRONG[number]) for number in TWO}
    assert all(0 < points < 10 for points in bob.values())
    assert scores(course) == bob


def test_a_solution_passes_every_hidden_test_and_an_open_answer_none():
    lab = LABS["02"]
    source = nbgrader_notebook(lab, INSTRUCTOR / lab.name)
    assert notebooks.run(code_of(source), lab.path)[1] == []
    tests = [number for number, cell in enumerate(code_of(source)) if "### BEGIN HIDDEN TESTS" in cell]
    opened = [re.sub(r"### BEGIN SOLUTION.*### END SOLUTION", "", cell, flags=re.S) for cell in code_of(source)]
    assert [problem.cell for problem in notebooks.run(opened, lab.path)[1]] == [number + 1 for number in tests]


@pytest.mark.wide
def test_feedback_says_what_is_wrong(course):
    lab = LABS["02"]
    page = (course / "feedback" / "bob" / lab.name / f"{lab.name}.html").read_text("utf-8")
    words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", page))
    assert "a triangle, not a rectangle" in words  # the sentence for k D^2
    assert "Score: 8.0 / 10.0" in words


def marked(student, number, **points):
    exercises = [one for one in LABS[number].lab().exercises if one.judged]
    made = [ExerciseReport(e.name, e.kind, points=e.points, earned=points.get(e.name, 0.0)) for e in exercises]
    return Report(student, number, "", "", exercises=tuple(made))


@pytest.mark.wide
def test_marks_go_over_those_of_nbgrader(course):
    before = scores(course)
    lost = push(
        [
            marked("bob", "02", held_work=1.0, period_leak=2.0),  # nbgrader gave all the others
            marked("eve", "02", bounce_gain=2.0),
            marked("zoe", "01", thousand=1.0),  # never seen here
            marked("zoe", "05"),
        ],
        course / "gradebook.db",
    )
    assert lost == ["zoe, lab 05: the gradebook has no assignment of that lab; not written"]
    changed = {("02", "bob"): 3.0, ("02", "eve"): 2.0, ("01", "zoe"): 1.0}
    everybody = {(number, student): 0.0 for number in TWO for student in ("bob", "eve", "zoe")}
    assert exported(course) == {**everybody, **before, **changed}


@pytest.mark.wide
def test_what_could_not_be_graded_changes_no_mark(course):
    push([marked("ada", "02", bounce_gain=2.0)], course / "gradebook.db")
    before = scores(course)
    lost = [replace(marked(student, "02"), problem="no JSON") for student in ("ada", "nobody")]
    assert push(lost, course / "gradebook.db") == [
        f"{student}, lab 02: could not be graded; the gradebook keeps its old entry" for student in ("ada", "nobody")
    ]
    assert scores(course) == before and before["02", "ada"] == 2.0


@pytest.mark.wide
def test_grade_puts_its_marks_into_the_gradebook(course, monkeypatch):
    push([marked("bob", "02", two_walls=2.0)], course / "gradebook.db")  # not what bob earned
    monkeypatch.chdir(course)
    asked = ["--lab", "02", "--instructor", str(INSTRUCTOR), "--gradebook", "gradebook.db", "--workers", "1"]
    assert main.main(["grade", "submitted", *asked]) == 0
    assert scores(course)["02", "bob"] == earned(LABS["02"], WRONG["02"])


@pytest.mark.wide
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


@pytest.mark.parametrize("lab", LABS.values(), ids=lambda lab: lab.name)
@pytest.mark.always("02_*", "12_*")
def test_cells_of_every_lab_are_nbgraders(lab):
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
