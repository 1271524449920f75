"""results.json of a Gradescope autograder: https://gradescope-autograders.readthedocs.io/en/latest/specs/."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from ...errors import CourseError
from .format import Format
from .words import clean, failed_cells, for_student, judged, only, points, printed, state

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..handed_in.roster import Roster
    from ..report import Report


def results(reports: Sequence[Report], roster: Roster | None = None, assignment: str = "") -> str:
    """Return the result of one submission, a test for each exercise that carries points.

    A student may hand in again, so of a hidden case only its slip is told. There is none where the grader failed, so that
    Gradescope tells of that, and writes no 0 points down.
    """
    report = only(reports, "Gradescope")
    if report.grader_failed:
        raise CourseError(f"no result was written for Gradescope, which would count it as 0 points: {report.problem}")
    told = {
        "score": points(report.earned),
        "output": _output(report),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": [_test(number, one) for number, one in enumerate(judged(report), start=1)],
    }
    return json.dumps(told, indent=1) + "\n"


def _output(report):
    """The text on the whole submission."""
    if report.problem:
        return f"Not graded: {clean(report.problem)}"
    noted = [one for one in report.exercises if not one.points]
    return "\n".join([*(f"{clean(one.name)}: {state(one)}, a person reads it" for one in noted), *failed_cells(report)])


def _test(number, one):
    out = printed(one)
    return {
        "name": clean(one.name),
        "number": str(number),
        "score": points(one.earned),
        "max_score": points(one.points),
        "status": "passed" if state(one) == "right" else "failed",
        "output": for_student(one) + (f"\nIt printed:\n{out}" if out else ""),
        "visibility": "visible",
    }


FORMATS = (Format("gradescope", results, "result"),)
