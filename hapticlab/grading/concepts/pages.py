"""Pages and tables of a class that answered the concept inventory."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from ...course.cards.page_text import file_name
from ...course.concepts.inventory import CONCEPTS, NOT_VALIDATED, questions
from ...course.concepts.misconceptions import MISCONCEPTIONS
from ...course.labs import find_labs
from ..formats.table import table
from ..pages.pages import templates, write_texts
from .class_summary import misconceptions_of
from .gain_figure import gain_figure

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...base.annotations import File
    from .class_summary import Summary
    from .paper import Paper

CLASS, STUDENTS, QUESTIONS = "concepts.html", "students.csv", "questions.csv"
#: misconceptions of the class that are shown at once
MOST_SHOWN = 12
SIMULATED = "Simulated students: a program answered. These numbers say nothing about people."


def write_concept_pages(found: Summary, after: Iterable[Paper], folder: File) -> list[Path]:
    """Write the page of the class, a page for each student who answered after the course, and two tables.

    A student's page names nobody else, contains no number and tells no right answer, so it can be sent to its student.

    Parameters
    ----------
    found : Summary
    after : sequence of Paper
    folder : str or Path
        Made where it is missing; pages of the same names are written again.

    Returns
    -------
    list of Path
        ``concepts.html``, ``students.csv``, ``questions.csv``, then each student's page in ``students``.

    Raises
    ------
    CourseError
        If the folder cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from hapticlab.grading.concepts.class_summary import summary
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [path.name for path in write_concept_pages(summary([], []), [], folder)]
    ['concepts.html', 'students.csv', 'questions.csv']
    """
    status = [NOT_VALIDATED, *[SIMULATED] * found.simulated]
    readable = [paper for paper in after if not paper.problem]
    addresses = {paper.student: f"students/{file_name(paper.student)}.html" for paper in readable}
    before = {one.student: one for one, _ in found.matched}
    shows = {"figure": gain_figure, "percent": percent, "number": number, "MOST_SHOWN": MOST_SHOWN}
    students = len(found.matched)
    chance = 1.96 / math.sqrt(students - 1) if students > 3 else None  # of a correlation of independent values
    facts = {"found": found, "status": status, "addresses": addresses, "chance": chance, **shows}
    texts = {
        CLASS: templates().get_template("concepts.html").render(facts),
        STUDENTS: table(["student", *_columns(), "status"], _student_rows(found, " ".join(status))),
        QUESTIONS: table(_question_columns(found), _question_rows(found, " ".join(status))),
    }
    titles = {folder.number: folder.lab().title for folder in find_labs()}
    for paper in readable:
        now = misconceptions_of(paper)
        earlier = misconceptions_of(before[paper.student]) if paper.student in before else []
        overcome = [MISCONCEPTIONS[name] for name in earlier if name not in now]
        shown = {"paper": paper, "now": [MISCONCEPTIONS[name] for name in now], "overcome": overcome}
        page = templates().get_template("concepts_student.html")
        texts[addresses[paper.student]] = page.render(facts | shown, titles=titles)
    return write_texts(Path(folder), texts)


def percent(part: float) -> str:
    """Return a part of 1 in per cent, or a dash.

    Examples
    --------
    >>> percent(0.4567), percent(float("nan"))
    ('46 %', '–')
    """
    return f"{100 * part:.0f} %" if math.isfinite(part) else "–"


def number(value: float) -> str:
    """Return a number with two digits after the point, or a dash.

    Examples
    --------
    >>> number(0.4567), number(-0.001), number(float("nan"))
    ('0.46', '0.00', '–')
    """
    return f"{round(value, 2) + 0.0:.2f}" if math.isfinite(value) else "–"


def _columns() -> list[str]:
    return [f"{name} {occasion}" for name in ("all", *(concept.name for concept in CONCEPTS)) for occasion in ("before", "after")]


def _student_rows(found: Summary, status: str) -> list[dict[str, object]]:
    """Return the right answers of each matched student, of each concept."""
    groups = {"all": list(questions())}
    for answer, (concept, _) in questions().items():
        groups.setdefault(concept.name, []).append(answer)
    rows: list[dict[str, object]] = []
    for first, last in found.matched:
        row: dict[str, object] = {"student": first.student, "status": status}
        for occasion, paper in (("before", first), ("after", last)):
            row |= {f"{name} {occasion}": sum(paper.picked[one] == "" for one in several) for name, several in groups.items()}
        rows.append(row)
    return rows


def _question_columns(found: Summary) -> Sequence[str]:
    parts = [f"{what} {occasion}" for what in ("difficulty", "discrimination") for occasion in ("before", "after")]
    chosen = [
        f"{what} {when}" for what in ("right", "wrong 1", "wrong 2", "wrong 3", "no answer") for when in ("before", "after")
    ]
    return ["question", "about", "concept", *parts, *chosen, "misconception 1", "misconception 2", "misconception 3", "status"]


def _question_rows(found: Summary, status: str) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for item in found.items:
        row: dict[str, object] = {"question": item.answer, "about": item.about, "concept": item.concept, "status": status}
        for what, pair in (("difficulty", item.difficulty), ("discrimination", item.discrimination)):
            row |= {f"{what} {when}": round(part, 4) for when, part in zip(("before", "after"), pair, strict=True)}
        for name, (words, *counts) in zip(("right", "wrong 1", "wrong 2", "wrong 3", "no answer"), item.chosen, strict=True):
            row |= {f"{name} {when}": count for when, count in zip(("before", "after"), counts, strict=True)}
            if name.startswith("wrong"):
                row[name.replace("wrong", "misconception")] = words
        rows.append(row)
    return rows
