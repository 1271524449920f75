"""`hapticlab grade` as it is typed: what it refuses, what it prints where, and the code it ends with."""

import json
from pathlib import Path

import pytest
from attacks.small_lab import HONEST, notebook, write_lab

from hapticlab.cli.grade import lab_asked
from hapticlab.cli.main import main
from hapticlab.course.instructor import solved_notebook
from hapticlab.course.labs import find_labs
from hapticlab.errors import CourseError

INSTRUCTOR = Path(__file__).parents[1] / "instructor"


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    place = tmp_path_factory.mktemp("course")
    lab, answers = write_lab(place)
    (place / "class").mkdir()
    for student, why in (("ada", "b"), ("bob", "c")):
        (place / "class" / f"{student}.ipynb").write_bytes(notebook((HONEST | {"why": f'why = "{why}"'}).values()))
    (place / "class" / "cy.ipynb").write_text("{}")
    return place, ["grade", str(place / "class"), "--lab", str(lab), "--instructor", str(answers.parent), "--workers", "1"]


def test_a_class_is_graded_into_a_table_pages_and_a_code(course, here, tmp_path, capsys):
    _, command = course
    (tmp_path / "class.csv").write_text("id,name\nada,Ada\nbob,Bob\ndora,Dora\n")
    extra = ["--format", "json", "-o", str(tmp_path / "r.json"), "--pages", str(tmp_path / "pages")]
    with here():
        assert main([*command, *extra, "--roster", str(tmp_path / "class.csv")]) == 1
    told = capsys.readouterr()
    found = {one["student"]: one for one in json.loads((tmp_path / "r.json").read_text())["reports"]}
    assert {student: one["earned"] for student, one in found.items()} == {"ada": 10.0, "bob": 9.0, "cy": 0.0}
    assert "cy.ipynb" in found["cy"]["problem"] and found["ada"]["problem"] == ""
    assert sorted(path.name for path in (tmp_path / "pages").rglob("*.html")) == ["ada.html", "bob.html", "class.html", "cy.html"]
    pages = tmp_path / "pages"
    assert f"page of the class: {pages / 'class.html'}; 3 of students in {pages / 'students'}" in told.err
    assert told.out == "" and "2 graded; sandbox" in told.err and "known from before" not in told.err
    assert "not graded: cy, cy.ipynb" in told.err and "no submission of: dora" in told.err and "not in the roster: cy" in told.err
    assert "warning: without --instructor" not in told.err
    whole = (tmp_path / "r.json").read_bytes()
    assert main([*command, *extra]) == 1 and (tmp_path / "r.json").read_bytes() == whole
    assert "0 graded, 2 known from before" in capsys.readouterr().err


@pytest.mark.wide
def test_a_solved_lab_earns_all_by_public_cases_with_a_warning(here, tmp_path, capsys):
    lab = next(one for one in find_labs() if one.number == "02")
    path = tmp_path / "ada.ipynb"
    path.write_text(json.dumps(solved_notebook(lab, INSTRUCTOR / lab.name)), "utf-8")
    with here():
        assert main(["grade", str(path), "--workers", "1", "--sandbox", "none"]) == 0
    told = capsys.readouterr()
    assert told.out.startswith("ada: 10 of 10 points, lab 02")
    assert "learnt by heart" in told.err and "files are not hidden" in told.err


def test_the_lab_is_named_by_the_files_or_by_what_their_cells_check(tmp_path):
    (tmp_path / "ada").mkdir()
    cells = tmp_path / "ada" / "mine.ipynb"
    cells.write_bytes(notebook(['hl.check("07.energy", energy)']))
    assert lab_asked([cells]) == "07"
    assert lab_asked([cells.rename(tmp_path / "ada" / "03_chatter.ipynb")]) == "03"
    cells.write_bytes(notebook(['hl.check("07.energy", 1)\nhl.check("08.k", 2)']))
    with pytest.raises(CourseError, match="--lab 02"):
        lab_asked([cells])


