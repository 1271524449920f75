"""hl.check: an answer is judged at once, in the notebook, by the public cases of its exercise."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..base.in_notebook import display, in_a_notebook
from ..errors import CourseError
from ..slips.own_line import of_call
from ..slips.swallowed import swallowed
from .cards.card import Card
from .cards.progress import remember
from .cards.rows import case_rows, drawn, printed, state, without_slip
from .evaluate import evaluate
from .judge import verdict
from .labs import find_lab

if TYPE_CHECKING:
    from .exercise import Exercise
    from .judge import Verdict


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
    card : Card
    """

    name: str
    passed: bool
    answered: bool
    verdicts: tuple[Verdict, ...]
    card: Card

    @property
    def text(self) -> str:
        """The card in lines, as it is printed."""
        return self.card.text()

    def require(self) -> None:
        """Raise AssertionError with the text unless the check passed: for a test cell of nbgrader."""
        if not self.passed:
            raise AssertionError(self.text)

    def __str__(self) -> str:
        return self.text

    def _ipython_display_(self) -> None:
        """Show nothing: the check has shown it."""


def check(name: str, answer: object) -> CheckResult:
    """Check an answer with the public cases of its exercise and show a card; no error is raised.

    In a notebook the card is HTML, and the exercises that are right are recorded in a file next to the notebook, which
    counts for no mark. Outside a notebook the card is printed.

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
    lab, exercise = None, None
    try:
        lab, exercise = _found(name)
        result = checked(name, exercise, answer)
    except CourseError as problem:
        result = _failed(name, str(problem))
    except Exception as problem:  # a mistake of a lab's author stops no student
        result = _failed(name, f"the check itself failed, which is not your mistake: {type(problem).__name__}: {problem}")
    own = of_call()
    if own and result.answered and not result.passed and (lost := swallowed(own, "")):
        result = _with_rows(result, ("in your line", lost))
    if in_a_notebook():
        if lab and exercise and exercise.judged and exercise.cases:
            rows = _progress(lab, exercise, result.passed)
            result = _with_rows(result, *rows) if result.answered else result
        display({"text/plain": result.text, "text/html": result.card.html()})
    else:
        print(result.text)
    return result


def _failed(name, words):
    name = name[:60] if isinstance(name, str) else "hl.check"
    return CheckResult(name, False, False, (), Card(name, "open", words))


def _with_rows(result, *rows):
    return replace(result, card=replace(result.card, rows=(*result.card.rows, *rows)))


def _progress(lab, exercise, right):
    """Remember whether an exercise is right; return rows on how much of the lab is, and on what is next."""
    done = remember(Path.cwd(), lab.number, exercise.name, right)
    judged = [one.name for one in lab.exercises if one.judged and one.cases]
    left = [name for name in judged if name not in done]
    rows = [("this lab", f"{len(judged) - len(left)} of {len(judged)} exercises right in the public cases (counts for no mark)")]
    if right and left:  # the first after this one, or of those that were left out
        after = judged.index(exercise.name)
        rows.append(("next", next((name for name in judged[after:] if name in left), left[0])))
    return rows


def _found(name):
    """Return lab and exercise of a name such as "01.wall_force", from the checks beside the notebook or the package's."""
    lab, _, exercise = (part.strip() for part in name.partition(".")) if isinstance(name, str) else ("", "", "")
    if not (lab and exercise):
        raise CourseError('needs lab and exercise first, such as hl.check("01.wall_force", wall_force)')
    found = find_lab(lab.zfill(2), beside=Path.cwd())
    return found, found.exercise(exercise)


def checked(name: str, exercise: Exercise, answer: object) -> CheckResult:
    """Return the result for one exercise, by its public cases."""
    if not exercise.judged or not exercise.cases:
        return _noted(name, exercise, answer)
    outcomes = [evaluate(exercise.kind, answer, case.given) for case in exercise.cases]
    if not any(outcome.answered for outcome in outcomes):
        return _unanswered(name, exercise)
    verdicts = tuple(verdict(exercise, case, outcome) for case, outcome in zip(exercise.cases, outcomes, strict=True))
    passed = all(v.right for v in verdicts)
    verdicts = _of_the_lab(exercise, verdicts)
    rows = (*case_rows(exercise, verdicts), *printed(outcomes))
    rows += (("why it matters", exercise.matters),) if exercise.matters and passed else ()
    went, head = state(verdicts)
    card = Card(name, went, head, f"worth {points_words(exercise.points)}", rows, drawn(exercise, outcomes, verdicts))
    return CheckResult(name, passed, True, verdicts, card)


def _of_the_lab(exercise, verdicts):
    """Return verdicts without guesses that fit any exercise, where the lab's own sentences know one of them."""
    own = {sentence for case in exercise.cases for _, sentence in case.slips}
    if not any(v.slip in own for v in verdicts):
        return verdicts
    return tuple(v if v.slip in own else replace(v, words=without_slip(v), slip="") for v in verdicts)


def points_words(points: float) -> str:
    """Return a number of points in words."""
    return f"{points:g} point{'' if points == 1 else 's'}"


def _noted(name, exercise, answer):
    """Return the result for what is handed in and not judged here."""
    outcome = evaluate("value", answer, {})
    if not outcome.answered:
        return _unanswered(name, exercise)
    words = len(outcome.value.split()) if isinstance(outcome.value, str) else 0
    if outcome.problem:
        return CheckResult(name, False, True, (), Card(name, "wrong", outcome.problem))
    if words < exercise.least_words:
        said = f"{words} words; needs at least {exercise.least_words}: {exercise.asks}"
        return CheckResult(name, False, True, (), Card(name, "wrong", said))
    later = {"prediction": "saved; compare it with your result", "text": f"{words} words saved; a person reads them"}
    said = later.get(exercise.kind, "saved; it is checked when you hand it in")
    return CheckResult(name, True, True, (), Card(name, "saved", said))


def _unanswered(name, exercise):
    return CheckResult(name, False, False, (), Card(name, "open", f"not answered yet: {exercise.asks}"))
