"""Whether a plain value is the one expected, and where it is not, which slip it looks like."""

import math
from dataclasses import dataclass

import numpy as np

#: what a result is often off by, and what that says
FACTORS = (
    (-1.0, "The sign is turned."),
    (1e3, "It is 1000 times too large: is something in millimetres or milliseconds that belongs in SI?"),
    (1e-3, "It is 1000 times too small: is something in millimetres or milliseconds that belongs in SI?"),
    (100.0, "It is 100 times too large: percent where a share of one is asked for, or centimetres?"),
    (-1e3, "The sign is turned, and it is 1000 times too large: millimetres?"),
    (-1e-3, "The sign is turned, and it is 1000 times too small: millimetres?"),
    (180 / math.pi, "It is in degrees; radians are asked for."),
    (math.pi / 180, "It is too small by pi/180: an angle in radians was taken for degrees."),
    (2 * math.pi, "It is 2 pi times too large: Hz and rad/s are mixed."),
    (1 / (2 * math.pi), "It is 2 pi times too small: Hz and rad/s are mixed."),
    (2.0, "It is twice what is expected."),
    (0.5, "It is half of what is expected."),
)
#: how near a wrong number must come to such a factor, or to a slip of the case
NEAR = 1e-3


@dataclass(frozen=True)
class Verdict:
    """Whether one case is right, and the words for it: what differs, and the sentence that teaches.

    ``slip`` is that sentence alone, where a known mistake is recognised; it is a part of ``words``.
    """

    right: bool
    words: str
    slip: str = ""


def judge(exercise, case, value):
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
    Verdict(right=False, words='-2.25 N, expected 2.25 N. The sign is turned.', slip='The sign is turned.')
    """
    expected, hidden = case.expected, exercise.kind in ("value", "choice")
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
        return Verdict(True, _value(got, case.unit))
    words = _difference(wanted, got, case.unit, exercise, hidden)
    return _taught(words, _slip(case, exercise, wanted, got))


def _taught(words, slip):
    """Return the verdict on what is wrong, in words, with the sentence that teaches, if there is one."""
    return Verdict(False, f"{words}. {slip}".strip(), slip)


def verdict(exercise, case, outcome):
    """Return the verdict on what an answer gave."""
    if not outcome.answered:
        return Verdict(False, "no answer")
    if outcome.problem:
        return Verdict(False, outcome.problem)
    with np.errstate(all="ignore"):  # what overflows here is as wrong as any other number
        return judge(exercise, case, outcome.value)


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
    return value.strip().casefold() if isinstance(value, str) else value


def _judge_parts(exercise, case, value):
    """Judge a dict part by part; its first wrong one speaks, a slip is a dict of what it is about."""
    if not isinstance(value, dict):
        return Verdict(False, f"{_kind(value)}, needs a dict with {', '.join(case.expected)}")
    missing = [name for name in case.expected if name not in value]
    if missing:
        return Verdict(False, f"a dict with {', '.join(map(str, value))[:60] or 'nothing'}; {missing[0]} is missing")
    for name, expected in case.expected.items():
        slips = tuple((wrong[name], s) for wrong, s in case.slips if isinstance(wrong, dict) and name in wrong)
        part = judge(exercise, type(case)({}, expected, case.unit, slips), value[name])
        if not part.right:
            return Verdict(False, f"{name}: {part.words}", part.slip)
    return Verdict(True, ", ".join(case.expected))


def _numbers(value):
    """Return an array, or None of what holds no numbers."""
    if isinstance(value, bool | str | dict):
        return None
    try:
        return np.array(value, float)
    except (TypeError, ValueError):
        return None


def _difference(wanted, got, unit, exercise, hidden):
    """Say what is wrong; what a value should be is not told, it is the answer itself."""
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
    return f"{int(wrong.sum())} of {wrong.size} numbers differ, first {place}: {_value(got[index], unit, digits)}, {expected}"


def _digits(one, other):
    """Return how many digits tell two numbers apart, six at least."""
    return next((d for d in range(6, 17) if f"{float(one):.{d}g}" != f"{float(other):.{d}g}"), 17)


def _slip(case, exercise, wanted, got):
    """Return the sentence for what went wrong, or an empty text."""
    if not np.isfinite(got).all():
        return "NaN (no number) or infinity comes of 0/0, of the root of a negative number, or of too large a number."
    for wrong, sentence in case.slips:
        wrong = np.array(wrong, float)
        if wrong.shape == got.shape and _close(wrong, got, max(NEAR, exercise.rtol)):
            return sentence
    if np.abs(wanted).max(initial=0) <= exercise.atol:
        return ""
    for factor, sentence in FACTORS:
        if _close(factor * wanted, got, min(max(NEAR, exercise.rtol), 0.1)):
            return sentence
    if wanted.ndim == 1 and wanted.size > 3 and np.ptp(wanted) > 0:
        if _close(wanted[:-1], got[1:]):
            return "It is one sample late."
        if _close(wanted[1:], got[:-1]):
            return "It is one sample early."
    if _close(wanted, got, 1e-2):
        return "It is within one percent: is a number rounded, or a constant another, such as 9.8 for 9.81 m/s^2?"
    return ""


def _close(wrong, got, near=NEAR):
    return bool((np.abs(got - wrong) <= near * np.abs(wrong).max(initial=0) + 1e-12).all())


def _value(number, unit, digits=6):
    if np.ndim(number):
        return f"{np.size(number)} numbers"
    return f"{float(number):.{digits}g} {unit}".strip()


def _shape_words(shape):
    if shape == ():
        return "one number"
    if shape == (1,):
        return "an array of one number"
    return f"{shape[0]} numbers" if len(shape) == 1 else f"an array of shape {shape}"


def _kind(value):
    kinds = {bool: "True or False", str: "a text", dict: "a dict", list: "a list"}
    return kinds.get(type(value), "a number")
