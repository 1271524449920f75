"""What a student answered on one occasion, read from a notebook as text: nothing of it is run or read as Python."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ...course.concepts.inventory import OCCASIONS, Occasion, form
from ...course.concepts.question import Asked, fingerprint
from ...course.concepts.questionnaire import QUESTIONS, notebook_name
from ...errors import CourseError
from ..handed_in.submission import find_submissions, read

if TYPE_CHECKING:
    from ...base.annotations import File
    from ..handed_in.submission import Submission

#: a line that answers, as the notebook has it; the last one counts, as it does in Python
ANSWER = re.compile(r"^(q\d\d)[ \t]*=(?!=)[ \t]*([^\n#;]{0,40})", re.M)
#: a letter, with or without quotation marks
LETTER = re.compile(r"""\s*(["']?)\s*([a-dA-D])\s*\1\s*""")
NOTHING = re.compile(r"""\s*(None|""|'')?\s*""")
WHOSE = re.compile(rf"""^{QUESTIONS}[ \t]*=[ \t]*["']([0-9a-f]{{12}})["']""", re.M)
#: the line of a simulated student
SIMULATED = "simulated_student = True"
#: fewer answers than this part of all questions say nothing about a student
LEAST = 0.5


@dataclass(frozen=True)
class Paper:
    """The answers of one student on one occasion.

    Attributes
    ----------
    student : str
    picked : dict of str to str or None
        Answer, such as ``q01``, to the misconception of the chosen option; empty for the right option, None for no answer.
    problem : str
        Why the answers cannot be read; there are none then.
    unreadable : tuple of str
        Answers that are none of the four letters, which count as no answer.
    simulated : bool
        Whether the notebook says that a program answered it.
    """

    student: str
    picked: Mapping[str, str | None] = field(default_factory=dict)
    problem: str = ""
    unreadable: tuple[str, ...] = ()
    simulated: bool = False


def read_papers(paths: Sequence[File], *, occasion: Occasion, seed: int = 0, names: Iterable[str] = ()) -> list[Paper]:
    """Return what students answered on one occasion; whatever is wrong with a notebook is the problem of its paper.

    Parameters
    ----------
    paths : sequence of str or Path
        Folders, zip files and notebooks, as :func:`hapticlab.grading.handed_in.submission.find_submissions` takes them.
    occasion : {"before", "after"}
    seed : int
        Of the course, as it was given when the questions were handed out.
    names : iterable of str
        Students that questions were handed out to. A notebook is then known by its questions, whatever its file is called.

    Returns
    -------
    list of Paper
        Ordered by student, each of whom is there once.

    Raises
    ------
    CourseError
        For a path that is not there.
    """
    lab = notebook_name(occasion).removesuffix(".ipynb")
    found = [read(source) for source in find_submissions(list(paths), lab)]
    known = {fingerprint(form(seed, name, occasion)): name for name in names}
    papers = [_paper(submission, known.get(_whose(submission.cells), submission.student), seed, occasion) for submission in found]
    counts = Counter(paper.student for paper in papers if not paper.problem)
    twice = {student for student, count in counts.items() if count > 1}
    words = "several notebooks contain the questions of this student; keep one"
    papers = [Paper(paper.student, problem=words) if paper.student in twice else paper for paper in papers]
    unique = {paper.student: paper for paper in sorted(papers, key=lambda paper: bool(paper.problem), reverse=True)}
    return sorted(unique.values(), key=lambda paper: (paper.student.casefold(), paper.student))


def _whose(cells: Iterable[str]) -> str:
    """Return the fingerprint that a notebook names, or an empty text."""
    return next((found[1] for cell in cells if (found := WHOSE.search(cell))), "")


def _paper(submission: Submission, student: str, seed: int, occasion: Occasion) -> Paper:
    try:
        if submission.problem:
            raise CourseError(submission.problem)
        asked = _asked(_whose(submission.cells), student, seed, occasion)
    except CourseError as problem:
        return Paper(student, problem=str(problem))
    written = {name: text for cell in submission.cells for name, text in ANSWER.findall(cell)}
    paper = answered(asked, student, written)
    simulated = any(SIMULATED in cell.splitlines() for cell in submission.cells)
    given = sum(one is not None for one in paper.picked.values())
    if given < LEAST * len(asked):
        words = f"{given} of {len(asked)} questions are answered; at least half are needed"
        return Paper(student, problem=words, simulated=simulated)
    return replace(paper, simulated=simulated)


def _asked(found: str, student: str, seed: int, occasion: Occasion) -> tuple[Asked, ...]:
    """Return the questions that a notebook names, if these are the student's own or those that the class shares."""
    if not found:
        raise CourseError(f"it has no line {QUESTIONS} = ..., which tells the questions; hand in the notebook as it was given")
    for name in (student, ""):
        asked = form(seed, name, occasion)
        if fingerprint(asked) == found:
            return asked
    for other in OCCASIONS:
        if other != occasion and found in {fingerprint(form(seed, name, other)) for name in (student, "")}:
            raise CourseError(f"it has the questions of {other} the course, and was handed in as {occasion} the course")
    again = "give the seed and the roster, and use the version of hapticlab, with which it was handed out"
    raise CourseError(f"it has the questions of a different student, of a different seed or of a different version; {again}")


def answered(asked: Iterable[Asked], student: str, written: Mapping[str, str]) -> Paper:
    """Return the paper of answers as they are written.

    Parameters
    ----------
    asked : iterable of Asked
    student : str
    written : dict of str to str
        Answer to the text right of its equals sign.

    Examples
    --------
    >>> asked = form(3, "ada", "before")
    >>> paper = answered(asked, "ada", {"q01": f'"{asked[0].key}"', "q02": "None", "q03": "hello"})
    >>> paper.picked["q01"], paper.picked["q02"], paper.unreadable
    ('', None, ('q03',))
    """
    picked: dict[str, str | None] = {}
    unreadable = []
    for one in asked:
        text = written.get(one.identity, "")
        found = LETTER.fullmatch(text)
        letters = {option.letter: option.misconception for option in one.options}
        picked[one.identity] = letters[found[2].lower()] if found else None
        if not found and not NOTHING.fullmatch(text):
            unreadable.append(one.identity)
    return Paper(student, picked, unreadable=tuple(unreadable))
