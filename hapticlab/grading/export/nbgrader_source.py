"""A lab as an assignment of nbgrader, which hands it out, collects it and marks it by its own commands.

What is released equals the student's notebook: a solution stands after the open answer and is cut out whole, and what
makes a check raise is a hidden test. An untouched release therefore runs from top to bottom.
"""

from .answer_cells import answer_cells, source_of

#: nbgrader puts its stub where a solution was; the open answer stands above it already
CONFIG = '''"""The course as nbgrader reads it."""

c = get_config()  # noqa: F821
c.CourseDirectory.course_id = {course!r}
c.ClearSolutions.code_stub = {{"python": ""}}  # the lab's own open answer stands where a solution was
c.ExecutePreprocessor.timeout = {seconds}  # seconds a cell may take
'''


def config(course, seconds=60):
    """Return the text of nbgrader_config.py.

    Examples
    --------
    >>> print(config("haptics").splitlines()[3])
    c.CourseDirectory.course_id = 'haptics'
    """
    return CONFIG.format(course=course, seconds=seconds)


def nbgrader_notebook(folder, answers):
    """Return a lab's notebook as nbgrader's source.

    The cell of an answer is a solution cell with the exercise's name as grade_id, that of its check a locked test
    cell, ``check-`` and the name, with the exercise's points. A discussion is a solution cell that a person grades, of
    no points until somebody gives it some. A prediction is not graded.

    Parameters
    ----------
    folder : LabFolder
    answers : Path
        With solution.py.
    """
    found = answer_cells(folder, answers)
    return {**found.notebook, "cells": [_cell(cell, found) for cell in found.notebook["cells"]]}


def check_id(*names):
    """Return the grade_id of the cell that checks exercises.

    Examples
    --------
    >>> check_id("wall_force", "k"), exercises_of(check_id("wall_force", "k"))
    ('check-wall_force--k', ('wall_force', 'k'))
    """
    return f"check-{'--'.join(names)}"


def exercises_of(grade_id):
    """Return the names of the exercises whose points a test cell holds; of another cell, none."""
    start, _, names = grade_id.partition("-")
    return tuple(names.split("--")) if start == "check" and names else ()


def _cell(cell, found):
    """Return a cell with what nbgrader needs."""
    key = cell["id"]
    judged = [one for one in found.checks.get(key, ()) if one.judged]
    if key in found.solutions:
        return _solution(cell, found)
    return _test(cell, judged, found.lab) if judged else cell


def _solution(cell, found):
    key = cell["id"]
    names, by_hand = found.names(key), any(one.kind == "text" for one in found.answers.get(key, ()))
    region = ["### BEGIN SOLUTION", found.solutions[key], "### END SOLUTION"]
    marked = {"grade": by_hand, "solution": True, "locked": False, **({"points": 0} if by_hand else {})}
    return _with(cell, names[0] if names else f"open-{key}", [source_of(cell), *region], marked)


def _test(cell, judged, lab):
    required = [f'hl.check("{lab.number}.{one.name}", {one.name}).require()' for one in judged]
    region = ["### BEGIN HIDDEN TESTS", *required, "### END HIDDEN TESTS"]
    marked = {"grade": True, "solution": False, "locked": True, "points": sum(one.points for one in judged)}
    return _with(cell, check_id(*(one.name for one in judged)), [source_of(cell), *region], marked)


def _with(cell, name, lines, marked):
    metadata = {"schema_version": 3, "grade_id": name, "task": False, "cell_type": "code", **marked}
    return {**cell, "source": "\n".join(lines), "metadata": {**cell["metadata"], "nbgrader": metadata}}
