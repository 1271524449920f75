"""Which slip a wrong number looks like, from the numbers alone: what an answer gave, what is expected, where."""

import itertools
import math

import numpy as np

SQUARED = "Was a value in millimetres or milliseconds squared? Convert it to SI units first."
#: what a result is often off by, and what that says
FACTORS = (
    (-1.0, "The sign is wrong."),
    (1e3, "It is 1000 times too large: is a value in millimetres or milliseconds instead of SI units?"),
    (1e-3, "It is 1000 times too small: is a value in millimetres or milliseconds instead of SI units?"),
    (1e6, f"It is 1000000 times too large. {SQUARED}"),
    (1e-6, f"It is 1000000 times too small. {SQUARED}"),
    (100.0, "It is 100 times too large: is it in percent instead of a fraction of one, or in centimetres?"),
    (-1e3, "The sign is wrong, and the value is 1000 times too large: is it in millimetres?"),
    (-1e-3, "The sign is wrong, and the value is 1000 times too small: is a length in millimetres?"),
    (180 / math.pi, "It is in degrees, but radians are expected."),
    (math.pi / 180, "It is too small by pi/180: an angle in radians was treated as degrees."),
    (2 * math.pi, "It is 2 pi times too large: Hz and rad/s are mixed up."),
    (1 / (2 * math.pi), "It is 2 pi times too small: Hz and rad/s are mixed up."),
    (2.0, "It is twice as large as expected: is a factor 1/2 missing, or is there a factor 2 too many?"),
    (0.5, "It is half as large as expected: is a factor 2 missing, or is there a factor 1/2 too many?"),
)
#: how near a wrong number must come to such a factor, or to a slip of the case; of several slips the exact one speaks
EXACT, NEAR = 1e-6, 1e-3
PULLS = "The sign is wrong: your force pulls. F_e is the force ON the environment, positive into it, Eq. (23.1)."


def slip(exercise, case, wanted, got):
    """Return the sentence for what went wrong, or an empty text.

    Parameters
    ----------
    exercise : Exercise
    case : Case
        Its own slips come first.
    wanted, got : ndarray
        Of the same shape; they differ.

    Examples
    --------
    >>> from hapticlab.course.exercise import Case, Exercise
    >>> slip(Exercise("f"), Case({}, 2.0), np.array(2.0), np.array(2000.0))[:30]
    'It is 1000 times too large: is'
    """
    if not np.isfinite(got).all():
        return "NaN (not a number) or infinity comes from 0/0, from the root of a negative number, or from too large a number."
    for near in (EXACT, NEAR):
        if sentence := known(exercise, case, got, near):
            return sentence
    if np.abs(wanted).max(initial=0) <= exercise.atol:
        return ""
    if exercise.kind == "expression" and case.unit == "N" and wanted.min() >= 0 and _close(-wanted, got):
        return PULLS
    for factor, sentence in FACTORS:
        # without an absolute part: beside 1e-6 of a small number, zero and rounding look alike
        if _close(factor * wanted, got, min(max(NEAR, exercise.rtol), 0.1), least=0):
            return sentence + _given_by_chance(case.given, factor)
    if exercise.kind == "expression":
        return over_points(case.given["at"], wanted, got)
    one_side = _one_side(wanted, got) if got.size > 3 and case.unit == "N" else ""
    return _in_time(wanted, got) or one_side or _nearly(wanted, got, case.given)


def known(exercise, case, got, near):
    """Return the sentence of the case's own slip that a wrong answer comes as near to, or an empty text."""
    for wrong, sentence in case.slips:
        wrong = np.array(wrong, float)
        if got is not None and wrong.shape == got.shape and _close(wrong, got, max(near, exercise.rtol)):
            return sentence
    return ""


def _in_time(wanted, got):
    if wanted.ndim == 1 and wanted.size > 3 and np.ptp(wanted) > 0:
        if _close(wanted[:-1], got[1:]):
            return "It is one sample late."
        if _close(wanted[1:], got[:-1]):
            return "It is one sample early."
    return ""


def _nearly(wanted, got, given):
    if not _close(wanted, got, 1e-2):
        return ""
    has_g = any("g" in names for names in (given, *given.values()) if isinstance(names, dict))
    other = "is your g different, such as 9.8 instead of 9.81 m/s^2" if has_g else "is a small term missing"
    return f"It is within one percent: is a number rounded, or {other}?"


def _close(wrong, got, near=NEAR, least=1e-12):
    return bool((np.abs(got - wrong) <= near * np.abs(wrong).max(initial=0) + least).all())


