"""Figures of a wrong case: each list that was expected, with what came in its place."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.drawing import axis_label
from ..plotted_curves import UNIT
from .chart import POINT, SAMPLE, bounded, chart
from .page_text import pair

LEAST_DRAWN, MOST_FIGURES, LEAST_COLUMN = 3, 4, 7
#: given axes, and their units where nothing says others
ALONG = {"t": "s", "x": "m"}


@dataclass(frozen=True)
class Panel:
    """What one figure shows.

    ``got`` is None where nothing came that can be drawn; ``x`` and ``x_got`` are there where curves have abscissae of their
    own, and ``axes`` with them, each a name and a unit.
    """

    name: str
    expected: np.ndarray
    got: np.ndarray | None
    x: np.ndarray | None = None
    x_got: np.ndarray | None = None
    axes: tuple = ()


@dataclass(frozen=True)
class WrongCase:
    """A wrong case to draw: of which exercise, what was given, what came and what was expected, as plain values."""

    name: str
    kind: str
    given: Mapping[str, Any]
    value: Any
    expected: Any
    unit: str


def figures(one, unit):
    """Figures of a wrong case, at most a few: each an SVG, and what it says in words.

    Parameters
    ----------
    one : WrongCase
    unit : callable
        Name, and a unit where nothing says one, to unit.
    """
    found = [panel for panel in panels(one.name, one.value, one.expected) if len(panel.expected) >= LEAST_DRAWN]
    return [_figure(one, panel, unit) for panel in found[:MOST_FIGURES]]


def panels(name, got, expected, depth=0):
    """Yield a panel for each list of numbers in what is expected, for each column of a long table, for each curve."""
    if isinstance(expected, dict):
        if is_curve(expected):
            yield from _curve(name, got, expected)
            return
        for key, part in expected.items():
            if depth < 2:
                yield from panels(str(key), _part(got, key, part), part, depth + 1)
        return
    wanted, came = numbers(expected), numbers(got)
    if wanted is not None and wanted.ndim == 1:
        yield Panel(name, wanted, came if came is not None and came.ndim == 1 else None)
    elif wanted is not None and wanted.ndim == 2 and len(wanted) >= LEAST_COLUMN:
        alike = came is not None and came.ndim == 2 and came.shape[1] == wanted.shape[1]
        for k in range(wanted.shape[1]):
            yield Panel(f"{name}[:, {k}]", wanted[:, k], came[:, k] if alike else None)


def is_curve(value):
    """Whether a value is a curve, as :func:`hapticlab.course.plotted_curves.curves` gives it."""
    if not isinstance(value, dict):
        return False
    x, y = numbers(value.get("x"), 1), numbers(value.get("y"), 1)
    return x is not None and y is not None and x.shape == y.shape


def _part(got, key, expected):
    """The value that came under a name; of several curves, whose names are free, the one nearest to what is expected."""
    if not isinstance(got, dict):
        return None
    curves = [curve for curve in got.values() if is_curve(curve) and _units(curve) == _units(expected)]
    if not (is_curve(expected) and curves):
        return got.get(key)
    middle = lambda curve: np.nan_to_num(bounded(numbers(curve["y"]))).mean()  # noqa: E731
    return min(curves, key=lambda curve: abs(middle(curve) - middle(expected)))


def _units(curve):
    return [str(curve.get(f"{side}_unit", "")) for side in "xy"] if isinstance(curve, dict) else []


def _curve(name, got, expected):
    """Yield the panel of a curve with abscissae of its own; one in other units cannot be drawn beside it."""
    drawn = is_curve(got) and _units(got) == _units(expected)
    names = [UNIT.sub("", str(got.get(f"{side}_label", ""))).strip() if drawn else "" for side in "xy"]
    axes = tuple(zip((name or f"along {side}" for name, side in zip(names, "xy", strict=True)), _units(expected), strict=True))
    (x_got, y_got), (x, y) = ([numbers(curve[side]) if curve else None for side in "xy"] for curve in (drawn and got, expected))
    yield Panel(name, y, y_got, x, x_got, axes)


def numbers(value, axes=None):
    """Return an array of a number or a list of them, with so many axes; None of anything else."""
    if not isinstance(value, float | int | list | tuple) or isinstance(value, bool):
        return None
    try:
        found = np.array(value, float)
    except (TypeError, ValueError, OverflowError):
        return None
    return found if axes in (None, found.ndim) else None


def _figure(one, panel, unit):
    """A figure over a curve's own x, the time or the place that was given, else the number of the sample."""
    if panel.axes:
        (scale_x, across), (scale, label) = (axis_label(*axis) for axis in panel.axes)
        x, x_got = panel.x * scale_x, None if panel.x_got is None else panel.x_got * scale_x
    else:
        size = max(len(panel.expected), 0 if panel.got is None else len(panel.got))
        x_got, across = _across(one, size, unit)
        x, (scale, label) = x_got[: len(panel.expected)], axis_label(panel.name, unit(panel.name, one.unit))
    across, label = across.removesuffix(" []"), label.removesuffix(" []")
    lines = {"expected": (x, bounded(panel.expected) * scale)}
    if panel.got is not None:
        lines["got"] = x_got[: len(panel.got)], bounded(panel.got) * scale
    alt = f"{panel.name[:60]}: {label} over {across}. " + " ".join(_course(name, y) for name, (_, y) in lines.items())
    return chart(lines, (across, label), alt), _difference(lines, across, bool(panel.axes))


def _across(one, size, unit):
    """The abscissae of a figure, and their label: t, else x where it grows or falls all the way, else counted."""
    for name, otherwise in ALONG.items():
        x = numbers(one.given.get(name), 1)
        if x is not None and x.shape == (size,) and np.isfinite(x).all():
            steps = np.diff(bounded(x))
            if (steps > 0).all() or (steps < 0).all():
                scale, label = axis_label(name if name == "x" else "time t", unit(name, otherwise))
                return bounded(x) * scale, label
    return np.arange(float(size)), POINT if one.kind == "expression" else SAMPLE


def _difference(lines, across, own):
    """Say in a sentence where two lines differ most; those with abscissae of their own are compared where one is expected."""
    if "got" not in lines:
        return "There is no answer that can be drawn next to the expected values."
    (x, expected), (x_got, got) = lines["expected"], lines["got"]
    odd = int((~np.isfinite(got)).sum())
    told = f" {odd} of your {len(got)} numbers are NaN or infinite; NaN leaves a gap." if odd else ""
    if own and x_got.size and (np.diff(x_got) > 0).all():
        got = np.interp(x, x_got, got)
    if len(got) != len(expected):
        return f"You gave {len(got)} numbers; {len(expected)} are expected.{told}"
    apart = np.nan_to_num(np.abs(got / 2 - expected / 2))
    if not apart.max() > 0:
        return told.strip() or "All numbers agree."
    k = int(apart.argmax())
    place = f"{across} {k}" if across in (SAMPLE, POINT) else _place(across.removeprefix("along "), x[k])
    came, wanted = pair(float(got[k]), float(expected[k]))
    return f"The largest difference is at {place}: yours is {came}, and {wanted} is expected.{told}"


def _place(label, at):
    """Return the value on an axis with its unit: "x = 3 mm"."""
    name, _, unit = label.removesuffix("]").partition(" [")
    return f"{name} = {at:.4g} {unit}".strip()


def _course(which, line):
    """Say in words how a line runs."""
    line = line[np.isfinite(line)]
    if not len(line):
        return f"{which}: no numbers."
    return f"{which}: from {line[0]:.4g} to {line[-1]:.4g}, between {line.min():.4g} and {line.max():.4g}."
