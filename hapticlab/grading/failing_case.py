"""The first wrong case of an exercise on a student's page: what was given, what came, and what was expected."""

import re

import numpy as np

from ..drawing import axis_label
from .page_figures import chart
from .page_text import clean, pair, shown

#: shorter lists are told in the table; longer ones, and from three numbers on, are drawn
MOST_ROWS, LEAST_DRAWN, MOST_FIGURES = 12, 3, 4
#: of a given whose unit the exercise does not say
UNITS = {"t": "s", "x": "m", "T": "s", "v": "m/s"}


def failing_case(one):
    """Return the first wrong case of an exercise as HTML: tables, and a figure of each list.

    Parameters
    ----------
    one : ExerciseReport
        With a failing case.
    """
    case = one.failing
    which = "a public case of the lab" if case.public else "a case drawn for this grading"
    parts = [f'<h3>The first case that is wrong <span class="aside">{which}</span></h3>', _given(one, case.given)]
    if case.expected is None:
        if case.value is not None:
            parts.append(f"<p>You answered: <strong>{clean(shown(case.value))}</strong></p>")
        return "".join(parts)
    parts.append(_compared(one, case))
    drawn = [panel for panel in panels(one.name, case.value, case.expected, case.unit) if panel[2].size >= LEAST_DRAWN]
    return "".join(parts + [_figure(one, case.given, *panel) for panel in drawn[:MOST_FIGURES]])


def panels(name, got, expected, unit, depth=0):
    """Yield name, got (or None), expected and unit of each list of numbers in what is expected; columns of a table apart."""
    if isinstance(expected, dict):
        for key, part in expected.items():
            if depth < 2:
                yield from panels(str(key), got.get(key) if isinstance(got, dict) else None, part, unit, depth + 1)
        return
    wanted, came = _array(expected), _array(got)
    if wanted is None:
        return
    if wanted.ndim == 1:
        yield name, came if came is not None and came.ndim == 1 else None, wanted, unit
    elif wanted.ndim == 2 and wanted.size > MOST_ROWS:
        alike = came is not None and came.ndim == 2 and came.shape[1] == wanted.shape[1]
        for k in range(wanted.shape[1]):
            yield f"{name}[:, {k}]", came[:, k] if alike else None, wanted[:, k], unit


def _array(value):
    """Return the numbers of a list; None of anything else."""
    if not isinstance(value, list | tuple):
        return None
    try:
        return np.array(value, float)
    except (TypeError, ValueError, OverflowError):
        return None


def unit_of(name, asks, otherwise=""):
    """Return the unit that an exercise's words give a name: "x [m]".

    Examples
    --------
    >>> unit_of("D", "the work [J] at x [m], moving by D [m]"), unit_of("b", '{"k": [N/m], "b": [N s/m]}')
    ('m', 'N s/m')
    """
    found = re.search(rf'(?<!\w){re.escape(name[:60])}"?:? \[([^\]]{{1,20}})\]', asks)
    return found[1] if found else otherwise


def _given(one, given):
    """Return a table of what was given; nothing where nothing was."""
    flat = {}
    for name, value in given.items():
        flat |= value if isinstance(value, dict) else {name: value}
    if not flat:
        return ""
    rows = [
        f'<tr><th scope="row"><code>{clean(str(name), 60)}</code></th><td class="number">{clean(shown(value))}</td>'
        f"<td>{clean(unit_of(str(name), one.asks, UNITS.get(name, '')))}</td></tr>"
        for name, value in [*flat.items()][: 2 * MOST_ROWS]
    ]
    head = '<tr><th scope="col">given</th><th scope="col">value</th><th scope="col">unit</th></tr>'
    return f"<table><thead>{head}</thead><tbody>{''.join(rows)}</tbody></table>"


