"""Reports on a terminal, and all of them as JSON."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import TYPE_CHECKING

from .format import Format
from .words import clean, failed_cells, judged, points, state

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..handed_in.roster import Roster
    from ..report import Report


def text(reports: Sequence[Report], roster: Roster | None = None, assignment: str = "") -> str:
    """Return reports in words: all of one, a line each of several."""
    if len(reports) == 1:
        return "\n".join([_head(reports[0]), *_lines(reports[0])]) + "\n"
    return "\n".join([*(_head(one) + _wrong(one) for one in reports), *_summary(reports)]) + "\n"


def _head(report):
    told = f"{points(report.earned)} of {points(report.points)} points, lab {clean(report.lab)} {clean(report.title)}"
    problem = f"; could not be graded: {clean(report.problem)}" if report.problem else ""
    return f"{clean(report.student)}: {told}, {clean(report.submission)}{problem}"


def _lines(report):
    for one in report.exercises:
        worth = f" ({points(one.points)})" if one.points else ""
        lost = state(one) in ("wrong", "partly")
        said = f": {clean(one.words)}" if one.words and lost else ""
        yield f"  {state(one):<10} {clean(one.name)}{worth}{said}"
        if one.hint and lost:
            yield f"  {'':<10} hint: {clean(one.hint)}"
    yield from (f"  {line}" for line in failed_cells(report))


def _wrong(report):
    if report.problem:
        return ""
    wrong = [clean(one.name) for one in judged(report) if state(one) not in ("right", "partly")]
    parts = [clean(one.name) for one in judged(report) if state(one) == "partly"]
    told = f"; wrong or missing: {', '.join(wrong)}" if wrong else ""
    return told + (f"; a part of the points: {', '.join(parts)}" if parts else "")


def _summary(reports):
    """Return the last lines of a class: the mean of each lab, and how many could not be graded."""
    for lab in sorted({one.lab for one in reports}):
        graded = [one for one in reports if one.lab == lab and not one.problem]
        if graded:
            mean = points(sum(one.earned for one in graded) / len(graded))
            yield f"lab {clean(lab)}: {len(graded)} graded, mean {mean} of {points(max(one.points for one in graded))} points"
    lost = sum(bool(one.problem) for one in reports)
    yield f"{lost} could not be graded" if lost else f"{len(reports)} submissions, all graded"


def whole(reports: Sequence[Report], roster: Roster | None = None, assignment: str = "") -> str:
    """Return all that is known as JSON: ``{"reports": [...]}``, see :class:`hapticlab.grading.report.Report`.

    JSON has no NaN and no infinity: these are the texts "nan", "inf" and "-inf".
    """
    held = [{**asdict(one), "points": one.points, "earned": one.earned} for one in reports]
    return json.dumps(_finite({"reports": held}), indent=1, sort_keys=True, allow_nan=False) + "\n"


def _finite(value):
    if isinstance(value, dict):
        return {name: _finite(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


FORMATS = (Format("text", text, "words"), Format("json", whole, "json"))
