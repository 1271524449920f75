"""Solutions written into notebooks, notebooks run, marks given with hidden cases."""

import pytest

from hapticlab.course.exercise import Case, Exercise, Lab
from hapticlab.course.instructor import mark_notebook, solved_notebook
from hapticlab.course.labs import LabFolder, find_lab, find_labs
from hapticlab.course.marks import hidden_cases, marks
from hapticlab.course.notebook import code_of, places, read, run, solved, write
from hapticlab.errors import CourseError

CHECKS = """
from hapticlab.course.exercise import Case, Exercise, Lab
LAB = Lab("77", "Springs", 10, (
    Exercise("force", points=2, asks="a force", cases=[Case({"k": 2.0, "x": 3.0}, 6.0, unit="N")]),
    Exercise("stored", points=1, asks="an energy", cases=[Case({"k": 2.0, "x": 3.0}, 9.0, unit="J")]),
    Exercise("who", "choice", 1, options={"a": "A", "b": "B"}),
    Exercise("prediction", "prediction"),
))
"""
SOLUTION = '''"""Answers."""

import math
from functools import (
    partial,
)

half = 0.5  # of the square


def _square(x):
    return math.pow(x, 2)


@partial
def stored(k, x):
    return half * k * _square(x)  # J


who = "b"


def force(k, x):
    """F = k x."""
    return k * x


tail = 1
'''
HIDDEN = """
def cases(random):
    given = lambda: {"k": float(random.uniform(1, 2)), "x": float(random.uniform(1, 2))}
    return {"force": lambda: [given(), given()], "stored": lambda: [given()], "who": lambda: [{}]}
"""
CELLS = [
    "half = 3",
    "def force(k, x):\n    '''words'''\n    raise NotImplementedError('later')\n\n# kept\ny = half",
    "%magic is no Python",
    "# how much\nprediction = None  # J\nother = None\nwho = ''",
    "1 / 0",
    "def stored(k, x):\n    raise NotImplementedError\nz = 1",
]


