"""The first wrong case of an exercise on a student's page: what was given, what came, and what was expected."""

import re

import numpy as np

from .case_figures import figures, is_curve, numbers
from .page_text import clean, pair, shown

#: lists of more numbers are told by their first ones, tables of more too; a figure shows all
MOST_NUMBERS, MOST_ROWS = 6, 24
#: what is given to a scene, whose words need not say it
UNITS = {"x": "m", "v": "m/s", "T": "s"}
#: of an exercise that the lab does not have
TOLERANCE = 1e-6, 1e-12


def failing_case(one, lab):
    """Return the first wrong case of an exercise as HTML: tables, and a figure of each list.

    Parameters
    ----------
    one : ExerciseReport
        With a failing case.
    lab : Lab
        Whose words tell units, and whose exercises how near is right.
    """
    case = one.failing
    if case.expected is None:  # of a value or a choice: the answer itself is not told
        return "" if case.value is None else f"<p>You answered: <strong>{clean(shown(case.value))}</strong></p>"
    which = "a public case of the lab" if case.public else "a case drawn for this grading"
    head = f'<h3>The first case that is wrong <span class="aside">{which}</span></h3>'
    drawn = figures(one, lambda name, other: unit_of(name, one, lab, other))
    return "".join([head, _given(one, lab), _compared(one, lab), *drawn])


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


def _given(one, lab):
    """Return a table of what was given; nothing where nothing was."""
    flat, units = {}, UNITS if one.kind == "scene" else {}
    for name, value in one.failing.given.items():
        flat |= value if isinstance(value, dict) else {name: value}
    rows = [
        (name, clean(shown(value)), clean(unit_of(str(name), one, lab, units.get(name, ""))))
        for name, value in [*flat.items()][:MOST_ROWS]
    ]
    return _table(("given", "value", "unit"), rows) if rows else ""


def _compared(one, lab):
    """Return a table of what came beside what was expected; long lists in a few numbers."""
    case, rows = one.failing, []
    several = isinstance(case.expected, dict)
    for name, got, expected, alike in [*_rows(one.name, case.value, case.expected, _tolerance(one, lab))][:MOST_ROWS]:
        came, wanted = (shown(got), shown(expected)) if alike else pair(got, expected)
        unit = unit_of(name, one, lab, case.unit) if several else case.unit
        unlike = "" if alike else '<span role="img" aria-label="differs from">&#8800;</span>'
        rows.append((name, clean("nothing" if got is None else came), unlike, clean(wanted), clean(unit)))
    return _table(("answer", "got", "", "expected", "unit"), rows)


def _table(head, rows):
    """Return a table whose rows begin with a name of the student's code."""
    top = "".join(f'<th scope="col">{word}</th>' if word else "<td></td>" for word in head)
    body = "".join(
        f'<tr><th scope="row"><code>{clean(str(name), 60)}</code></th>{"".join(f"<td>{cell}</td>" for cell in cells)}</tr>'
        for name, *cells in rows
    )
    return f'<table class="values"><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>'


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
