"""What answers earn: the public cases of a lab and hidden ones, judged alike.

An instructor's folder of a lab holds ``solution.py``, the answers under the names they have in the notebook, and
``hidden.py`` with ``def cases(random): return {"exercise": lambda: [given, ...]}``, whose expected values the solution
gives. Each exercise draws from a generator of its own, so that a change of one leaves the cases of all others.
"""

import runpy
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import CourseError
from .evaluate import evaluate
from .exercise import Case
from .judge import verdict

SOLUTION, HIDDEN = "solution.py", "hidden.py"


@dataclass(frozen=True)
class Mark:
    """What one exercise earned: its points where every case is right, else none."""

    exercise: str
    points: float
    earned: float
    right: int
    cases: int
    words: str  # of the first wrong case


def marks(lab, answers, hidden=None):
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
        _mark(exercise, answers.get(exercise.name), (*exercise.cases, *(hidden or {}).get(exercise.name, ())))
        for exercise in lab.exercises
        if exercise.judged
    )


def _mark(exercise, answer, cases):
    verdicts = [verdict(exercise, case, evaluate(exercise.kind, answer, case.given)) for case in cases]
    wrong = [v.words for v in verdicts if not v.right]
    earned = exercise.points if verdicts and not wrong else 0
    return Mark(exercise.name, exercise.points, earned, len(verdicts) - len(wrong), len(verdicts), "".join(wrong[:1]))


def hidden_cases(lab, folder, seed=0):
    """Return the hidden cases of a lab, exercise to cases, from an instructor's folder.

    Parameters
    ----------
    lab : Lab
    folder : str or Path
        With solution.py and hidden.py.
    seed : int
        The same seed gives the same cases.
    """
    folder = Path(folder)
    answers, hidden = instructor_names(folder / SOLUTION), instructor_names(folder / HIDDEN)
    if "cases" not in hidden:
        raise CourseError(
            f"{folder / HIDDEN} defines no cases; it needs def cases(random): return {{'exercise': lambda: [given, ...]}}"
        )
    try:
        names = list(hidden["cases"](_generator(seed, lab, "")))
        found = {name: _drawn(hidden["cases"](_generator(seed, lab, name))[name]) for name in names}
    except Exception as problem:
        raise CourseError(f"{folder / HIDDEN}: cases failed: {type(problem).__name__}: {problem}") from problem
    return {name: tuple(_case(lab.exercise(name), answers, given) for given in several) for name, several in found.items()}


def _drawn(several):
    if not callable(several):
        raise TypeError("each exercise needs a function, 'exercise': lambda: [given, ...]; then it draws by itself")
    return several()


def _generator(seed, lab, exercise):
    """Return the generator that an exercise's hidden cases are drawn from."""
    return np.random.default_rng([seed, int(lab.number), zlib.crc32(exercise.encode())])


def _case(exercise, answers, given):
    """Return a case whose expected value the solution gives."""
    outcome = evaluate(exercise.kind, answers.get(exercise.name), given)
    if not outcome.answered or outcome.problem:
        raise CourseError(f"{exercise.name}: the solution gives no value for {given}: {outcome.problem or 'it has no answer'}")
    unit = exercise.cases[0].unit if exercise.cases else ""
    return Case(given, outcome.value, unit=unit)


def instructor_names(path):
    """Return what an instructor's file defines."""
    if not Path(path).is_file():
        raise CourseError(f"{path}: no such file; an instructor's folder of a lab holds {SOLUTION} and {HIDDEN}")
    try:
        return runpy.run_path(str(path))
    except (Exception, SystemExit) as problem:
        raise CourseError(f"{path} failed: {type(problem).__name__}: {problem}") from problem
