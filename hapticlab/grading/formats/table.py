"""CSV that spreadsheets open without running anything in it."""

from __future__ import annotations

import csv
import io
import re
from typing import TYPE_CHECKING, Any

from .words import clean, points, title

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ..report import Report

#: Excel takes a file for UTF-8 by it; all systems that read grades leave it out
BOM = "\ufeff"
#: what begins a formula, also in full width, at the beginning of a cell, after a quote, and after what another
#: spreadsheet may take for the end of a cell
FORMULA = re.compile(r"""(^|[,;|"'])(\s*)(?=[=+\-@\uff1d\uff0b\uff0d\uff20])""")


def safe(value):
    """Return a cell that is no formula: in a text an apostrophe stands before what could begin one.

    Examples
    --------
    >>> safe('=HYPERLINK("http://a.b")'), safe("ada;=1+1"), safe("Anna-Maria"), safe(-2.5)
    ('\\'=HYPERLINK("http://a.b")', "ada;'=1+1", 'Anna-Maria', -2.5)
    """
    return FORMULA.sub(r"\1\2'", clean(value)) if isinstance(value, str) else value


def table(columns: Sequence[str], rows: Iterable[Mapping[str, Any]]) -> str:
    """Return CSV with a byte order mark.

    Parameters
    ----------
    columns : sequence of str
    rows : iterable of dict
        A column that a row lacks stays empty.
    """
    output = io.StringIO()
    writer = csv.writer(output, lineterminator="\n")
    writer.writerow([safe(name) for name in columns])
    writer.writerows([safe(row.get(name, "")) for name in columns] for row in rows)
    return BOM + output.getvalue()


def best(reports: Iterable[Report]) -> list[Report]:
    """Return for each student and lab the report that earned most, of equal ones the first: a gradebook has one place.

    One that could not be graded has earned nothing, not even 0 points.
    """
    found: dict[tuple[str, str], Report] = {}
    for report in reports:
        key = (report.student, report.lab)
        if key not in found or _worth(report) > _worth(found[key]):
            found[key] = report
    return list(found.values())


def _worth(report):
    return not report.problem, report.earned


def by_student(reports, assignment):
    """Return the names of the columns, one for each lab, and for each student the points by column.

    Returns
    -------
    columns : dict of str to float
        Name to the points that are possible.
    earned : dict of str to dict
        Student to column to points; without a column where nothing could be graded.
    """
    labs = {report.lab: report for report in sorted(reports, key=lambda one: one.lab)}
    names = {lab: title(report) for lab, report in labs.items()}
    if assignment:
        names = {lab: assignment if len(labs) == 1 else f"{assignment} {lab}" for lab in labs}
    earned = {}
    for report in best(reports):
        graded = {} if report.problem else {names[report.lab]: points(report.earned)}
        earned.setdefault(report.student, {}).update(graded)
    return {names[lab]: points(report.points) for lab, report in labs.items()}, earned
