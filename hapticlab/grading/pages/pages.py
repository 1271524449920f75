"""Pages of a graded class: one for each student, and one of all; they open without a network, run no script, and print."""

from __future__ import annotations

import base64
import hashlib
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from ...course.cards.page_text import BLOCK, SENTENCE, clean, file_name, shown
from ...course.exercise import NOTED
from ...errors import CourseError
from ..formats.words import state
from .class_page import WORDS, broken, class_facts
from .exercise_card import SHEET, card, without_answer
from .failing_case import compared, drawn, given, options
from .page_figures import bars, shares

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.annotations import File
    from ...course.exercise import Lab
    from ..report import Report

#: near the beginning of every page
OWN = b"default-src 'none'; style-src 'sha256-"
HERE = Path(__file__).parent
#: what the templates call
NAMES = {
    "BLOCK": BLOCK, "MOST_CELLS": 40, "MOST_WRITTEN": 2000, "NOTED": NOTED, "WORDS": WORDS,
    "bars": bars, "broken": broken, "card": card,
    "compared": compared, "drawn": drawn, "given": given, "options": options, "shares": shares, "state": state,
    "without_answer": without_answer,
}  # fmt: skip


@lru_cache(maxsize=1)
def templates():
    """Templates whose every expression is text of anybody: bounded and escaped, unless a template calls it safe."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    @lru_cache(maxsize=4096)  # a class has the same names and sentences on every page
    def kept(text, most, lines):
        return Markup(clean(text, most, lines=lines))

    def text(value, most=SENTENCE, lines=False):
        if hasattr(value, "__html__"):
            return value
        short = type(value) is str and len(value) <= SENTENCE
        return kept(value, most, lines) if short else Markup(clean(value, most, lines=lines))

    pages = Environment(
        loader=FileSystemLoader(HERE),
        autoescape=True,
        finalize=text,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    style = (HERE / "pages.css").read_text("utf-8") + SHEET
    allowed = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    pages.globals |= {**NAMES, "style": Markup(style), "allowed": allowed}
    pages.filters |= {"clean": text, "shown": shown, "g": "{:g}".format}
    return pages


def write_pages(reports: Iterable[Report], folder: File, *, lab: Lab) -> list[Path]:
    """Write a page for each student and one of the class; the same reports give the same bytes, in whatever order.

    A student's page names nobody else, so it can be sent to its student.

    Parameters
    ----------
    reports : sequence of Report
        Of one lab.
    folder : str or Path
        Made where it is missing; pages of the same names are written anew.
    lab : Lab

    Returns
    -------
    list of Path
        ``class.html``, where there are designs ``fronts.html`` without names, then each student's page in ``students``.

    Raises
    ------
    CourseError
        Where the folder cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from hapticlab.course.exercise import Lab
    >>> from hapticlab.grading.report import ExerciseReport, Report
    >>> report = Report("ada", "02", "Walls", "wall.ipynb", exercises=(ExerciseReport("k", "value", points=2.0),))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = write_pages([report], folder, lab=Lab("02", "Walls", 90, ()))
    ...     [path.relative_to(folder).as_posix() for path in written]
    ['class.html', 'students/ada.html']
    """
    named: list[tuple[str, Report]] = []
    copies: dict[str, int] = {}
    for report in sorted(reports, key=lambda r: (r.student.casefold(), r.student, r.submission, r.sha256)):
        copies[report.student] = copies.get(report.student, -1) + 1
        named.append((f"students/{file_name(report.student, copies[report.student])}.html", report))
    facts = class_facts(named)
    pages = {"class.html": templates().get_template("class.html").render(lab=lab, **facts)}
    if facts["fronts"]:
        pages["fronts.html"] = templates().get_template("fronts.html").render(lab=lab, fronts=facts["fronts"])
    student = templates().get_template("student.html")
    for address, report in named:
        pages[address] = student.render(report=report, lab=lab)
    return write_texts(Path(folder), pages)


def check_folder(folder: File, page: str = "class.html") -> None:
    """Refuse a folder whose page of the class is of something else, which would be overwritten.

    Raises
    ------
    CourseError
    """
    path = Path(folder) / page
    if path.is_file() and OWN not in path.read_bytes()[:500]:
        raise CourseError(f"{path} is not a page of hapticlab's and would be overwritten; name a folder of its own for the pages")


def write_texts(folder, pages):
    """Write texts to their addresses in a folder, and return their paths."""
    path = folder / "students"
    try:
        path.mkdir(parents=True, exist_ok=True)
        for address, text in pages.items():
            path = folder / address
            path.write_text(text, "utf-8", newline="\n")
    except OSError as problem:  # of a disk that is full, without the name of the file
        why = f"cannot write {problem.filename or path}: {problem.strerror or problem}"
        raise CourseError(f"{why}; name a folder of your own, such as: --pages pages") from None
    return [folder / address for address in pages]