@pytest.mark.parametrize(
    ("extra", "words"),
    [
        (["--fresh"], "--fresh forgets what is beside the results; it needs -o FILE"),
        (["--format", "canvas"], "--roster FILE.csv"),
        (["--gradebook", "nowhere.db"], "nowhere.db: no such file"),
        (["--workers", "0"], "give a whole number, 1 or greater"),
        (["--timeout", "nan"], "give a number of seconds greater than 0"),
        (["--memory", "12"], "give a whole number, 64 or greater"),
    ],
)
def test_a_wrong_command_is_refused_before_anything_runs(course, extra, words, capsys):
    with pytest.raises(SystemExit) as ended:
        main([*course[1], *extra])
    assert ended.value.code == 2 and words in capsys.readouterr().err


def test_what_is_not_there_is_said(course, capsys):
    assert main(["grade", str(course[0] / "nobody.ipynb"), "--lab", "02"]) == 1
    assert "no such file or folder" in capsys.readouterr().err
    assert main([*course[1], "--lab", "77"]) == 1
    assert "there is no lab 77" in capsys.readouterr().err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no disk that is always full")
def test_a_full_disk_is_told_with_the_name_of_the_results_and_loses_no_report(course, here, tmp_path, capsys):
    output = tmp_path / "r.json"
    output.write_text("as it was")
    (tmp_path / "r.json.part").symlink_to("/dev/full")
    with here():
        assert main([*course[1], "--format", "json", "-o", str(output)]) == 1
        assert f"cannot write {output}: No space left on device. What was graded is kept" in capsys.readouterr().err
        assert output.read_text() == "as it was"
        assert main([*course[1], "--format", "json", "-o", str(output)]) == 1
    assert "0 graded, 2 known from before" in capsys.readouterr().err
    assert len(json.loads(output.read_text())["reports"]) == 3


def test_another_seed_at_a_resumed_run_is_told(course, here, tmp_path, capsys):
    command = [*course[1], "--format", "csv", "-o", str(tmp_path / "grades.csv")]
    with here():
        for seed, told in (("3", False), ("3", False), ("33", True)):
            assert main([*command, "--seed", seed]) == 1
            said = capsys.readouterr().err
            assert ("grades.csv.journal.jsonl was used: lab, seed, answers, limits or version differ" in said) == told
    assert said.endswith("hapticlab: 3 handed in: 2 graded, 1 not graded\n")


def test_what_lies_beside_the_submissions_is_told(course, here, tmp_path, capsys):
    for name in ("ada.ipynb", "cy.ipynb"):
        (tmp_path / name).write_bytes((course[0] / "class" / name).read_bytes())
    for name in ("roster.csv", "notes.md", "cy.pdf", "dan.rar"):
        (tmp_path / name).write_bytes(b"x")
    (tmp_path / "eve").mkdir()
    with here():
        assert main([course[1][0], str(tmp_path), *course[1][2:]]) == 1
    told = capsys.readouterr()
    assert "dan: 0 of 10 points, lab 42 A small wall, dan.rar; could not be graded: dan.rar cannot be unpacked here" in told.out
    assert "not graded: eve, eve: it contains no notebook; there is nothing" in told.err
    assert "left aside, as no submission: cy.pdf, notes.md, roster.csv" in told.err
    assert told.err.endswith("hapticlab: 4 handed in: 1 graded, 3 not graded\n")


def test_two_students_of_one_row_do_not_stop_the_class(course, here, tmp_path, capsys):
    for name in ("ada", "Ada", "bob"):
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "x.ipynb").write_bytes((course[0] / "class" / "ada.ipynb").read_bytes())
    (tmp_path / "class.csv").write_text("Student,ID,Section\nada,1,A\nbob,2,A\n")
    extra = ["--roster", str(tmp_path / "class.csv"), "--format", "canvas"]
    with here():
        assert main([course[1][0], str(tmp_path / "class"), *course[1][2:], *extra]) == 0
    told = capsys.readouterr()
    assert "bob,2,A,10" in told.out and "ada" not in told.out.casefold().replace("lab 42", "")
    assert "so without a mark in its tables; rename one: Ada, ada" in told.err
