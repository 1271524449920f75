"""Coordinates keep to the ranges they declare: a start outside is refused, and beyond them a program faults."""

import math

from ...errors import SceneError
from ...scene.notation.symbols import x
from ..algebra.first_sample import numbers
from ..ir.notes import UndefinedForceNote
from ..prune.excluded_modes import within

#: how a note begins that says beyond what the force is no number
#: how far past a declared range the rounding of what rests at its end may go, against the larger end [m] or [rad]
SLACK = 1e-6


def guarded(force, declared, ranges, values, translate):
    """(force, ranges): the force is no number where a coordinate that the program keeps is past its range.

    Parameters
    ----------
    force : Value
    declared : iterable of coordinates
        Those with a finite range that the program keeps.
    ranges : dict coordinate -> (low, high)
        Those that are guarded already, since something was decided over them.
    values : dict name -> float
        Of parameters.
    translate : Translator
        What expressions are at the sample.

    Raises
    ------
    SceneError
        A coordinate starts outside of its range.
    """
    found = {q: (type(q).low, type(q).high) for q in declared if q not in ranges}
    _check_starts({**ranges, **found}, values)
    return within(force, {q: _wider(*pair) for q, pair in found.items()}, translate), {**ranges, **found}


def notes_of(ranges):
    """The notes of a program on the ranges it holds over."""
    for q, ends in ranges.items():
        yield UndefinedForceNote(f"{type(q).__name__} left {_shown(q, ends)}")


def _wider(low, high):
    slack = SLACK * max(abs(end) for end in (low, high) if math.isfinite(end)) or SLACK
    return low - slack, high + slack


def _check_starts(ranges, values):
    for q, (low, high) in ranges.items():
        start = getattr(type(q), "initial", None)
        if start is None or start.has(x):
            continue  # the handle may be anywhere
        at = numbers([start], values)
        if at is not None and not low <= at[0] <= high:
            name, unit = type(q).__name__, type(q).unit
            raise SceneError(
                f"{name} starts at {at[0]:g} {unit}, outside of its declared range {_shown(q, (low, high))}; start it inside "
                "(initial=), or declare a wider range"
            )


def _shown(q, ends):
    low, high = ends
    return f"{low:g}..{high:g} {type(q).unit}".removesuffix(" 1")
