"""What answers earn: the public cases of a lab and hidden ones, judged alike.

An instructor's folder of a lab holds ``solution.py``, the answers under the names they have in the notebook, and
``hidden.py`` with ``def cases(random): return {"exercise": lambda: [given, ...]}``, whose expected values the solution
gives. Each exercise draws from a generator of its own, so that a change of one leaves the cases of all others; and so does
each student. ``hidden.py`` may also have ``def numbers(random): return {"K_OWN": 430.0}``, constants of notebook and solution
that are other for each student, see :mod:`hapticlab.course.personal`.
"""

from __future__ import annotations

import hashlib
import math
import runpy
import zlib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import CourseError
from .constants import with_constants
from .design_answer import points_of
from .evaluate import evaluate
from .exercise import Case
from .judge import judge, verdict

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from .exercise import Exercise, Lab
    from .judge import Verdict

SOLUTION, HIDDEN = "solution.py", "hidden.py"
#: beside them, what tests a lab's sentences: wrong answers, and statements about every paddle; no grader reads these
WRONG, CLAIMS = "wrong.py", "claims.py"
#: kinds whose answer is data and no code: it cannot depend on what a case gives
DATA = ("value", "choice", "design")
#: of a design NAME, the solution's reference designs are NAME_points
POINTS = "_points"
#: what a student's own numbers are drawn by: no exercise can have this name
NUMBERS = "numbers()"


@dataclass(frozen=True)
class Mark:
    """What one exercise earned: its points where every case is right, else none; of a design a part of them."""

    exercise: str
    points: float
    earned: float
    right: int
    cases: int
    words: str  # of the first wrong case


def marks(lab: Lab, answers: Mapping[str, Any], hidden: Mapping[str, Sequence[Case]] | None = None) -> tuple[Mark, ...]:
    """Mark answers.

    Parameters
    ----------
    lab : Lab
    answers : dict
        Name to answer: what a notebook holds after it ran.
    hidden : dict of str to sequence of Case, optional
        Beside the public cases.

    Returns
    -------
    tuple of Mark
        One for each exercise that is judged.

    Examples
    --------
    >>> from hapticlab.course.exercise import Exercise, Lab
    >>> lab = Lab("01", "Springs", 30, [Exercise("force", points=2, cases=[Case({"x": 0.01, "k": 200.0}, 2.0, unit="N")])])
    >>> [(mark.exercise, mark.earned) for mark in marks(lab, {"force": lambda x, k: k * x})]
    [('force', 2)]
    """
    return tuple(
        _mark(exercise, answers.get(exercise.name), counted_cases(exercise, hidden))
        for exercise in lab.exercises
        if exercise.judged
    )


def counted_cases(exercise: Exercise, hidden: Mapping[str, Sequence[Case]] | None = None) -> tuple[tuple[Case, bool], ...]:
    """Return the cases that an exercise is marked by, each with whether it is public.

    Where there are hidden cases of a value, a choice or a design, the public one, whose answer a class can pass on, does not
    count.

    Examples
    --------
    >>> from hapticlab.course.exercise import Exercise
    >>> k = Exercise("k", "value", 1, cases=[Case({}, 150.0)])
    >>> [(case.expected, public) for case, public in counted_cases(k, {"k": [Case({}, 143.0)]})]
    [(143.0, False)]
    """
    own = tuple((case, False) for case in (hidden or {}).get(exercise.name, ()))
    return own if own and exercise.kind in DATA else (*((case, True) for case in exercise.cases), *own)


def _mark(exercise, answer, cases):
    verdicts = [verdict(exercise, case, evaluate(exercise.kind, answer, case.given)) for case, _ in cases]
    wrong = [v.words for v in verdicts if not v.right]
    earned = earned_points(exercise, verdicts)
    return Mark(exercise.name, exercise.points, earned, len(verdicts) - len(wrong), len(verdicts), "".join(wrong[:1]))


def earned_points(exercise: Exercise, verdicts: Sequence[Verdict]) -> float:
    """Return the points of verdicts on all cases: all where each is right, else none; of a design the least share of any.

    Examples
    --------
    >>> from hapticlab.course.exercise import Exercise
    >>> from hapticlab.course.judge import Verdict
    >>> earned_points(Exercise("wall", "design", points=2, full=4), [Verdict(True, "", share=1.0), Verdict(False, "", share=0.5)])
    1.0
    """
    if verdicts and all(one.right for one in verdicts):
        return exercise.points
    return exercise.points * min((one.share for one in verdicts), default=0.0) if exercise.kind == "design" else 0


def hidden_cases(lab, folder, seed=0, student="", personal=False):
    """Return the hidden cases of a lab, exercise to cases, from an instructor's folder.

    Parameters
    ----------
    lab : Lab
    folder : str or Path
        With solution.py and hidden.py.
    seed : int
        The same seed gives the same cases to the same student.
    student : str
        Whose cases: each student has others. Those of "" are for nobody.
    personal : bool
        Whether this student was handed numbers of their own, which are then also those of the solution.
    """
    folder = Path(folder)
    cases = _cases(folder)
    answers = _solution(folder, own_numbers(lab, folder, seed, student) if personal else {})
    try:
        names = list(cases(_generator(seed, lab, "", student)))
        found = {name: _drawn(cases(_generator(seed, lab, name, student))[name]) for name in names}
    except Exception as problem:
        raise CourseError(f"{folder / HIDDEN}: cases failed: {type(problem).__name__}: {problem}") from problem
    return {name: tuple(_case(lab.exercise(name), answers, given) for given in several) for name, several in found.items()}


