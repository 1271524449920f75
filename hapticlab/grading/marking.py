"""What an exercise earns for what its answer gave: verdicts are made here, where no student's code runs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..course import design_answer
from ..course.judge import Verdict, verdict
from ..course.marks import DATA, earned_points
from .handed_in.replies import line_of, rounded, text_of
from .report import ExerciseReport, Failing

if TYPE_CHECKING:
    from ..course.outcome import Outcome
    from .sessions.limits import Limits

#: characters kept of the sentence on a wrong case
WORDS = 600
#: kinds whose answer is not told what a case gives
SHOWN = DATA


@dataclass(frozen=True)
class Found:
    """What an answer gave: an outcome for each case; or those before its process ended, and why it did.

    What was printed is ``told`` where none of its processes knew of a hidden case.
    """

    outcomes: tuple[Outcome, ...] = ()
    ended: str = ""
    told: bool = True


def ended_words(reason: str, limits: Limits) -> str:
    """Return in words why a process ended."""
    words = {
        "time": f"it was not finished after {limits.seconds:g} s",
        "memory": f"it needs more than {limits.memory / 2**20:g} MiB of memory",
        "processes": f"it starts more than {limits.processes} processes",
        "exit": "it ends the process it runs in",
        "flood": "it writes output endlessly",
        "garbage": "its result is not a value",
    }
    return words.get(reason, f"its process was ended by {reason}")


def exercise_report(exercise, cases, found, limits, slips=None):
    """Return the report on an exercise.

    Parameters
    ----------
    exercise : Exercise
    cases : sequence of (Case, bool)
        And whether it is public; of an exercise that is only noted, empty.
    found : Found
    limits : Limits
        Of which a word is said where one was met.
    slips : callable, optional
        Of exercise and given: what typical slips give in a case whose own slips are none of them.

    Returns
    -------
    ExerciseReport

    Examples
    --------
    >>> from hapticlab.course.evaluate import Outcome
    >>> from hapticlab.course.exercise import Case, Exercise
    >>> from hapticlab.grading.sessions.limits import Limits
    >>> exercise, case = Exercise("k", "value", points=2), Case({}, 150.0, unit="N/m")
    >>> report = exercise_report(exercise, [(case, True)], Found((Outcome(-150.0),)), Limits())
    >>> report.earned, report.words
    (0.0, '-150 N/m: not yet. The sign is wrong.')
    """
    about = {"name": exercise.name, "kind": exercise.kind, "asks": exercise.asks, "points": float(exercise.points)}
    if found.ended:
        words = ended_words(found.ended, limits)
        wrong = {"hint": exercise.hint} if exercise.judged else {}
        hidden = not any(public or exercise.kind in SHOWN for _, public in cases[len(found.outcomes) :])
        return ExerciseReport(
            **about, answered=True, cases=len(cases), words=words, ended=found.ended, ended_hidden=hidden, **wrong
        )
    if not exercise.judged:
        return ExerciseReport(**about, **_noted(exercise, found.outcomes))
    if exercise.kind == "design":  # one answer to all scenes: what a second evaluation gives does not count
        found = replace(found, outcomes=found.outcomes[:1] * len(cases))
    verdicts = [_verdict(exercise, case, outcome) for (case, _), outcome in zip(cases, found.outcomes, strict=False)]
    right = sum(one.right for one in verdicts)
    wrong = {"earned": float(earned_points(exercise, verdicts) if len(verdicts) == len(cases) else 0)}
    if not verdicts or right < len(cases):
        wrong |= _wrong(exercise, cases, found.outcomes, verdicts, slips)
    if exercise.kind == "design" and found.outcomes and isinstance(found.outcomes[0].value, dict):
        wrong["designs"] = _designs(exercise, cases, found.outcomes[0].value)
    return ExerciseReport(
        **about,
        answered=any(outcome.answered for outcome in found.outcomes),
        right=right,
        cases=len(cases),
        printed=_printed(cases, found.outcomes, limits.printed) if found.told else "",
        **wrong,
    )


def _verdict(exercise, case, outcome):
    try:
        return verdict(exercise, case, outcome)
    except Exception as problem:  # no value, however strange, may stop the grading of a class
        return Verdict(False, f"it cannot be compared ({type(problem).__name__})")


def _wrong(exercise, cases, outcomes, verdicts, slips):
    """The report on the first wrong case."""
    if not any(outcome.answered for outcome in outcomes):
        return {"words": "no answer", "hint": exercise.hint}
    first = next(number for number, one in enumerate(verdicts) if not one.right)
    (case, public), outcome, said = cases[first], outcomes[first], verdicts[first]
    if slips and not (said.slip or outcome.value is None):
        said = _verdict(exercise, replace(case, slips=tuple(slips(exercise, case.given))), outcome)
    expected = None if exercise.kind in SHOWN else rounded(case.expected)
    failing = Failing(rounded(dict(case.given)), rounded(outcome.value), expected, case.unit, public)
    return {"words": line_of(said.words, WORDS), "slip": line_of(said.slip, WORDS), "hint": exercise.hint, "failing": failing}


def _designs(exercise, cases, answer):
    """Return what a design was measured to do on each scene: the public ones, which all of a class share, and its own."""
    scenes = [(case, True) for case in exercise.cases] + [(case, public) for case, public in cases if not public]
    return tuple({**design_answer.row(case, answer), "public": public} for case, public in scenes)


def _noted(exercise, outcomes):
    """The report on a part that carries no points: the text, and what it lacks."""
    outcome = next(iter(outcomes), None)
    if outcome is None or not outcome.answered:
        return {"words": "no answer"}
    if outcome.problem:
        return {"answered": True, "words": outcome.problem}
    text = outcome.value if isinstance(outcome.value, str) else str(rounded(outcome.value))
    words = len(text.split())
    lacking = f"{words} words; needs at least {exercise.least_words}" if words < exercise.least_words else ""
    return {"answered": True, "text": text_of(text), "words": lacking}


def _printed(cases, outcomes, most):
    """Output in public cases; in the others it would tell their givens."""
    shown = (outcome.printed for (_, public), outcome in zip(cases, outcomes, strict=False) if public)
    return text_of("".join(shown), most)
