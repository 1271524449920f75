"""A class as a table: a row for each submission, or one for each exercise of each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .format import Format
from .table import table
from .words import judged, points, state

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..handed_in.roster import Roster
    from ..report import Report


def wide(reports: Sequence[Report], roster: Roster | None = None, assignment: str = "") -> str:
    """Return a row for each submission, with a column of the points of each exercise, named "02.held_work"."""
    exercises = {f"{report.lab}.{one.name}": None for report in reports for one in judged(report)}
    columns = ["student", "lab", "submission", "earned", "points", *exercises, "failed_cells", "problem"]
    return table(columns, map(_row, reports))


def _row(report):
    return {
        **_whose(report),
        "earned": points(report.earned),
        "points": points(report.points),
        **{f"{report.lab}.{one.name}": points(one.earned) for one in judged(report)},
        "failed_cells": len(report.cells),
        "problem": report.problem,
    }


def _whose(report):
    return {"student": report.student, "lab": report.lab, "submission": report.submission}


def long(reports: Sequence[Report], roster: Roster | None = None, assignment: str = "") -> str:
    """Return a row for each exercise of each submission, with what is wrong in words."""
    columns = ["student", "lab", "submission", "exercise", "kind", "state", "earned", "points", "right", "cases"]
    rows = (
        {
            **_whose(report),
            "exercise": one.name,
            "kind": one.kind,
            "state": state(one),
            "earned": points(one.earned),
            "points": points(one.points),
            "right": one.right,
            "cases": one.cases,
            "words": one.words,
            "slip": one.slip,
            "ended": one.ended,
        }
        for report in reports
        for one in report.exercises
    )
    return table([*columns, "words", "slip", "ended"], rows)


FORMATS = (Format("csv", wide, "table"), Format("csv-long", long, "table"))
