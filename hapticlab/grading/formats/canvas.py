"""A file for "Import grades" of Canvas.

Fields: https://github.com/instructure/canvas-lms/blob/master/lib/gradebook_importer.rb and
https://teaching.resources.osu.edu/toolsets/carmencanvas/guides/calculating-final-grades/import-csv-file-carmen-grades
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...errors import CourseError
from .format import Format
from .table import by_student, table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..handed_in.roster import Roster
    from ..report import Report

COLUMNS = {"student": "Student", "id": "ID", "sis_user_id": "SIS User ID", "sis_login_id": "SIS Login ID", "section": "Section"}


def gradebook(reports: Sequence[Report], roster: Roster, assignment: str = "") -> str:
    """Return the points of each student who is in the roster, in a column of the assignment's name.

    Canvas takes a column of the name of an assignment of its own, "Lab 02 (12345)" or "Lab 02", for that assignment, and
    offers to make one for any other name. Who could not be graded has no row, and keeps what Canvas has.

    Parameters
    ----------
    reports : sequence of Report
    roster : Roster
        As Canvas exports its gradebook.
    assignment : str
    """
    lacking = [name for key, name in COLUMNS.items() if key not in roster.columns and key not in ("sis_user_id", "sis_login_id")]
    if lacking:
        raise CourseError(f"the roster has no column {', '.join(lacking)}; export the gradebook of Canvas, which has all of them")
    columns, earned = by_student(reports, assignment)
    info = [name for key, name in COLUMNS.items() if key in roster.columns]
    if "sis_login_id" not in roster.columns:  # Canvas knows SIS User ID only beside SIS Login ID
        info = [name for name in info if name != "SIS User ID"]
    people = roster.rows_of(earned)
    worth = {"Student": "    Points Possible", **columns}
    rows = ({**_info(person), **earned[student]} for student, person in people.items() if earned[student])
    return table([*info, *columns], [worth, *rows])


def _info(person):
    return {name: person[key] for key, name in COLUMNS.items() if key in person}


FORMATS = (Format("canvas", gradebook, "table", needs_roster=True),)
