"""Words and points of a report for any reader: bounded, without what a terminal or a database takes for a command."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...errors import CourseError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report import ExerciseReport, Report

#: characters kept of a sentence, and of what was printed
SENTENCE, BLOCK = 600, 4000
#: in a slip's sentence, a number worked out from the case: a fraction, a given, a factor that is no usual mistake
WORKED_OUT = re.compile(r"\d\.\d|\de[+-]|= -?\d|\b(?!10*\b|[23]\b)\d+ times")
#: joins letters of some scripts; neither turns nor hides anything
JOINERS = "\u200c\u200d"


def clean(text: str, most: int = SENTENCE, *, lines: bool = False) -> str:
    """Return text without what is not seen: control characters, turns of the writing direction, halves of characters.

    Parameters
    ----------
    text : str
    most : int
        Characters kept.
    lines : bool
        Whether its lines stay apart.

    Examples
    --------
    >>> clean("ada\\x1b[2J\\nlovelace"), clean("12345678", 4)
    ('ada\ufffd[2J lovelace', '1234 ...')
    """
    kept = "".join(_seen(letter, lines) for letter in text[:most])
    return kept + " ..." * (len(text) > most)


def _seen(letter, lines):
    if letter.isprintable() or letter in JOINERS or (lines and letter == "\n"):
        return letter
    return " " if letter.isspace() else "\ufffd"


def points(value: float) -> float:
    """Return points as a number without needless digits, to a hundredth.

    Examples
    --------
    >>> points(2.0), points(0.1 + 0.2), points(1 / 3)
    (2, 0.3, 0.33)
    """
    value = round(float(value), 2)
    return int(value) if value.is_integer() else value


def judged(report: Report) -> list[ExerciseReport]:
    """Return the exercises of a report that carry points."""
    return [one for one in report.exercises if one.points]


def state(one: ExerciseReport) -> str:
    """Return whether an exercise is right, in a word or two; a design that earned a part of its points is "partly"."""
    if not one.points:
        return "noted" if one.answered else "no answer"
    if one.earned >= one.points:
        return "right"
    if one.earned > 0:
        return "partly"
    return "wrong" if one.answered else "no answer"


def for_student(one: ExerciseReport) -> str:
    """The words to a student who may hand in again: of a hidden case, that it is wrong, and the slip's sentence.

    Its numbers, sentences with numbers worked out from them, what a program raised with these in its words, and how it ended
    would tell the case. A value or a choice has no numbers but the student's own.
    """
    if state(one) == "right":
        return f"Right: {one.cases} of {one.cases} cases."
    said = clean(one.words)
    hidden = one.ended_hidden if one.ended else one.failing is not None and not one.failing.public
    if hidden and one.kind == "design":
        said = "On a scene that is not shown, the design dominates too few reference points, or is not feasible."
    elif hidden and one.kind not in ("value", "choice"):
        slip = "" if WORKED_OUT.search(one.slip) else clean(one.slip)
        said = f"A case that is not shown is wrong. {slip}".strip()
    hint = f"\nHint: {clean(one.hint)}" if one.hint else ""
    return f"{said}{hint}"


def printed(one: ExerciseReport) -> str:
    """The output of an exercise, bounded."""
    return clean(one.printed, BLOCK, lines=True)


def failed_cells(report: Report, most: int = 20) -> list[str]:
    """Return a line for each cell that failed, the first ones."""
    more = len(report.cells) - most
    told = [f"cell {number}: {clean(words)}" for number, words in report.cells[:most]]
    return told + [f"{more} cells more failed"] * (more > 0)


def title(report: Report) -> str:
    """Return the number and title of a report's lab."""
    return clean(f"Lab {report.lab}: {report.title}")


def only(reports: Sequence[Report], name: str) -> Report:
    """Return the one report of a format that is of one submission."""
    if len(reports) != 1:
        raise CourseError(f"{name} reads the result of one submission; {len(reports)} were given. Grade each one separately")
    return reports[0]