def notebook(*sources):
    cells = [{"cell_type": "markdown", "id": "m", "metadata": {}, "source": ["def force: no code"]}]
    cells += [{"cell_type": "code", "id": f"c{i}", "metadata": {}, "outputs": [], "source": s} for i, s in enumerate(sources)]
    return {"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}


@pytest.fixture
def folder(tmp_path):
    lab, answers = tmp_path / "labs" / "77_springs", tmp_path / "instructor" / "77_springs"
    for place in (lab, answers):
        place.mkdir(parents=True)
    (lab / "checks.py").write_text(CHECKS)
    write(lab / "77_springs.ipynb", notebook(*CELLS))
    (answers / "solution.py").write_text(SOLUTION)
    (answers / "hidden.py").write_text(HIDDEN)
    return find_labs(tmp_path / "labs")[0], answers


def test_solutions_go_where_the_names_are_with_what_they_need_and_nothing_else(folder):
    lab, answers = folder
    cells = code_of(solved_notebook(lab, answers))
    assert cells == [
        "half = 3",
        "import math\nfrom functools import (\n    partial,\n)",
        'def force(k, x):\n    """F = k x."""\n    return k * x\ntail = 1\n\n# kept\ny = half',
        "%magic is no Python",
        '# how much\nprediction = None  # J\nother = None\nwho = "b"',
        "1 / 0",
        "half = 0.5  # of the square\ndef _square(x):\n    return math.pow(x, 2)\n"
        "@partial\ndef stored(k, x):\n    return half * k * _square(x)  # J\nz = 1",
    ]  # fmt: skip
    assert code_of(read(lab.notebook)) == CELLS


def test_sources_in_lines_as_jupyter_writes_them_are_the_same():
    lines = notebook(*CELLS)
    for cell in lines["cells"]:
        cell["source"] = "".join(cell["source"]).splitlines(keepends=True)
    names = ["force", "stored"]
    assert code_of(solved(lines, SOLUTION, names)) == code_of(solved(notebook(*CELLS), SOLUTION, names))


def test_a_solution_without_a_place_is_refused():
    with pytest.raises(CourseError, match="no place for stored"):
        solved(notebook(*CELLS[:-1]), SOLUTION, ["force", "stored"])


def test_what_the_student_must_not_change_is_not_replaced():
    source = "tail = 5\nfor i in range(2):\n    force = None\nforce: float = None\na = force = None"
    assert code_of(solved(notebook(source), "tail = 1\nforce = 2", [])) == [source]


def test_a_cell_that_fails_stops_none_after_it(tmp_path):
    names, problems, printed = run(
        ["a = 1", "1 / 0", "print('kept'); b = a + 1", "def", "raise SystemExit", "c = __name__"], tmp_path
    )
    assert (names["a"], names["b"], names["c"]) == (1, 2, "__main__")
    raised = [(p.cell, p.words.split(":")[0]) for p in problems]
    assert raised == [(2, "ZeroDivisionError"), (4, "SyntaxError"), (5, "SystemExit")]
    assert printed == "kept\n"


def test_marks_need_the_hidden_cases_too(folder):
    lab, answers = folder
    solution = mark_notebook(lab, solved_notebook(lab, answers), answers)
    assert [(m.exercise, m.earned, m.right, m.cases) for m in solution.marks] == [
        ("force", 2, 3, 3), ("stored", 1, 2, 2), ("who", 1, 1, 1),
    ]  # fmt: skip
    assert solution.earned == 4
    assert [p.cell for p in solution.problems] == [4, 6]  # those of the notebook itself
    untouched = mark_notebook(lab, read(lab.notebook), answers)
    assert untouched.earned == 0
    assert {m.right for m in untouched.marks} == {0}
    by_heart = notebook("def force(k, x): return 6.0\ndef stored(k, x): return 9.0")
    assert mark_notebook(lab, by_heart, answers).earned == 0
    assert sum(m.earned for m in marks(lab.lab(), run(code_of(by_heart), lab.path)[0])) == 3


def test_hidden_cases_are_those_of_their_seed(folder):
    lab, answers = folder
    drawn = [hidden_cases(lab.lab(), answers, seed) for seed in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    case = drawn[0]["force"][0]
    assert case.expected == case.given["k"] * case.given["x"] and case.unit == "N"
    (answers / "hidden.py").write_text(HIDDEN.replace("given(), given()", "given(), given(), given()"))
    more = hidden_cases(lab.lab(), answers, 1)
    assert more["force"][:2] == drawn[0]["force"] and more["stored"] == drawn[0]["stored"]


def test_places_are_found_by_name_wherever_the_cells_are(folder):
    lab, _ = folder
    stored = 'x = 1\nagain = hl.check(\n    "77.stored", stored)'
    cells = [*CELLS, "hl.check('77.force', force)", stored, "def force(): 'again'"]
    assert [(p.exercise, p.answer, p.check) for p in places(notebook(*cells), lab.lab())] == [
        ("force", "c1", "c6"), ("stored", "c5", "c7"), ("who", "c3", None), ("prediction", "c3", None),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("file", "text", "words"),
    [
        ("hidden.py", "", "defines no cases"),
        ("hidden.py", "def cases(random): return 1 / 0", "hidden.py: cases failed: ZeroDivisionError"),
        ("solution.py", "def force(", "solution.py failed: SyntaxError"),
        ("hidden.py", "def cases(random): return {'nothing': lambda: [{}]}", "has no exercise nothing; it has force, stored"),
        (
            "hidden.py",
            "def cases(random): return {'force': [{}]}",
            "each exercise needs a function of its own, 'exercise': lambda:",
        ),
        ("hidden.py", "raise SystemExit(1)", "hidden.py failed: SystemExit"),
        ("solution.py", "def force(k, x): return 1 / 0", "force: the solution gives no value .*: it raises ZeroDivisionError"),
        ("solution.py", "", "force: the solution gives no value for .*: it has no answer"),
    ],
)
def test_an_instructor_is_told_what_is_missing(folder, file, text, words):
    lab, answers = folder
    (answers / file).write_text(text)
    with pytest.raises(CourseError, match=words):
        mark_notebook(lab, solved_notebook(lab, answers), answers)
    (answers / file).unlink()
    with pytest.raises(CourseError, match=rf"{file}: no such file"):
        hidden_cases(lab.lab(), answers)


def test_checks_beside_the_notebook_come_before_those_of_the_package(folder):
    lab, _ = folder
    assert find_lab("77", beside=lab.path).title == "Springs"
    with pytest.raises(CourseError, match="there is no lab 77"):
        find_lab("77")
    (lab.path / "checks.py").write_text(CHECKS.replace("77", "01"))
    with pytest.raises(CourseError, match="LAB has number '01'; its folder begins with 77"):
        lab.lab()
    (lab.path / "checks.py").write_text("1 / 0")
    with pytest.raises(CourseError, match=r"checks.py failed: ZeroDivisionError"):
        LabFolder(lab.path).lab()
    (lab.path / "checks.py").write_text("LAB = 1")
    with pytest.raises(CourseError, match="defines no LAB"):
        LabFolder(lab.path).lab()


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: Exercise("a b"), "needs the name of a Python variable"),
        (lambda: Exercise("a", "essay"), "needs one of function, scene"),
        (lambda: Exercise("a", "text", points=1), "saved, not marked"),
        (lambda: Exercise("a", "choice", options={"a": ""}, cases=[Case({}, "b")]), "'b' is not one of the options a"),
        (lambda: Case(3, 4), "a case needs a dict"),
        (
            lambda: Lab("01", "", 1, [Exercise("a"), Exercise("a")]),
            "lab 01: a appears twice; each exercise needs a name of its own",
        ),
        (lambda: Lab("13a", "", 1, []), "lab number '13a': needs two digits"),
        (lambda: Lab(1, "", 1, []), "lab number 1: needs two digits"),
        (lambda: read(__file__), "is not a notebook; "),
    ],
)
def test_mistakes_of_an_author_are_told(made, words):
    with pytest.raises(CourseError, match=words):
        made()
