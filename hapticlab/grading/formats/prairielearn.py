"""results.json of an external grader of PrairieLearn: https://prairielearn.readthedocs.io/en/latest/externalGrading/."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from .format import Format
from .words import clean, failed_cells, for_student, judged, only, points, printed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..handed_in.roster import Roster
    from ..report import Report

#: bytes that PrairieLearn takes
MOST = 1_000_000
#: kinds of error that a session names first; the grader itself may not parse what students wrote
NO_PYTHON = ("SyntaxError", "IndentationError", "TabError")


def results(reports: Sequence[Report], roster: Roster | None = None, assignment: str = "") -> str:
    """Return the result of one submission, a test for each exercise that carries points.

    What cannot be read, or is no Python, is not gradable: it costs the student no attempt. A student may hand in again, so of a
    hidden case only its slip is told.
    """
    report = only(reports, "PrairieLearn")
    problems = _format_errors(report)
    if problems:
        told = {"gradable": False, "format_errors": problems}
    else:
        told = {"gradable": True, "score": _share(report), "output": "\n".join(failed_cells(report))}
    told["tests"] = [] if problems else [_test(one) for one in judged(report)]
    return _bounded(told)


def _format_errors(report):
    """Return why a submission is none: it could not be read, or nothing is answered and all that failed is no Python."""
    if report.problem:
        return [clean(report.problem)]
    no_python = report.cells and all(words.startswith(NO_PYTHON) for _, words in report.cells)
    return failed_cells(report) if no_python and not any(one.answered for one in report.exercises) else []


def _share(report):
    """Return the score, 0 to 1."""
    return min(1.0, max(0.0, round(report.earned / report.points, 6))) if report.points else 0.0


def _test(one):
    return {
        "name": clean(one.name),
        "description": clean(one.asks),
        "points": points(one.earned),
        "max_points": points(one.points),
        "message": for_student(one),
        "output": printed(one),
    }


def _bounded(told):
    """Return JSON that is short enough; what was printed goes first, then the last tests."""
    text = json.dumps(told, indent=1) + "\n"
    if len(text) > MOST:
        for test in told["tests"]:
            test["output"] = ""
        text = json.dumps(told, indent=1) + "\n"
    while len(text) > MOST:
        del told["tests"][len(told["tests"]) // 2 :]
        text = json.dumps(told, indent=1) + "\n"
    return text


FORMATS = (Format("prairielearn", results, "result"),)
