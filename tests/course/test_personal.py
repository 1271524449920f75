"""Labs with own numbers: handed out, answered, checked and marked."""

import json
from pathlib import Path

import pytest

import hapticlab as hl
from hapticlab.course.constants import with_constants
from hapticlab.course.labs import find_labs
from hapticlab.course.marks import hidden_cases, marks, own_numbers
from hapticlab.course.notebook import code_of, read, solved
from hapticlab.course.personal import foreign_numbers, personal_labs, personal_notebook
from hapticlab.errors import CourseError

ANSWERS = Path(__file__).parents[1] / "instructor"
WALL, COUPLER = (next(lab for lab in find_labs() if lab.number == number) for number in ("02", "06"))
#: the formulas of the book: Eq. (23.10) with the hold alone, and with a coupler in series with a wall
FORMULAS = {
    "damping_that_pays": (WALL, lambda K_OWN, T_OWN: K_OWN * T_OWN / 2),
    "longest_period": (COUPLER, lambda K_WALL, K_FELT: 2 * (0.1 - 0.02) / (K_FELT * K_WALL / (K_WALL - K_FELT))),
}


@pytest.mark.parametrize("name", FORMULAS)
@pytest.mark.always("damping_that_pays")
def test_each_student_earns_by_own_numbers_and_by_no_others(name):
    folder, formula = FORMULAS[name]
    lab, answers = folder.lab(), ANSWERS / folder.name
    values = {f"s{number}": formula(**own_numbers(lab, answers, 7, f"s{number}")) for number in range(40)}
    assert len({f"{value:.6g}" for value in values.values()}) > 25
    for student in ("s1", "s2"):
        hidden = hidden_cases(lab, answers, 7, student, personal=True)
        tried = [value for value in values.values() if abs(value / values[student] - 1) > 2e-3]
        earned = [
            mark.earned
            for value in (values[student], *tried)
            for mark in marks(lab, {name: value}, hidden)
            if mark.exercise == name
        ]
        assert earned == [1] + [0] * len(tried)


@pytest.mark.parametrize("folder", [WALL, COUPLER], ids=lambda folder: folder.number)
def test_a_personal_notebook_differs_in_its_numbers_alone(folder):
    numbers = own_numbers(folder.lab(), ANSWERS / folder.name, 7, "ada")
    plain, own = read(folder.notebook), personal_notebook(folder, ANSWERS / folder.name, 7, "ada")
    changed = [(old, new) for old, new in zip(plain["cells"], own["cells"], strict=True) if old != new]
    assert len(changed) == 1
    old, new = ("".join(cell["source"]).splitlines() for cell in changed[0])
    lines = {line.partition(" = ")[0]: line for line in new}
    assert [lines[name].partition("  #")[0] for name in numbers] == [f"{name} = {number!r}" for name, number in numbers.items()]
    assert [line for line in old if line not in new] and len(old) == len(new)
    assert personal_notebook(folder, ANSWERS / folder.name, 8, "ada") != own, "the seed is part of it"


def test_what_is_handed_out_is_checked_without_the_numbers_that_came_with_the_lab(tmp_path, monkeypatch, capsys):
    states = personal_labs(["ada", "bob"], tmp_path, ANSWERS, seed=7, only=["02", "08"])
    assert set(states.values()) == {"new"} and len(states) == 8
    assert {path.name for path in (tmp_path / "ada").iterdir()} == {"02_virtual_wall", "08_contact"}
    monkeypatch.chdir(tmp_path / "ada" / "02_virtual_wall")
    names = {}
    cell = next(cell for cell in code_of(read("02_virtual_wall.ipynb")) if "damping_that_pays = None" in cell)
    exec(cell, names)
    assert {name: names[name] for name in ("K_OWN", "T_OWN")} == own_numbers(WALL.lab(), ANSWERS / WALL.name, 7, "ada")
    assert hl.check("02.damping_that_pays", names["K_OWN"] * names["T_OWN"] / 2).passed
    assert not hl.check("02.damping_that_pays", None).passed
    assert not hl.check("02.who_pays", "a").passed
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "02.damping_that_pays: saved; it is checked when you hand it in"
    assert said[2] == "02.who_pays: not right yet (worth 1 point)"
    other = tmp_path / "ada" / "08_contact"
    for path in other.iterdir():  # without own numbers, as it came
        assert path.read_bytes() == (WALL.path.parent / other.name / path.name).read_bytes()


