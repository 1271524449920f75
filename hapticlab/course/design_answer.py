"""Whether a design under a budget is good: measured on a scene, and compared with given reference points.

The answer is plain data, and the grader's own process measures it: nothing that a student's process says of a design counts.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

from ..analysis.budget.design import Design
from ..analysis.budget.measured import measured
from ..analysis.budget.tasks import task

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..analysis.budget.measured import MeasuredDesign
    from .exercise import Case, Exercise

#: figures that differ by this part, or margins by as many N s/m, count as equal: a platform may round differently
EQUAL = 2e-3
#: of the three figures: what it is, its unit, and the sign with which less is better
FIGURES = (("error", "%", 1), ("load", "%", 1), ("margin", "N s/m", -1))
#: what a design may give; where it is none, the reason begins with the name that is wrong
NAMES = tuple(one.name for one in fields(Design))


def found(case: Case, answer: Any) -> MeasuredDesign:
    """Return the figures of an answer on the scene of a case."""
    given = dict(case.given)
    return measured(task(given.pop("task"), **given), answer)


def dominated(figures: Sequence[float], points: Mapping[str, Sequence[float]]) -> list[str]:
    """Return the names of the reference points that figures dominate: none of the three is worse.

    Examples
    --------
    >>> dominated((1.0, 40.0, 0.2), {"A": (1.5, 40.0, 0.1), "B": (0.9, 80.0, 0.1)})
    ['A']
    """
    return [name for name, point in points.items() if not any(_missed(figures, point))]


def share(exercise: Exercise, case: Case, answer: Any) -> float:
    """Return the part of the points that a scene allows: dominated reference points by ``full`` of them, at most 1.

    A design that is not feasible has no part of them. An exercise earns the least part that any of its scenes allows.
    """
    return min(1.0, len(_dominated(case, found(case, answer))) / exercise.full)


def words(exercise: Exercise, case: Case, answer: Any) -> str:
    """Return in words what an answer reaches on the scene of a case, and by how much it misses reference points."""
    one = found(case, answer)
    if not one.feasible:
        return f"not feasible: {one.why}"
    names = _dominated(case, one)
    told = f"dominates {', '.join(names)}" if names else "dominates no reference point"
    left = sorted((sum(_missed(one.figures, point)), name) for name, point in case.expected.items() if name not in names)
    misses = [f"{name} by {_gap(one.figures, case.expected[name])}" for _, name in left[:2]]
    near = f". Nearest of the others: it misses {' and '.join(misses)}" if misses and len(names) < exercise.full else ""
    return f"{one}: {told}, {len(names)} of {len(case.expected)}; all points need {exercise.full}{near}"


def row(case: Case, answer: Any) -> dict[str, Any]:
    """Return what an answer reaches on the scene of a case, as plain values for a report.

    There is neither a design nor figures where the answer is not feasible. A feasible design holds numbers and words of
    hapticlab alone, so that nothing in it is a student's own text.
    """
    one = found(case, answer)
    return {
        "scene": dict(case.given),
        "design": dict(one.design) if one.feasible else {},
        "figures": list(one.figures) if one.feasible else [],
        "why": one.why,
        "points": {name: list(point) for name, point in case.expected.items()},
        "dominates": _dominated(case, one),
    }


def points_of(given: Mapping[str, Any], designs: Mapping[str, Mapping[str, Any]]) -> dict[str, list[float]]:
    """Return the reference points of a scene: the figures of an instructor's reference designs, by their names.

    Designs that are not feasible on this scene make no reference point.
    """
    values = dict(given)
    scene = task(values.pop("task"), **values)
    all_ = {name: measured(scene, one) for name, one in designs.items()}
    return {name: list(one.figures) for name, one in all_.items() if one.feasible}


def slip(case: Case, answer: Any) -> str:
    """Return the sentence of the first slip whose names the answer gives so; of no design only one on the name that is wrong."""
    if not isinstance(answer, dict):
        return ""
    about = found(case, answer).why.partition(" ")[0]
    slips = [(wrong, said) for wrong, said in case.slips if about in wrong or about not in NAMES]
    return next((said for wrong, said in slips if all(answer.get(name) == value for name, value in wrong.items())), "")


def _dominated(case, one):
    return dominated(one.figures, case.expected) if one.feasible else []


def _missed(figures, point):
    """Return by which part each of the three figures is worse than that of a reference point; 0 where it is not."""
    gaps = [sign * (mine - theirs) for mine, theirs, (*_, sign) in zip(figures, point, FIGURES, strict=True)]
    parts = [gaps[0] / point[0], gaps[1] / point[1], gaps[2]]
    return [0.0 if part <= EQUAL else part for part in parts]  # nan is worse than any


def _gap(figures, point):
    """Return in words by how much each worse figure misses that of a reference point."""
    worse = [missed > 0 for missed in _missed(figures, point)]
    told = [
        f"{abs(mine - theirs):.2g} {unit} of {name}"
        for mine, theirs, (name, unit, _), bad in zip(figures, point, FIGURES, worse, strict=True)
        if bad
    ]
    return " and ".join(told)
