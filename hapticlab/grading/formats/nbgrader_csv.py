"""The grades.csv that nbgrader exports."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .format import Format
from .table import best, table
from .words import points, title

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..handed_in.roster import Roster
    from ..report import Report

#: https://github.com/jupyter/nbgrader/blob/main/nbgrader/plugins/export.py
COLUMNS = (
    "assignment", "duedate", "timestamp", "student_id", "last_name", "first_name", "email", "raw_score",
    "late_submission_penalty", "score", "max_score",
)  # fmt: skip


def grades(reports: Sequence[Report], roster: Roster | None = None, assignment: str = "") -> str:
    """Return a row for each student and lab; names and e-mail addresses come from the roster, where there is one.

    Who could not be graded has no score.
    """
    reports = best(reports)
    people = roster.rows_of(report.student for report in reports) if roster else {}
    return table(COLUMNS, (_row(report, people.get(report.student, {}), assignment) for report in reports))


def _row(report, person, assignment):
    earned = "" if report.problem else points(report.earned)
    score = {"raw_score": earned, "late_submission_penalty": 0, "score": earned, "max_score": points(report.points)}
    return {
        "assignment": assignment or title(report),
        "student_id": report.student,
        "last_name": person.get("last_name", ""),
        "first_name": person.get("first_name", ""),
        "email": person.get("email", "") or person.get("email_address", ""),
        **score,
    }


FORMATS = (Format("nbgrader", grades, "table", folder_is_assignment=True),)