def _given_by_chance(given, factor):
    """Return a second guess where a given number explains the factor as well, such as T = 1 ms; or an empty text."""
    numbers = {name: one for name, one in given.items() if isinstance(one, int | float) and one > 0}
    for (name, one), power in itertools.product(numbers.items(), (1, -1, 2, -2)):
        if math.isclose(one**power, abs(factor), rel_tol=NEAR) and abs(factor) != 1:
            symbol = name if abs(power) == 1 else f"{name}^2"
            number = f"{one ** abs(power):g}"
            return f" In this case {symbol} = {number}, so a factor {symbol} may also be missing, or there may be one too many."
    return ""


def over_points(at, wanted, got):
    """Return the sentence for an expression that is wrong at points, or an empty text.

    What it depends on is seen between points that differ in one symbol alone, so an author's points hold such pairs, see
    :func:`hapticlab.course.variants.points`.

    Parameters
    ----------
    at : dict of str to sequence of float
        Symbol to its value at each point.
    wanted, got : ndarray, shape (points,)

    Examples
    --------
    >>> at = {"k": [100.0, 100.0, 300.0], "x(n)": [0.01, 0.02, 0.02]}
    >>> over_points(at, np.array([1.0, 2.0, 6.0]), np.array([0.01, 0.02, 0.02]))
    'It does not change with k: did you forget k?'
    """
    at = {name: np.array(column, float) for name, column in at.items()}
    if not got.any():
        return "It is zero at every point."
    return _one_side(wanted, got) or _dependence(at, wanted, got) or _nearly(wanted, got, {"at": at}) or _factor(at, wanted, got)


def _dependence(at, wanted, got):
    """Name a symbol that is forgotten, or that should not be there."""
    pairs = {name: [] for name in at}
    for i, j in itertools.combinations(range(len(wanted)), 2):
        differ = [name for name, column in at.items() if column[i] != column[j]]
        if len(differ) == 1:
            pairs[differ[0]].append((i, j))
    for name, several in pairs.items():
        asked = [(i, j) for i, j in several if not _same(wanted[i], wanted[j])]
        if asked and all(_same(got[i], got[j]) for i, j in asked):
            return f"It does not change with {name}: did you forget {name}?"
        acting = [(i, j) for i, j in several if abs(wanted[i]) > 1e-9 * np.abs(wanted).max()]  # zero depends on nothing
        if acting and not asked and any(not _same(got[i], got[j]) for i, j in acting):
            return f"It changes with {name}, on which it should not depend."
    return ""


def _same(one, other):
    return abs(one - other) <= 1e-9 * max(abs(one), abs(other))


def _factor(at, wanted, got):
    """Name a factor too many or too few: a symbol, by its powers, or a number."""
    there = np.abs(wanted) > 1e-9 * np.abs(wanted).max()
    if there.sum() < 3 or not _close(0 * wanted[~there], got[~there]) or not np.abs(got[there]).all():
        return ""
    ratio = got[there] / wanted[there]
    if _constant(ratio):
        return f"It is {ratio.mean():.4g} times the expected value, at every point."
    for power, name in itertools.product((1, -1, 2, -2), at):
        column = at[name][there]
        if not column.all() or _constant(column):
            continue
        rest = ratio / column**power
        if _constant(rest):
            return f"{_too_often(name, power)}{_beside(rest.mean())}"
    return ""


def _too_often(name, power):
    symbol = name if abs(power) == 1 else f"{name}^{abs(power)}"
    if power > 0:
        return f"It is {symbol} times too large, so its unit is wrong: should it be divided by {symbol}?"
    return f"A factor {symbol} is missing, so its unit is wrong: did you divide by {symbol}, or forget to multiply by it?"


def _beside(factor):
    if abs(factor - 1) < NEAR:
        return ""
    return " The sign is also wrong." if abs(factor + 1) < NEAR else f" In addition, it is {factor:.4g} times too large."


def _constant(ratio):
    return bool(np.ptp(ratio) <= NEAR * np.abs(ratio).max())


def _one_side(wanted, got):
    """Say which side of a boundary is wrong, where one side of it is zero."""
    outside = np.abs(wanted) <= 1e-9 * np.abs(wanted).max()
    if not outside.any() or not got.any():
        return ""
    right = np.isclose(got, wanted, rtol=NEAR, atol=1e-9 * np.abs(wanted).max())
    if right[~outside].all() and not right[outside].all():
        missing = "is a condition missing or too wide? A scene writes it hl.when(condition, force, 0)."
        return f"It is right where the force should act, but not zero where no force should act: {missing}"
    if not got[~outside].any():
        turned = "its condition is reversed, such as <= instead of >=."
        return f"It acts where no force should act, and is zero where a force should act: {turned}"
    if right[outside].all() and not got[~outside].all():
        return "It is zero at points where a force should act: is its condition too narrow?"
    return ""
