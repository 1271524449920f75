"""Hidden cases and own numbers: other for each student, the same for the same seed, expected by the solution."""

import zlib
from pathlib import Path

import numpy as np
import pytest

from hapticlab.course.constants import with_constants
from hapticlab.course.exercise import Case, Exercise, Lab
from hapticlab.course.labs import find_labs
from hapticlab.course.marks import counted_cases, hidden_cases, instructor_names, marks, own_exercises, own_numbers
from hapticlab.errors import CourseError

ANSWERS = Path(__file__).parents[1] / "instructor"
LAB = Lab("42", "Springs", 10, [
    Exercise("force", points=1, cases=[Case({"x": 0.5}, 50.0, unit="N")]),
    Exercise("k_found", "value", 2, cases=[Case({}, 100.0, unit="N/m", slips={50.0: "That is half of it."})]),
    Exercise("which", "choice", 1, options={"a": "one", "b": "two"}, cases=[Case({}, "b")]),
])  # fmt: skip
SOLUTION = """import math
K_OWN = 100.0  # "µ" [N/m]
N_OWN = -2
k_found = K_OWN
which = "b"


def force(x):
    return K_OWN * x
"""
HIDDEN = (
    "def cases(random):\n"
    "    return {'force': lambda: [{'x': random.uniform()}], 'k_found': lambda: [{}]}\n\n\n"
    "def numbers(random):\n    return {'K_OWN': 10.0 * random.integers(1, 1000), 'N_OWN': random.integers(5)}\n"
)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "solution.py").write_text(SOLUTION, "utf-8")
    (tmp_path / "hidden.py").write_text(HIDDEN, "utf-8")
    return tmp_path


def drawn(folder, **who):
    return hidden_cases(LAB, folder, **who)["force"][0].given["x"]


def test_each_student_has_cases_of_their_own(folder):
    students = ["", "ada", "bob", "Ada", "ada ", "\udcff"]
    assert len({drawn(folder, seed=seed, student=student) for student in students for seed in (0, 1)}) == 12
    assert drawn(folder, seed=3, student="ada") == drawn(folder, seed=3, student="ada")


def test_cases_of_nobody_are_as_they_always_were(folder):
    expected = np.random.default_rng([5, 42, zlib.crc32(b"force")]).uniform()
    (case,) = hidden_cases(LAB, folder, seed=5)["force"]
    assert (case.given, case.expected, case.unit) == ({"x": expected}, 100 * expected, "N")


def test_a_case_of_one_exercise_leaves_those_of_the_others(folder):
    before = drawn(folder, student="ada")
    (folder / "hidden.py").write_text(HIDDEN.replace("{'force'", "{'which': lambda: [{}], 'force'"), "utf-8")
    assert drawn(folder, student="ada") == before, "and a changed file is read anew"
    assert "which" in hidden_cases(LAB, folder, student="ada")


def test_own_numbers_are_those_of_the_solution(folder):
    numbers = own_numbers(LAB, folder, 0, "ada")
    assert numbers != own_numbers(LAB, folder, 0, "bob") and numbers == own_numbers(LAB, folder, 0, "ada")
    assert [type(numbers[name]) for name in ("K_OWN", "N_OWN")] == [float, int]
    own = hidden_cases(LAB, folder, student="ada", personal=True)
    plain = hidden_cases(LAB, folder, student="ada")
    assert own["k_found"][0].expected == numbers["K_OWN"] != 100
    assert own["force"][0].given == plain["force"][0].given
    assert own["force"][0].expected == pytest.approx(numbers["K_OWN"] * own["force"][0].given["x"], rel=1e-15)
    assert plain["k_found"][0].expected == 100
    earned = {m.exercise: m.earned for m in marks(LAB, {"k_found": numbers["K_OWN"]}, own)}
    assert earned["k_found"] == 2
    earned = {m.exercise: m.earned for m in marks(LAB, {"k_found": own_numbers(LAB, folder, 0, "bob")["K_OWN"]}, own)}
    assert earned["k_found"] == 0


def test_own_exercises_are_values_that_have_hidden_cases(folder):
    assert own_exercises(LAB, folder) == ("k_found",)
    (folder / "hidden.py").write_text(HIDDEN.partition("def numbers")[0], "utf-8")
    assert own_exercises(LAB, folder) == () and own_numbers(LAB, folder, 0, "ada") == {}
    assert hidden_cases(LAB, folder, personal=True)["k_found"][0].expected == 100


def test_the_public_case_of_a_value_does_not_count_beside_hidden_ones(folder):
    hidden = hidden_cases(LAB, folder, student="ada", personal=True)
    counted = {one.name: counted_cases(one, hidden) for one in LAB.exercises}
    assert [public for _, public in counted["force"]] == [True, False]
    assert [public for _, public in counted["k_found"]] == [False]
    assert [public for _, public in counted["which"]] == [True]
    (same,) = hidden_cases(LAB, folder)["k_found"]
    assert same.slips == ((50.0, "That is half of it."),), "the same question is answered in the same words"


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ("{'K_OWN': float('nan')}", "K_OWN = nan; it needs a finite number"),
        ("{'K_OWN': 'x'}", "K_OWN = 'x'; it needs a finite number"),
        ("{'K_OWN': True}", "K_OWN = True"),
        ("1 / 0", "numbers failed: ZeroDivisionError"),
        ("{'G_OWN': 9.81}", r"has 0 lines G_OWN = number at its top level; it needs exactly one, for 9\.81"),
    ],
)
def test_what_is_wrong_with_own_numbers_is_said(folder, numbers, words):
    text = HIDDEN.partition("def numbers")[0]
    (folder / "hidden.py").write_text(f"{text}def numbers(random):\n    return {numbers}\n", "utf-8")
    with pytest.raises(CourseError, match=words):
        hidden_cases(LAB, folder, student="ada", personal=True)


def test_constants_keep_what_stands_around_them():
    sources = ["é = 'K = 1'; K = -5.0; x = K  # K = 2", "def f():\n    K = 3\nT = 1e-3", "not Python ("]
    found = with_constants(sources, {"K": 7.25, "T": 0.002}, "x.py")
    assert found == ["é = 'K = 1'; K = 7.25; x = K  # K = 2", "def f():\n    K = 3\nT = 0.002", "not Python ("]
    with pytest.raises(CourseError, match=r"x\.py has 2 lines T"):
        with_constants(["T = 1", "T = 2"], {"T": 3}, "x.py")


@pytest.mark.parametrize("number", ["02", "05", "09"])
def test_a_solution_is_right_for_any_student_and_no_two_have_the_same_cases(number):
    folder = next(lab for lab in find_labs() if lab.number == number)
    lab, answers = folder.lab(), ANSWERS / folder.name
    hidden, others = (hidden_cases(lab, answers, 11, student) for student in ("ada", "bob"))
    right = instructor_names(answers / "solution.py")
    assert [m for m in marks(lab, right, hidden) if m.earned != m.points] == []
    drawn = [name for name in hidden if hidden[name][0].given]
    assert drawn and all([c.given for c in hidden[name]] != [c.given for c in others[name]] for name in drawn)
