"""hl.check: an answer is judged at once, in the notebook, by the public cases of its exercise."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import CourseError
from ..slips.own_line import of_call
from ..slips.swallowed import swallowed
from .evaluate import evaluate
from .judge import verdict
from .labs import find_lab

if TYPE_CHECKING:
    from .exercise import Exercise
    from .judge import Verdict

#: of what a student's code prints while it is checked
MOST_LINES, MOST_CHARACTERS = 10, 200


@dataclass(frozen=True)
class CheckResult:
    """What a check found.

    Attributes
    ----------
    name : str
        Lab and exercise, "01.wall_force".
    passed : bool
        Every case is right; of what is only noted, that something is there.
    answered : bool
    verdicts : tuple of Verdict
    text : str
        What was printed.
    """

    name: str
    passed: bool
    answered: bool
    verdicts: tuple[Verdict, ...]
    text: str

    def require(self) -> None:
        """Raise AssertionError with the text unless the check passed: for a test cell of nbgrader."""
        if not self.passed:
            raise AssertionError(self.text)

    def __str__(self) -> str:
        return self.text

    def _ipython_display_(self) -> None:
        """Show nothing: the check has printed it."""


def check(name: str, answer: object) -> CheckResult:
    """Check an answer by the public cases of its exercise; prints, and never raises.

    Parameters
    ----------
    name : str
        Lab and exercise, ``"01.wall_force"``.
    answer : object
        The function, scene, number or text asked for.

    Returns
    -------
    CheckResult

    Examples
    --------
    >>> import hapticlab as hl
    >>> result = hl.check("99.wall_force", lambda x: 200 * x)
    99.wall_force: there is no lab 99; there are ...
    >>> result.passed
    False
    """
    try:
        result = checked(name, _exercise(name), answer)
    except CourseError as problem:
        result = _failed(name, problem)
    except Exception as problem:  # a mistake of a lab's author stops no student
        result = _failed(name, f"the check itself failed, which is no fault of yours: {type(problem).__name__}: {problem}")
    own = of_call()
    if own and result.answered and not result.passed and (lost := swallowed(own, "")):
        result = replace(result, text=f"{result.text}\n  {lost}")
    print(result.text)
    return result


def _failed(name, words):
    name = name[:60] if isinstance(name, str) else "hl.check"
    return CheckResult(name, False, False, (), f"{name}: {words}")


def _exercise(name):
    """Return the exercise of a name such as "01.wall_force", from the checks beside the notebook or the package's."""
    lab, _, exercise = (part.strip() for part in name.partition(".")) if isinstance(name, str) else ("", "", "")
    if not (lab and exercise):
        raise CourseError('needs lab and exercise first, such as hl.check("01.wall_force", wall_force)')
    return find_lab(lab.zfill(2), beside=Path.cwd()).exercise(exercise)


def checked(name: str, exercise: Exercise, answer: object) -> CheckResult:
    """Return the result for one exercise, by its public cases."""
    if not exercise.judged or not exercise.cases:
        return _noted(name, exercise, answer)
    outcomes = [evaluate(exercise.kind, answer, case.given) for case in exercise.cases]
    if not any(outcome.answered for outcome in outcomes):
        return CheckResult(name, False, False, (), _unanswered(name, exercise))
    verdicts = tuple(verdict(exercise, case, outcome) for case, outcome in zip(exercise.cases, outcomes, strict=True))
    passed = all(v.right for v in verdicts)
    verdicts = _of_the_lab(exercise, verdicts)
    lines = [f"{name}: {'right' if passed else 'not right yet'} ({points_words(exercise.points)})"]
    lines += _printed(outcomes)
    lines += [_line(exercise, case, v) for case, v in zip(exercise.cases, verdicts, strict=True)]
    lines += [f"  hint: {exercise.hint}"] if exercise.hint and not passed else []
    return CheckResult(name, passed, True, verdicts, "\n".join(lines))


def _of_the_lab(exercise, verdicts):
    """Return verdicts without guesses that fit any exercise, where the lab's own sentences know one of them."""
    own = {sentence for case in exercise.cases for _, sentence in case.slips}
    if not any(v.slip in own for v in verdicts):
        return verdicts
    return tuple(v if v.slip in own else replace(v, words=v.words.removesuffix(v.slip).rstrip(), slip="") for v in verdicts)


def points_words(points: float) -> str:
    """Return a number of points in words."""
    return f"{points:g} point{'' if points == 1 else 's'}"


def _noted(name, exercise, answer):
    """Return the result for what is handed in and not judged here."""
    outcome = evaluate("value", answer, {})
    if not outcome.answered:
        return CheckResult(name, False, False, (), _unanswered(name, exercise))
    if outcome.problem:
        return CheckResult(name, False, True, (), f"{name}: {outcome.problem}")
    words = len(outcome.value.split()) if isinstance(outcome.value, str) else 0
    if words < exercise.least_words:
        said = f"{words} words, needs at least {exercise.least_words}: {exercise.asks}"
        return CheckResult(name, False, True, (), f"{name}: {said}")
    later = {"prediction": "noted; compare it with what you find", "text": f"{words} words noted; a person reads them"}
    said = later.get(exercise.kind, "noted; it is judged when handed in")
    return CheckResult(name, True, True, (), f"{name}: {said}")


def _unanswered(name, exercise):
    return f"{name}: not answered yet: {exercise.asks}"


def _line(exercise, case, found):
    """Return a case in a line; of an expression the words name the point."""
    shown = {} if exercise.kind == "expression" else case.given
    given = ", ".join(f"{name} = {_brief(value)}" for name, value in shown.items())
    return f"  {'right' if found.right else 'wrong'}: {given + ': ' if given else ''}{found.words}"


def _brief(value):
    """Return a given in a few characters."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {_brief(part)}" for name, part in value.items()) + "}"
    if isinstance(value, list | tuple):
        shown = ", ".join(_brief(part) for part in value[:4])
        return f"[{shown}]" if len(value) <= 4 else f"[{shown}, ... {len(value)} in all]"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _printed(outcomes):
    """First lines that a student's code printed."""
    lines = "".join(outcome.printed for outcome in outcomes).splitlines()
    more = len(lines) - MOST_LINES
    return [f"  printed: {line[:MOST_CHARACTERS]}" for line in lines[:MOST_LINES]] + [f"  ... {more} lines more"] * (more > 0)
