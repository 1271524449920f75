"""hapticlab's marks in a gradebook of nbgrader: they stand over what nbgrader's own tests gave."""

import importlib.util
from pathlib import Path

from ...errors import CourseError, EngineMissingError
from .nbgrader_source import exercises_of


def push(reports, path, assignment=None):
    """Write marks into a gradebook.db, exercise by exercise.

    Students who are not in the gradebook are added. Marks of cells that a person grades stay as they are, and so does
    what nothing in the report is about, and all of a student whose submission could not be graded.

    Parameters
    ----------
    reports : iterable of Report
    path : str or Path
        The course's gradebook.db, where `nbgrader generate_assignment` has made the assignment.
    assignment : str, optional
        Its name there; by default the one whose name begins with the lab's number, as `hapticlab assign` calls it.

    Returns
    -------
    list of str
        What found no place, a sentence each.

    Raises
    ------
    EngineMissingError
        Where nbgrader is not installed.
    CourseError
        Where there is no gradebook at the path.
    """
    if importlib.util.find_spec("nbgrader") is None:
        raise EngineMissingError("a gradebook needs nbgrader, which is not installed with hapticlab; do: pip install nbgrader")
    if not Path(path).is_file():
        raise CourseError(
            f"{path}: no such file; name the gradebook.db of a course, which `nbgrader generate_assignment` makes in its folder"
        )
    from nbgrader.api import Gradebook

    with Gradebook(f"sqlite:///{Path(path).resolve()}") as book:
        lost = [words for report in reports for words in _push(book, report, assignment)]
        book.db.commit()
    return lost


def _push(book, report, assignment):
    """Write one report and return what found no place."""
    if report.problem:
        return [f"{report.student}, lab {report.lab}: could not be graded; the gradebook keeps its old entry"]
    there = [one.name for one in book.assignments if one.name == assignment or (not assignment and one.name[:2] == report.lab)]
    if len(there) != 1:
        said = f"has {' and '.join(there)}" if there else f"has no {assignment or 'assignment of that lab'}"
        return [f"{report.student}, lab {report.lab}: the gradebook {said}; not written"]
    book.update_or_create_student(report.student)
    with book.db.no_autoflush:  # a new submission is known to its notebooks before it is to the session
        book.update_or_create_submission(there[0], report.student)
    marks = {one.name: one for one in report.exercises if one.points}
    cells = _cells(book, there[0], marks)
    for cell, names in cells.items():
        grade = book.find_grade(cell.name, cell.notebook.name, there[0], report.student)
        grade.auto_score = sum(marks[name].earned for name in names)
        grade.manual_score, grade.needs_manual_grade = None, False
    placed = {name for names in cells.values() for name in names}
    lost = ", ".join(name for name in marks if name not in placed)
    return [f"{report.student}, lab {report.lab}: {there[0]} has no cell for {lost}; not written"] if lost else []


def _cells(book, assignment, marks):
    """Return each test cell of an assignment to the exercises whose points it holds."""
    cells = [cell for notebook in book.find_assignment(assignment).notebooks for cell in notebook.grade_cells]
    found = {cell: [name for name in exercises_of(cell.name) if name in marks] for cell in cells}
    return {cell: names for cell, names in found.items() if names}
