"""docs/grading.md: its commands run, its code runs, and its numbers are those of the package."""

import json
import re
import shlex
import shutil
from pathlib import Path

import numpy as np

from hapticlab.cli import _parser, main
from hapticlab.course.labs import find_labs
from hapticlab.grading.formats import FORMATS
from hapticlab.grading.limits import MIB, Limits
from hapticlab.grading.starter import LEVELS

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "grading.md").read_text("utf-8")
COMMANDS = [
    line.strip()
    for block in re.findall(r"^ *```sh\n(.*?)^ *```", PAGE, re.M | re.S)
    for line in block.strip().split("\n")
]


def test_every_command_is_understood():
    parsed = [_parser().parse_args(shlex.split(line)[1:]) for line in COMMANDS]
    assert len(parsed) >= 10
    assert {options.command.__name__ for options in parsed} == {"labs", "grade", "assign"}


def test_the_quick_start_grades_and_writes_pages(tmp_path, monkeypatch, capsys):
    (folder,) = (lab for lab in find_labs() if lab.number == "02")
    answers = tmp_path / "tests" / "instructor" / folder.name
    shutil.copytree(ROOT / "tests" / "instructor" / folder.name, answers)
    for student in ("ada", "grace"):
        (tmp_path / "submissions" / student).mkdir(parents=True)
    shutil.copy(folder.notebook, tmp_path / "submissions" / "ada")
    shutil.copy(answers / "solution.py", tmp_path / "submissions" / "grace")
    monkeypatch.chdir(tmp_path)
    command = shlex.split(COMMANDS[1])
    assert main([*command[1:], "--workers", "1"]) == 0
    assert "2 graded" in capsys.readouterr().err
    lines = (tmp_path / "grades.csv").read_text("utf-8-sig").splitlines()
    assert [line.split(",")[3] for line in lines] == ["earned", "0", "10"]
    pages = {path.relative_to(tmp_path / "pages").as_posix() for path in (tmp_path / "pages").rglob("*.html")}
    assert pages == {"class.html", "students/ada.html", "students/grace.html"}
    assert "10 of 10 points" in (tmp_path / "pages" / "students" / "grace.html").read_text("utf-8")
    assert len([*map(json.loads, (tmp_path / "grades.csv.journal.jsonl").read_text("utf-8").splitlines())]) >= 2


def test_the_code_of_a_folder_of_answers_draws(tmp_path):
    names = {}
    (code,) = re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S)
    exec(compile(code, "grading.md", "exec"), names)
    random = np.random.default_rng(5)
    drawn = {name: draw() for name, draw in names["cases"](random).items()}
    assert all(0.02 <= given["m"] <= 0.3 for given in drawn["count_step"])
    assert set(drawn["mass_equation"][0]["at"]) == {"m", "K", "b_c", "x(t)", "z"}
    assert names["numbers"](random)["K_OWN"] in (300, 400, 600)


def first_column(head):
    """Return the names in the first column of the table that begins so."""
    table = PAGE[PAGE.index(head) :].split("\n\n")[0]
    return [name for cell in re.findall(r"^\| (.*?) \|", table, re.M) for name in re.findall("`([^`]+)`", cell)]


def test_formats_levels_and_limits_are_those_of_the_package():
    assert sorted(first_column("| `--format` |")) == sorted(["--format", *FORMATS])
    assert first_column("| `--sandbox` |") == ["--sandbox", *LEVELS]
    limits, words = Limits(), " ".join(PAGE.split())
    assert f"{limits.seconds:g} s for a cell" in words
    assert f"{limits.total:g} s in all, {limits.memory // MIB} MiB (`--memory`)" in words
    assert f"{limits.processes} processes, {limits.scratch // MIB} MiB of files" in words


def test_lines_fit_a_page():
    assert [line for line in PAGE.splitlines() if len(line) > 125 and line[:1] != "|"] == []
