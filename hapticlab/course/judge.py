"""Whether a plain value is the one expected, and where it is not, which slip it looks like."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from . import design_answer
from .diagnose import EXACT, NEAR, known, slip
from .match import plot_fault

if TYPE_CHECKING:
    from .exercise import Case, Exercise
    from .outcome import Outcome


@dataclass(frozen=True)
class Verdict:
    """Whether one case is right, and the words for it: what differs, and the sentence that teaches.

    ``slip`` is that sentence alone, where a known mistake is recognised; it is a part of ``words``. It is always one of the
    package's or of a case: no word of it comes from where the answer was evaluated. ``share`` is the part of the points that
    the case allows, less than 1 where a design dominates some reference points but not enough.
    """

    right: bool
    words: str
    slip: str = ""
    share: float = field(default=0.0, repr=False)


def judge(exercise: Exercise, case: Case, value: Any) -> Verdict:
    """Compare a plain value with what a case expects.

    Parameters
    ----------
    exercise : Exercise
    case : Case
    value : float, bool, str, list or dict of these
        As :func:`hapticlab.course.evaluate.plain` returns it.

    Returns
    -------
    Verdict

    Examples
    --------
    >>> from hapticlab.course.exercise import Case, Exercise
    >>> force = Exercise("force")
    >>> judge(force, Case({}, 2.25, unit="N"), 2.25)
    Verdict(right=True, words='2.25 N', slip='')
    >>> judge(force, Case({}, 2.25, unit="N"), -2.25)
    Verdict(right=False, words='-2.25 N, expected 2.25 N. The sign is wrong.', slip='The sign is wrong.')
    """
    expected, hidden = case.expected, exercise.kind in ("value", "choice")
    if exercise.kind == "design":
        return _judge_design(exercise, case, value)
    if exercise.kind == "plot":
        return _judge_plot(exercise, case, value)
    if isinstance(expected, str | bool):
        return _judge_word(exercise, case, value)
    if isinstance(expected, dict):
        return _judge_parts(exercise, case, value)
    wanted, got = np.array(expected, float), _numbers(value)
    if got is None:
        alone = ", without quotes and unit" if isinstance(value, str) else ""
        return Verdict(False, f"{_kind(value)}, needs {_shape_words(wanted.shape)}{alone}")
    if got.shape != wanted.shape and np.squeeze(got).shape == np.squeeze(wanted).shape:
        got = got.reshape(wanted.shape)  # an array of one number, a column
    if got.shape != wanted.shape:
        return Verdict(False, f"{_shape_words(got.shape)}, needs {_shape_words(wanted.shape)}")
    if within(exercise, wanted, got):
        return Verdict(True, f"{got.size} points" if exercise.kind == "expression" else _value(got, case.unit))
    words = _difference(exercise, case, wanted, got, hidden)
    return _taught(words, slip(exercise, case, wanted, got))


def _judge_design(exercise, case, value):
    """Judge a design: right where it dominates enough reference points of the scene."""
    part, words = design_answer.share(exercise, case, value), design_answer.words(exercise, case, value)
    if part >= 1:
        return Verdict(True, words, share=1.0)
    return replace(_taught(words, design_answer.slip(case, value)), share=part)


def _taught(words, sentence):
    """Return the verdict on what is wrong, in words, with the sentence that teaches, if there is one."""
    return Verdict(False, f"{words}. {sentence}".strip(), sentence)


def verdict(exercise: Exercise, case: Case, outcome: Outcome) -> Verdict:
    """Return the verdict on what an answer gave.

    Its ``problem`` is told in the words and is no slip: in a grader it comes from the process of the student's code.
    """
    if not outcome.answered:
        return Verdict(False, "no answer")
    if outcome.value is None:
        return Verdict(False, outcome.problem)
    with np.errstate(all="ignore"):  # what overflows here is as wrong as any other number
        found = judge(exercise, case, outcome.value)
    if found.right or not outcome.problem:
        return found
    return Verdict(False, f"{found.words} {outcome.problem}", found.slip)


def within(exercise, wanted, got):
    """Whether every number is as near as the exercise asks; NaN is near nothing."""
    return bool((np.abs(got - wanted) <= _band(exercise, wanted)).all())


def _band(exercise, wanted):
    return exercise.atol + exercise.rtol * np.abs(wanted).max(initial=0)


def _judge_word(exercise, case, value):
    expected = case.expected
    if isinstance(expected, bool) != isinstance(value, bool) or isinstance(expected, str) != isinstance(value, str):
        return Verdict(False, f"{_kind(value)}, needs {_kind(expected)}")
    if _word(value) == _word(expected):
        return Verdict(True, str(value)[:60])
    if exercise.options and _word(value) not in map(_word, exercise.options):
        return Verdict(False, f"{value[:60]!r}, needs one of {', '.join(map(repr, exercise.options))}")
    told = "not this one" if exercise.kind in ("value", "choice") else f"expected {expected}"
    taught = (sentence for wrong, sentence in case.slips if _word(wrong) == _word(value))
    return _taught(f"{str(value)[:60]}: {told}", next(taught, ""))


def _word(value):
    """Return a text for comparison: the key of a choice may be written "(c)" or "c)", as options are printed."""
    return value.strip().strip("().").strip().casefold() if isinstance(value, str) else value


def _judge_parts(exercise, case, value):
    """Judge a dict part by part; of its wrong ones that speaks which is best known; a slip is a dict of what it is about."""
    if not isinstance(value, dict):
        return Verdict(False, f"{_kind(value)}, needs a dict with {', '.join(case.expected)}")
    missing = [name for name in case.expected if name not in value]
    if missing:
        return Verdict(False, f"a dict with {', '.join(map(str, value))[:60] or 'nothing'}; {missing[0]} is missing")
    wrong = []
    for name, expected in case.expected.items():
        slips = tuple((wrong[name], s) for wrong, s in case.slips if isinstance(wrong, dict) and name in wrong)
        about = replace(case, expected=expected, slips=slips)
        part = judge(exercise, about, value[name])
        if not part.right:
            wrong.append((_strangeness(exercise, about, value[name]), Verdict(False, f"{name}: {part.words}", part.slip)))
    return min(wrong, key=lambda one: one[0])[1] if wrong else Verdict(True, ", ".join(case.expected))


def _strangeness(exercise, case, value):
    """Return how far a wrong answer is from a slip of the case: 0 on it, 1 near it, 2 far from each."""
    matches = [known(exercise, case, _numbers(value), near) for near in (EXACT, NEAR)]
    return next((rank for rank, sentence in enumerate(matches) if sentence), len(matches))


def _judge_plot(exercise, case, value):
    """Judge the curves of a plot; a slip holds wrong ones, in the same form."""
    words, mixed_up = plot_fault(case.expected, value, exercise.rtol, exercise.atol)
    if not words:
        return Verdict(True, f"{len(value)} curve{'s' * (len(value) > 1)}")
    for wrong, sentence in case.slips:
        if not plot_fault(wrong, value, exercise.rtol, exercise.atol)[0]:
            return _taught(words, sentence)
    return _taught(words, mixed_up)


def _numbers(value):
    """Return an array, or None of what holds no numbers."""
    if isinstance(value, bool | str | dict):
        return None
    try:
        return np.array(value, float)
    except (TypeError, ValueError):
        return None


def _difference(exercise, case, wanted, got, hidden):
    """Say what is wrong; what a value should be is not told, it is the answer itself."""
    unit = case.unit
    if wanted.ndim == 0:
        if hidden:
            return f"{_value(got, unit)}: not yet"
        digits = _digits(got, wanted)
        return f"{_value(got, unit, digits)}, expected {_value(wanted, unit, digits)}"
    wrong = ~(np.abs(got - wanted) <= _band(exercise, wanted))
    index = tuple(int(i) for i in np.argwhere(wrong)[0])
    place = f"[{', '.join(map(str, index))}]"
    digits = 6 if hidden else _digits(got[index], wanted[index])
    expected = "not yet" if hidden else f"expected {_value(wanted[index], unit, digits)}"
    if exercise.kind == "expression":
        point = ", ".join(f"{name} = {column[index[0]]:g}" for name, column in case.given["at"].items())
        shown = f"{_value(got[index], unit, digits)}, {expected}"
        return f"{int(wrong.sum())} of {wrong.size} points differ, first at {point}: {shown}"
    return f"{int(wrong.sum())} of {wrong.size} numbers differ, first {place}: {_value(got[index], unit, digits)}, {expected}"


def _digits(one, other):
    """The number of digits that tell two numbers apart, six at least."""
    return next((d for d in range(6, 17) if f"{float(one):.{d}g}" != f"{float(other):.{d}g}"), 17)


def _value(number, unit, digits=6):
    if np.ndim(number):
        return f"{np.size(number)} numbers"
    return f"{float(number) + 0.0:.{digits}g} {unit}".strip()  # no sign on a zero


def _shape_words(shape):
    if shape == ():
        return "one number"
    if shape == (1,):
        return "an array of one number"
    return f"{shape[0]} numbers" if len(shape) == 1 else f"an array of shape {shape}"


def _kind(value):
    kinds = {bool: "True or False", str: "a text", dict: "a dict", list: "a list"}
    return kinds.get(type(value), "a number")