def _cases(folder):
    """Return the function that draws the cases."""
    cases = _instructor_names(folder / HIDDEN).get("cases")
    if cases is None:
        raise CourseError(
            f"{folder / HIDDEN} defines no cases; it needs def cases(random): return {{'exercise': lambda: [given, ...]}}"
        )
    return cases


def own_exercises(lab, folder):
    """Return the names of the exercises whose answer is of a student's own numbers: values and choices with hidden cases.

    Parameters
    ----------
    lab : Lab
    folder : str or Path
        With hidden.py; where it defines no numbers, there are none.
    """
    if not own_numbers(lab, folder, 0, ""):
        return ()
    hidden = _cases(Path(folder))(_generator(0, lab, "", ""))
    return tuple(one.name for one in lab.exercises if one.kind in ("value", "choice") and one.name in hidden)


def own_numbers(lab, folder, seed, student):
    """Return the numbers that are a student's own, by the names of the constants they replace; none where a lab has none.

    Parameters
    ----------
    lab : Lab
    folder : str or Path
        With hidden.py.
    seed : int
    student : str

    Returns
    -------
    dict of str to int or float
    """
    path = Path(folder) / HIDDEN
    numbers = _instructor_names(path).get("numbers")
    if numbers is None:
        return {}
    try:
        drawn = {name: np.asarray(value).item() for name, value in numbers(_generator(seed, lab, NUMBERS, student)).items()}
    except Exception as problem:
        raise CourseError(f"{path}: numbers failed: {type(problem).__name__}: {problem}") from problem
    strange = [name for name, value in drawn.items() if type(value) not in (int, float) or not math.isfinite(value)]
    if strange:
        raise CourseError(f"{path}: numbers returns {strange[0]} = {drawn[strange[0]]!r}; it needs a finite number")
    return drawn


def _drawn(several):
    if not callable(several):
        raise TypeError("each exercise needs a function of its own, 'exercise': lambda: [given, ...]")
    return several()


def _generator(seed, lab, exercise, student):
    """Return the generator that an exercise's hidden cases are drawn from for a student."""
    whose = hashlib.sha256(student.encode("utf-8", "surrogatepass")).digest() if student else b""
    return np.random.default_rng([seed, int(lab.number), zlib.crc32(exercise.encode()), *whose])


def _solution(folder, numbers):
    """Return the answers of a solution, with the numbers of a student in place of its own."""
    path = folder / SOLUTION
    if not numbers:
        return _instructor_names(path)
    source, names = with_constants([_text(path)], numbers, path)[0], {"__name__": "<run_path>", "__file__": str(path)}
    try:
        exec(compile(source, str(path), "exec"), names)
    except (Exception, SystemExit) as problem:
        raise CourseError(f"{path} with {numbers} failed: {type(problem).__name__}: {problem}") from problem
    return names


def _case(exercise, answers, given):
    """Return a case whose expected value the solution gives."""
    if exercise.kind == "design":
        return _design_case(exercise, answers, given)
    outcome = evaluate(exercise.kind, answers.get(exercise.name), given)
    if not outcome.answered or outcome.problem:
        raise CourseError(f"{exercise.name}: the solution gives no value for {given}: {outcome.problem or 'it has no answer'}")
    asked = [case for case in exercise.cases if case.given == given and judge(exercise, case, outcome.value).right]
    if asked:  # what a lab says of wrong answers to the same question is said here too
        return asked[0]
    unit = exercise.cases[0].unit if exercise.cases else ""
    return Case(given, outcome.value, unit=unit)


def _design_case(exercise, answers, given):
    """Return a case with the reference points that the solution's reference designs make on a scene."""
    designs = answers.get(exercise.name + POINTS)
    if not isinstance(designs, dict):
        raise CourseError(f"{exercise.name}: {SOLUTION} needs {exercise.name}{POINTS}, reference designs by their names")
    points = points_of(given, designs)
    if len(points) < exercise.full:
        raise CourseError(
            f"{exercise.name}: only {len(points)} reference designs are feasible for {given}; needs {exercise.full}"
        )
    slips = exercise.cases[0].slips if exercise.cases else ()
    return Case(given, points, slips=slips)


def instructor_names(path):
    """Names that an instructor's file defines, and their values."""
    _text(path)
    try:
        return runpy.run_path(str(path))
    except (Exception, SystemExit) as problem:
        raise CourseError(f"{path} failed: {type(problem).__name__}: {problem}") from problem


def _instructor_names(path):
    """Return the same, run once for a whole class, and again where the file has changed."""
    return _run_once(path, _text(path))


@lru_cache(maxsize=64)
def _run_once(path, text):  # the text is a part of the key
    return instructor_names(path)


def _text(path):
    """Return the text of an instructor's file."""
    if not Path(path).is_file():
        raise CourseError(f"{path}: no such file; an instructor's folder of a lab holds {SOLUTION} and {HIDDEN}")
    return Path(path).read_text("utf-8")
