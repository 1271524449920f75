"""A file for "Import grades, CSV file" of Moodle: https://docs.moodle.org/en/Grade_import."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...errors import CourseError
from .format import Format
from .table import by_student, table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..handed_in.roster import Roster
    from ..report import Report

#: key in the roster to the field that is chosen at "Map to"
KEYS = {"email_address": "Email address", "email": "Email address", "id_number": "ID number", "username": "Username"}


def grades(reports: Sequence[Report], roster: Roster, assignment: str = "") -> str:
    """Return the points of each student who is in the roster.

    At the import, "Map from" is the first column; "Map to" is its name without spaces, as in "Email address" (useremail) or
    "ID number" (useridnumber). There is no column of feedback: with one, Moodle deletes the grades of what has no mapping.
    Who could not be graded has no row, and keeps the grade that Moodle has.

    Parameters
    ----------
    reports : sequence of Report
    roster : Roster
        As Moodle exports its participants, with "Email address" or "ID number" (an ID number that is filled in for all is taken
        where there is no address). Moodle tells capitals from small letters in addresses: they stay as they are.
    assignment : str
    """
    columns, earned = by_student(reports, assignment)
    people = roster.rows_of(earned)
    key = next((key for key in KEYS if key in roster.columns and all(row[key] for row in people.values())), None)
    if key is None:
        raise CourseError(
            f"the roster has no column Email address, ID number or Username that is filled in for all; it has {roster.told()}"
        )
    rows = ({KEYS[key]: person[key], **earned[student]} for student, person in people.items() if earned[student])
    return table([KEYS[key], *columns], rows)


FORMATS = (Format("moodle", grades, "table", needs_roster=True),)
