"""The first wrong case of an exercise on a student's page: what was given, what came, and what was expected."""

import re
from functools import lru_cache

import numpy as np

from ...course.cards.case_figures import WrongCase, figures, is_curve, numbers
from ...course.cards.page_text import pair, shown
from ...course.labs import find_labs

#: lists of more numbers are told by their first ones, tables of more too; a figure shows all
MOST_NUMBERS, MOST_ROWS = 6, 24
#: what is given to a scene, whose words need not say it
OF_SCENES = {"x": "m", "v": "m/s", "T": "s"}
#: of names that mean the same in every lab that comes with the package, where no exercise says another unit
OF_LABS = {
    "x": "m", "x_o": "m", "x_goal": "m", "z": "m", "l": "m", "D": "m", "gap": "m", "v": "m/s", "v0": "m/s", "v_goal": "m/s",
    "rate": "m/s", "g": "m/s^2", "t": "s", "T": "s", "h": "s", "m": "kg", "M": "kg", "F": "N", "F_max": "N", "force_max": "N",
    "k": "N/m", "K": "N/m", "b": "N s/m", "b_c": "N s/m", "b_low": "N s/m", "b_high": "N s/m", "b_added": "N s/m", "B": "N s/m",
    "theta": "rad", "omega": "rad/s", "credit": "J", "hz": "Hz", "metres_per_count": "m", "grams": "g",
}  # fmt: skip
#: of an exercise that the lab does not have
TOLERANCE = 1e-6, 1e-12


def drawn(one, lab):
    """Pairs of an SVG and what it says in words, one for each list of the case."""
    case = one.failing
    wrong = WrongCase(one.name, one.kind, case.given, case.value, case.expected, case.unit)
    return figures(wrong, lambda name, other: unit_of(name, one, lab, other))


def unit_of(name, one, lab, otherwise=""):
    """Return the unit that the words of an exercise give a name, "x [m]", or those of all others alike."""
    own, others = _told(name, one.asks), {_told(name, other.asks) for other in lab.exercises} - {""}
    if own or len(others) == 1:
        return own or others.pop()
    return otherwise


def _told(name, asks):
    """Return the unit behind a name.

    Examples
    --------
    >>> _told("D", "the work [J] at x [m], moving by D [m]"), _told("p", '{"v": [m/s], "p": impulse [N s]}')
    ('m', 'N s')
    """
    found = re.search(rf'(?<!\w){re.escape(name[:60])}(?: |": [^"\[\],]*)\[([^\]]{{1,20}})\]', asks)
    return found[1] if found else ""


def given(one, lab):
    """Rows (name, value, unit) of what was given."""
    flat: dict = {}
    units = OF_LABS if lab.title == _title(lab.number) else OF_SCENES if one.kind == "scene" else {}
    for name, value in one.failing.given.items():
        flat |= value if isinstance(value, dict) else {name: value}
    few = [(str(name), value) for name, value in [*flat.items()][:MOST_ROWS]]
    return [(name, shown(value), unit_of(name, one, lab, units.get(name, ""))) for name, value in few]


@lru_cache
def _title(number):
    """Return the title of the lab of that number that came with the package."""
    return next((folder.lab().title for folder in find_labs() if folder.number == number), None)


def options(one, lab):
    """Pairs (key, words) of a choice."""
    return next(([*e.options.items()] for e in lab.exercises if e.name == one.name), [])


def compared(one, lab):
    """Rows (name, got, alike, expected, unit) of the case; long lists in a few numbers."""
    case, rows = one.failing, []
    several = isinstance(case.expected, dict)
    for name, got, expected, alike in [*_rows(one.name, case.value, case.expected, _tolerance(one, lab))][:MOST_ROWS]:
        came, wanted = (shown(got), shown(expected)) if alike else pair(got, expected)
        unit = unit_of(name, one, lab, case.unit) if several else case.unit
        rows.append((name, "nothing" if got is None else came, alike, wanted, unit))
    return rows


def _tolerance(one, lab):
    return next(((e.rtol, e.atol) for e in lab.exercises if e.name == one.name), TOLERANCE)


def _rows(name, got, expected, tolerance, depth=0):
    """Yield name, what came, what was expected, and whether these are near enough; in single values where they are few."""
    if is_curve(expected):  # its numbers are in the figure
        for key in ("x_unit", "y_unit"):
            pair_of = (got.get(key) if isinstance(got, dict) else None), expected.get(key)
            yield f"{name}, {key.replace('_', ' ')}", *pair_of, pair_of[0] == pair_of[1]
        return
    if isinstance(expected, dict) and depth < 2:
        for key, part in expected.items():
            yield from _rows(str(key), got.get(key) if isinstance(got, dict) else None, part, tolerance, depth + 1)
        if got is not None and not isinstance(got, dict):
            yield name, got, "a dict", False
        return
    wanted, came = numbers(expected), numbers(got)
    if wanted is None or came is None or wanted.shape != came.shape:
        yield name, got, expected, got == expected
        return
    rtol, atol = tolerance
    with np.errstate(all="ignore"):
        near = np.abs(came - wanted) <= atol + rtol * np.abs(wanted).max(initial=0)
    if wanted.size > MOST_NUMBERS or not wanted.ndim:
        yield name, got, expected, bool(near.all())
        return
    for index in np.ndindex(wanted.shape):
        yield f"{name}[{', '.join(map(str, index))}]", float(came[index]), float(wanted[index]), bool(near[index])
