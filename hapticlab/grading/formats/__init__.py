"""Reports as others read them: a terminal, a spreadsheet, a learning management system, an autograder's platform."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

from ...errors import CourseError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..handed_in.roster import Roster
    from ..report import Report

_MODULES = [import_module(f".{found.name}", __name__) for found in iter_modules(__path__)]
#: name -> Format, of all modules in this folder
FORMATS = {one.name: one for one in sorted((f for m in _MODULES for f in getattr(m, "FORMATS", ())), key=lambda one: one.rank)}


def write(name: str, reports: Iterable[Report], roster: Roster | None = None, assignment: str = "", folder: str = "") -> str:
    """Return reports in a format.

    Parameters
    ----------
    name : str
        One of ``FORMATS``.
    reports : sequence of Report
    roster : Roster, optional
        Who the students are; ``canvas`` and ``moodle`` need one.
    assignment : str
        Name of the column in the system that reads it; by default the lab's number and title.
    folder : str
        Name of the lab's folder, by which nbgrader knows an assignment where ``assignment`` is empty.

    Returns
    -------
    str
        To be written as UTF-8.

    Raises
    ------
    CourseError
        Where the format needs a roster, or is of one submission and several are given.

    Examples
    --------
    >>> from hapticlab.grading.report import ExerciseReport, Report
    >>> k = ExerciseReport("k", "value", points=2.0, earned=2.0, answered=True, right=1, cases=1)
    >>> print(write("text", [Report("ada", "02", "Walls", "wall.ipynb", exercises=(k,))]), end="")
    ada: 2 of 2 points, lab 02 Walls, wall.ipynb
      right      k (2)
    """
    if name not in FORMATS:
        raise CourseError(f"format {name!r}: needs one of {', '.join(FORMATS)}")
    made = FORMATS[name]
    if made.needs_roster and roster is None:
        raise CourseError(
            f"{name} identifies students by its own ids; give a CSV file that you exported from it: --roster FILE.csv"
        )
    return made.write(tuple(reports), roster, assignment or (folder if made.folder_is_assignment else ""))
