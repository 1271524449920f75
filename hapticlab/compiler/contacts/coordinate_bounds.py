"""Coordinates keep to the ranges they declare: a start outside is refused, and beyond them a program faults."""

import math

from ...errors import SceneError
from ...scene.notation.symbols import x
from ..algebra.first_sample import numbers
from ..prune.excluded_modes import within

#: how a note begins that says beyond what the force is no number
BEYOND = "F is nan where "
#: how far past a declared range the rounding of what rests at its end may go, against the larger end [m] or [rad]
SLACK = 1e-6


def guarded(lowering, outputs, ranges):
    """Return (outputs, ranges): the force is no number where a coordinate that the program keeps is past its range.

    Parameters
    ----------
    lowering : the scene's lowering
        Its tick traced.
    outputs : list of (Channel, Value)
        The force first.
    ranges : dict coordinate -> (low, high)
        Those that are guarded already, since something was decided over them.

    Raises
    ------
    SceneError
        A coordinate starts outside of its range.
    """
    kept = lowering.tracing.observed([value for _, value in outputs])
    found = {q: (type(q).low, type(q).high) for q in _with_range(lowering, kept) if q not in ranges}
    _check_starts({**ranges, **found}, lowering.scene.values)
    wider = {q: _wider(*ends) for q, ends in found.items()}
    (channel, force), *others = outputs
    outputs = [(channel, within(force, wider, lowering.at_sample)), *others]
    lowering.tracing.complete()
    return outputs, {**ranges, **found}


def notes_of(ranges):
    """Yield what a listing of a program says of the ranges it holds over."""
    for q, ends in ranges.items():
        yield f"{BEYOND}{type(q).__name__} left {_shown(q, ends)}"


def _with_range(lowering, kept):
    """Return the coordinates with a finite range that are states of a program, or follow from one by a constraint."""
    enforced, exact = lowering.dynamics.enforced, lowering.exact
    tied = enforced.coordinates if enforced and kept & {*enforced.second, *enforced.first} else ()
    moved = exact.states if exact and kept & set(exact.keys) else ()
    held = {*kept, *tied, *moved}
    return [q for q in lowering.scene.coordinates if q in held and any(map(math.isfinite, (type(q).low, type(q).high)))]


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