def _compared(one, case):
    """Return a table of what came beside what was expected; long lists in a few numbers."""
    rows = []
    for name, got, expected in [*_rows(one.name, case.value, case.expected)][: 2 * MOST_ROWS]:
        told = pair(got, expected)
        came = "nothing" if got is None else told[0]
        unit = unit_of(name, one.asks, case.unit) if isinstance(case.expected, dict) else case.unit
        unlike = '<span aria-label="differs">&#8800;</span>' if came != told[1] else ""
        rows.append(
            f'<tr><th scope="row"><code>{clean(name, 60)}</code></th><td class="number">{clean(came)}</td><td>{unlike}</td>'
            f'<td class="number">{clean(told[1])}</td><td>{clean(unit)}</td></tr>'
        )
    head = "".join(f'<th scope="col">{word}</th>' for word in ("answer", "got", "", "expected", "unit"))
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _rows(name, got, expected, depth=0):
    """Yield name, what came and what was expected, in single values where these are few."""
    if isinstance(expected, dict) and depth < 2:
        for key, part in expected.items():
            yield from _rows(str(key), got.get(key) if isinstance(got, dict) else None, part, depth + 1)
        if got is not None and not isinstance(got, dict):
            yield name, got, "a dict"
        return
    wanted, came = _array(expected), _array(got)
    if wanted is None or wanted.size > MOST_ROWS or came is None or came.shape != wanted.shape:
        yield name, got, expected
        return
    for index in np.ndindex(wanted.shape):
        yield f"{name}[{', '.join(map(str, index))}]", float(came[index]), float(wanted[index])


def _figure(one, given, name, got, expected, unit):
    """Return a figure of a list over the time or the place that was given, else over the number of the sample."""
    unit = unit_of(name, one.asks, unit)
    lines = {"expected": expected} | ({} if got is None else {"got": got})
    x, across = _across(one, given, max(map(len, lines.values())))
    scale, label = axis_label(name, unit)
    label = label.removesuffix(" []")
    lines = {which: np.clip(line, -1e300, 1e300) * scale for which, line in lines.items()}
    told = _difference(lines, x, across)
    alt = f"{label} over {across}. " + " ".join(_course(which, line) for which, line in lines.items())
    return f"<figure>{chart(x, lines, (across, label), alt)}<figcaption>{clean(told)}</figcaption></figure>"


def _across(one, given, size):
    """Return what a figure runs over, and its label: t, else x where it grows or falls all the way, else sample numbers."""
    for name in ("t", "x"):
        x = _array(given.get(name))
        if x is not None and x.shape == (size,) and np.isfinite(x).all():
            steps = np.diff(np.clip(x, -1e300, 1e300))
            if (steps > 0).all() or (steps < 0).all():
                scale, label = axis_label(name, unit_of(name, one.asks, UNITS[name]))
                return np.clip(x, -1e300, 1e300) * scale, label if name != "t" else label.replace("t [", "time t [", 1)
    return np.arange(float(size)), "sample"


def _difference(lines, x, across):
    """Say in a sentence where two lines differ most."""
    if "got" not in lines:
        return "Nothing came that can be drawn beside what is expected."
    got, expected = lines["got"], lines["expected"]
    odd = int((~np.isfinite(got)).sum())
    told = f" {odd} of {len(got)} numbers that came are NaN or infinite, and leave gaps." if odd else ""
    if len(got) != len(expected):
        return f"{len(got)} numbers came, {len(expected)} are expected.{told}"
    apart = np.abs(np.where(np.isfinite(got), got, expected) / 2 - expected / 2)
    if not np.nanmax(apart, initial=0) > 0:
        return told.strip() or "All numbers are alike."
    k = int(np.nanargmax(apart))
    place = f"sample {k}" if across == "sample" else f"{across.replace(' [', f' = {x[k]:.4g} ').rstrip(']')}"
    came, wanted = pair(float(got[k]), float(expected[k]))
    return f"The largest difference is at {place}: {came} came, {wanted} is expected.{told}"


def _course(which, line):
    """Say in words how a line runs."""
    line = line[np.isfinite(line)]
    if not len(line):
        return f"{which}: no numbers."
    ends = f"from {line[0]:.4g} to {line[-1]:.4g}"
    return f"{which}: {ends}, between {line.min():.4g} and {line.max():.4g}."
