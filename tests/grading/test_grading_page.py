"""docs/teaching/grading.md: its commands run, its code runs, and its numbers are those of the package."""

import json
import re
import shlex
import shutil
from pathlib import Path

import pytest

from hapticlab.cli.main import main
from hapticlab.cli.options import parser
from hapticlab.course.exercise import JUDGED, NOTED
from hapticlab.course.instructor import solved_notebook
from hapticlab.course.labs import LabFolder, find_labs
from hapticlab.course.notebook import code_of, run
from hapticlab.course.personal import personal_notebook
from hapticlab.grading.formats import FORMATS
from hapticlab.grading.sessions.limits import MIB, Limits
from hapticlab.grading.sessions.starter import LEVELS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "teaching" / "grading.md").read_text("utf-8")
COMMANDS = [
    line.strip()
    for block in re.findall(r"^ *```sh\n(.*?)^ *```", PAGE, re.M | re.S)
    for line in block.strip().split("\n")
    if line.strip().startswith("hapticlab")  # one is shown with what starts it
]


def test_every_command_is_understood():
    parsed = [parser().parse_args(shlex.split(line)[1:]) for line in COMMANDS]
    assert len(parsed) >= 10
    assert {options.command.rpartition(".")[2] for options in parsed} == {"labs", "grade", "assign"}


def test_the_quick_start_grades_and_writes_pages(here, tmp_path, monkeypatch, capsys):
    (folder,) = (lab for lab in find_labs() if lab.number == "02")
    answers = tmp_path / "tests" / "instructor" / folder.name
    shutil.copytree(ROOT / "tests" / "instructor" / folder.name, answers)
    for student in ("ada", "grace"):
        (tmp_path / "submissions" / student).mkdir(parents=True)
    shutil.copy(folder.notebook, tmp_path / "submissions" / "ada")
    shutil.copy(answers / "solution.py", tmp_path / "submissions" / "grace")
    monkeypatch.chdir(tmp_path)
    with here():
        assert main(shlex.split(COMMANDS[1])[1:]) == 0
    assert "2 graded" in capsys.readouterr().err
    lines = (tmp_path / "grades.csv").read_text("utf-8-sig").splitlines()
    assert [line.split(",")[3] for line in lines] == ["earned", "0", "10"]
    pages = {path.relative_to(tmp_path / "pages").as_posix() for path in (tmp_path / "pages").rglob("*.html")}
    assert pages == {"class.html", "students/ada.html", "students/grace.html"}
    assert "10 of 10 points" in (tmp_path / "pages" / "students" / "grace.html").read_text("utf-8")
    assert len([*map(json.loads, (tmp_path / "grades.csv.journal.jsonl").read_text("utf-8").splitlines())]) >= 2


@pytest.fixture
def own_lab(tmp_path, monkeypatch):
    """The small lab of the page, written to where the page says; the folder of the lab."""
    files = dict(re.findall(r"^`((?:mine|answers)/[^`]*)`[^\n]*\n\n```py\n(.*?)^```", PAGE, re.M | re.S))
    assert len(files) == len(re.findall("^```py$", PAGE, re.M)) == 4
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(notebook(text) if path.suffix == ".ipynb" else text, "utf-8")
    monkeypatch.chdir(tmp_path)
    return LabFolder(tmp_path / "mine" / "20_spring")


def notebook(text):
    """Return the JSON of a notebook with the cells that a page shows."""
    cell = {"cell_type": "code", "metadata": {}, "outputs": [], "execution_count": None}
    cells = [{**cell, "id": f"c{k}", "source": source.strip()} for k, source in enumerate(text.split("# %%\n")[1:])]
    return json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})