def test_what_a_student_wrote_stays(tmp_path):
    personal_labs(["ada"], tmp_path, ANSWERS, only=["02"])
    path = tmp_path / "ada" / WALL.name / "02_virtual_wall.ipynb"
    notebook = json.loads(path.read_text("utf-8"))
    path.write_text(json.dumps({**notebook, "cells": []}), "utf-8")
    states = personal_labs(["ada"], tmp_path, ANSWERS, only=["02"])
    assert sorted(states.values()) == ["as it came", "kept"]
    assert json.loads(path.read_text("utf-8"))["cells"] == []


@pytest.mark.parametrize("folder", [WALL, COUPLER], ids=lambda folder: folder.number)
def test_a_solution_with_the_same_numbers_adds_none(folder):
    own, answers = personal_notebook(folder, ANSWERS / folder.name, 7, "ada"), ANSWERS / folder.name
    numbers = own_numbers(folder.lab(), answers, 7, "ada")
    name = next(name for name in FORMULAS if FORMULAS[name][0] == folder)
    (solution,) = with_constants([(answers / "solution.py").read_text("utf-8")], numbers, "solution.py")
    (cell,) = (cell for cell in code_of(solved(own, solution, [name])) if f"{name} =" in cell)
    names = {}
    exec(cell, names)
    assert cell.count("\n") == len(numbers) and names[name] == pytest.approx(FORMULAS[name][1](**numbers), rel=1e-12)


@pytest.mark.parametrize(
    "student", ["", ".", "..", "a/b", "a\\b", " ada", "ada.", "nul", "COM1.txt", "a:b", "a\nb", "a\x00b", "ada\n"]
)
def test_a_name_that_can_be_no_folder_is_refused(student, tmp_path):
    with pytest.raises(CourseError, match=r"cannot be the name of a folder\. Use a login or a number"):
        personal_labs(["bob", student], tmp_path, ANSWERS)
    assert list(tmp_path.iterdir()) == [], "and nothing was written"


@pytest.mark.parametrize(
    ("others", "words"), [({"only": ["77"]}, "no answers of a lab 77"), ({"tree": "."}, "contains no NN_name")]
)
def test_labs_that_cannot_be_handed_out_are_refused(others, words, tmp_path):
    with pytest.raises(CourseError, match=words):
        personal_labs(["ada"], tmp_path, **{"tree": ANSWERS, **others})
    with pytest.raises(CourseError, match="differ only in capitals; each needs a folder name of"):
        personal_labs(["ada", "ADA"], tmp_path, ANSWERS)


def told(cells, student, seed=7, personal=True):
    return foreign_numbers(cells, WALL, ANSWERS / WALL.name, seed, student, personal)


def test_numbers_of_another_seed_or_name_are_told():
    came = code_of(read(WALL.notebook))
    ada = code_of(personal_notebook(WALL, ANSWERS / WALL.name, 7, "ada"))
    own, bobs = (own_numbers(WALL.lab(), ANSWERS / WALL.name, 7, name) for name in ("ada", "bob"))
    assert own["K_OWN"] != bobs["K_OWN"] != 500.0
    assert told(ada, "ada") == told(came, "ada", personal=False) == ""
    pair = f"K_OWN = {own['K_OWN']:g} in the notebook, and seed 7 gave 'bob' {bobs['K_OWN']:g}"
    assert told(ada, "bob") == f"{pair}: it was handed out with a different seed, or to a different name"
    assert "and seed 8 gave 'ada' 590:" in told(ada, "ada", seed=8)
    assert "the notebook that came with the lab" in told(came, "ada")
    assert "and the lab has 500. If it was handed out with personal numbers" in told(ada, "ada", personal=False)


def test_numbers_are_looked_for_as_text_and_what_is_no_number_is_let_be():
    own = own_numbers(WALL.lab(), ANSWERS / WALL.name, 7, "ada")
    right = f"K_OWN={own['K_OWN']:.3e} ;T_OWN = 2\nT_OWN\t= {own['T_OWN']!r}  # [s]"
    assert told([right, "K_OWN = 600.0"], "ada") == "", "another try further down"
    for strange in ("(" * 5000, "K_OWN = k", "K_OWN = 1 + 1", "  K_OWN = 1.0", "K_OWNER = 1.0", "K_OWN == 1.0", "K_OWN = e"):
        assert told([strange], "ada") == ""
    assert "K_OWN = 100 in" in told(["%magic (\nK_OWN = 1e2\r\n"], "ada") and "gave 'a{d}a'" in told(["K_OWN = 1"], "a{d}a")
    assert foreign_numbers(["K_OWN = 1.0"], WALL, None, 7, "ada") == "", "without answers there is nothing to tell"
    plain = next(lab for lab in find_labs() if lab.number == "08")
    assert foreign_numbers(["K_OWN = 1.0"], plain, ANSWERS / plain.name, 7, "ada") == "", "a lab without own numbers"
