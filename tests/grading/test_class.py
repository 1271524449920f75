"""What is told of a class beside its marks, before and after it is graded, and what a run hands its workers."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from attacks.small_lab import OPEN, notebook, write_lab

from hapticlab.cli.grade import _tell_walls
from hapticlab.cli.main import main
from hapticlab.device.progress import progress_bar
from hapticlab.grading.assignment import find_assignment
from hapticlab.grading.bench import Bench, Reply, Task, as_json
from hapticlab.grading.cluster import ClusterWorkers
from hapticlab.grading.grade import refused
from hapticlab.grading.handed_in.submission import Submission, find_submissions, read
from hapticlab.grading.journal import Journal, key_of
from hapticlab.grading.run import _Run
from hapticlab.grading.sessions.limits import Limits
from hapticlab.grading.sessions.starter import Walls

INSTRUCTOR = Path(__file__).parents[1] / "instructor"


@pytest.fixture
def course(tmp_path):
    lab, answers = write_lab(tmp_path)
    return find_assignment(lab, answers.parent)


def test_a_roster_that_fits_nobody_is_told_before_anything_runs(course, tmp_path, capsys):
    (tmp_path / "ada.ipynb").write_bytes(notebook(OPEN.values()))
    (tmp_path / "class.csv").write_text("id,name\nx1,Bob\n")
    command = ["grade", str(tmp_path / "ada.ipynb"), "--lab", str(course.folder.path), "-o", str(tmp_path / "out.csv")]
    assert main([*command, "--roster", str(tmp_path / "class.csv")]) == 1
    assert "'ada'" in capsys.readouterr().err
    assert not list(tmp_path.glob("out.csv*")), "no run was begun"


def test_numbers_of_another_notebook_are_told(tmp_path, capsys, here):
    (tmp_path / "ada.ipynb").write_bytes(notebook(['hl.check("02.held_work", 0)', "K_OWN = 415.0"]))
    with here():
        main(["grade", str(tmp_path / "ada.ipynb"), "--lab", "02", "--instructor", str(INSTRUCTOR), "--personal"])
    assert "warning: ada, ada.ipynb: K_OWN = 415 in the notebook, and seed 0 gave" in capsys.readouterr().err


class Crew:
    """Grades at once, and keeps what it was asked."""

    number = 2

    def __init__(self, assignment):
        self.assignment, self.asked = assignment, []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def graded(self, tasks, last):
        for task in tasks:
            self.asked.append(task.submission.student)
            yield task, Reply(refused(task.submission, self.assignment, "", Limits()))


def test_what_is_known_counts_for_nothing_in_the_time_left(course, tmp_path):
    (tmp_path / "class").mkdir()
    for student in ("ada", "bob", "cy"):
        (tmp_path / "class" / f"{student}.ipynb").write_bytes(notebook([*OPEN.values(), f"name = {student!r}"]))
    (tmp_path / "class" / "dan.ipynb").write_text("nothing")
    sources, crew = find_submissions([tmp_path / "class"], course.folder.name), Crew(course)
    known = read(next(source for source in sources if source.student == "bob"))
    with Journal(tmp_path / "j") as journal:
        journal.reports[key_of(known, course, Limits(), "auto")] = refused(known, course, "", Limits())
        with progress_bar(len(sources), shown=False) as bar:
            work = _Run(course, Limits(), "auto", journal, bar)
            work.all(sources, crew)
    assert sorted(crew.asked) == ["ada", "cy"] and len(work.reports) == 4 and work.known == 1
    assert bar.total == 2, "of four: one is known, one is no notebook"


def test_a_fault_of_the_grader_is_called_one(course, tmp_path):
    bench = Bench(replace(course, answers=tmp_path / "gone"), Limits())
    said = json.loads(bench.graded(as_json(Task(Submission("ada", "a.ipynb", ("k = 1",)), "key"), False)))
    assert said["report"] is None and said["problem"].startswith("the grader failed: ") and "gone" in said["problem"]


def test_a_worker_hides_what_this_computer_hides(course, tmp_path):
    inside = course.answers.parent / "roster.csv"
    hidden = {str(tmp_path / "handed in"), str(course.answers.parent)}
    assert set(Bench(course, Limits(), "none", (*hidden, str(inside))).hidden) == hidden, "the answers lie in one of them"
    crew = ClusterWorkers("tcp://127.0.0.1:1", course, Limits(), "none", tuple(hidden))
    assert set(json.loads(crew._setup)["hidden"]) == {*hidden, str(course.answers)}


def test_what_walls_leave_open_is_told(capsys):
    _tell_walls(Walls("none", {"namespaces": "unshare: Operation not permitted"}, "files are not hidden"))
    told = capsys.readouterr().err
    assert "warning: files are not hidden" in told and "no namespaces here: unshare: Operation not permitted" in told