@pytest.mark.wide
def test_the_lab_of_the_page_is_graded(own_lab, here, tmp_path, capsys):
    (command,) = (shlex.split(line) for line in COMMANDS if "20_spring" in line)
    handed_in = tmp_path / command[2]
    handed_in.mkdir()
    solution = (tmp_path / "answers/20_spring/solution.py").read_text("utf-8")
    (handed_in / "ada.py").write_text(solution, "utf-8")
    slips = {"return k * x": "return -k * x", "k * handle)": "-k * handle)", '"b"': '"a"'}
    assert [solution.count(right) for right in slips] == [1, 1, 1]
    wrong = re.sub("|".join(map(re.escape, slips)), lambda found: slips[found[0]], solution)
    (handed_in / "bob.py").write_text(wrong, "utf-8")
    (handed_in / "dora.py").write_text(solution.replace("x [mm]", "x [m]").replace("1000 * handle", "handle"), "utf-8")
    (handed_in / "emil.py").write_text(solution.replace("x [mm]", "x"), "utf-8")
    shutil.copy(own_lab.notebook, handed_in / "cleo.ipynb")
    with here():
        assert main([*command[1:], "--format", "json"]) == 0
    found = {one["student"]: one for one in json.loads(capsys.readouterr().out)["reports"]}
    assert {student: one["earned"] for student, one in found.items()} == {
        "ada": 7.0, "bob": 3.0, "cleo": 0.0, "dora": 7.0, "emil": 6.0
    }  # fmt: skip
    force, _, way, stores, curve, why = found["bob"]["exercises"]
    assert curve["cases"] == 3 and curve["slip"].startswith("That is the force of the spring")
    assert "The x axis has no unit" in found["emil"]["exercises"][4]["words"]
    assert force["slip"].startswith("That is the force of the spring") and stores["slip"].startswith("What a damper takes")
    assert (force["cases"], way["cases"], way["earned"]) == (5, 1, 1.0) and why["text"].startswith("A spring that is let go")


def test_the_lab_of_the_page_checks_itself_gives_own_numbers_and_can_be_assigned(own_lab, tmp_path, capsys):
    answers = tmp_path / "answers" / "20_spring"
    cells = code_of(solved_notebook(own_lab, answers))
    checks = [cell for cell in cells if cell.startswith("hl.check")]
    names, problems, _ = run([*cells, f"judged = [{', '.join(checks)}]"], own_lab.path)
    assert problems == [] and [one.passed for one in names["judged"]] == [True] * 6
    lines = ["".join(cell["source"]) for cell in personal_notebook(own_lab, answers, 3, "ada")["cells"]]
    assert re.search(r"^K_OWN = (300|400|750)\.0", "\n".join(lines), re.M)
    assert main(["assign", "course", "--for", "nbgrader", "--lab", "mine/20_spring", "--instructor", "answers"]) == 0
    assert f"written: {Path('course', 'source', '20_spring')}" in capsys.readouterr().out


def first_column(head):
    """Return the names in the first column of the table that begins so."""
    table = PAGE[PAGE.index(head) :].split("\n\n")[0]
    return [name for cell in re.findall(r"^\| (.*?) \|", table, re.M) for name in re.findall("`([^`]+)`", cell)]


def test_formats_levels_and_limits_are_those_of_the_package():
    assert sorted(first_column("| `--format` |")) == sorted(["--format", *FORMATS])
    assert first_column("| `kind` |") == ["kind", *JUDGED, *NOTED]
    assert first_column("| `--sandbox` |") == ["--sandbox", *LEVELS]
    limits, words = Limits(), " ".join(PAGE.split())
    assert f"exercise has {limits.seconds:g} s (`--timeout`), a submission {limits.total:g} s" in words
    assert f"memory has {limits.memory // MIB} MiB (`--memory`)" in words and limits.processes == 1
    assert f"files have {limits.scratch // MIB} MiB and may be {limits.files // 1000} {limits.files % 1000:03}" in words


def test_lines_fit_a_page():
    assert [line for line in PAGE.splitlines() if len(line) > 125 and line[:1] != "|"] == []
