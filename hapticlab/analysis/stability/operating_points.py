"""Where a scene is looked at: operating points, at least one in every mode that can be reached from its start."""

from dataclasses import dataclass

import numpy as np

from ...compiler.algebra.phase import TICKS
from ...errors import AnalysisError
from .condition_switches import MOST_MODES
from .switch_states import Places

#: what a linearisation of each kind is worth
WORTH = {
    "linear": "linear: exact",
    "piecewise linear": "piecewise linear: exact within each mode",
    "small-signal": "for small motions about these points",
}
#: places beside the start within declared ranges
_WITHIN = 6
#: how far the handle is taken to go to either side [m], and a position without a declared range, by its unit
TRAVEL = 0.05
FAR = {"m": TRAVEL, "rad": np.pi}
#: places of the handle looked at, of a scene with states, and of a force of the handle alone, which costs nothing
PLACES, PLACES_ALONE = 17, 401


@dataclass(frozen=True)
class OperatingPoint:
    """A place and the mode there.

    Attributes
    ----------
    mode : tuple of int
        Which switches are on.
    values : dict name -> float
        Handle x and v, coordinates and rates as a program's channels call them, SI.
    words : str
        What sets it apart from the start.
    sampled : bool
        Whether it is one of many over a travel, of which only those are told that ask for the most.
    """

    mode: tuple
    values: dict
    words: str
    sampled: bool = False


def operating_points(scene, at=None, period=1e-3, travel=None, far=False):
    """Return the operating points of a switched scene.

    Its start with the handle at x = 0 comes first, then rest, and places within declared ranges; beyond every surface
    that can be reached from there is one more in the mode that holds there.

    Parameters
    ----------
    scene : Switched
    at : dict name -> float, or sequence of them, optional
        Places to look at in place of these: handle x and v, coordinates and rates by name, what is missing as it starts.
    period : float
        T [s].
    travel : float, optional
        To either side [m]: places of the handle looked at, too, besides those given.
    far : bool
        Whether positions without a declared range are looked at 50 mm or half a turn to either side.
    """
    places = Places(scene, period)
    points = _given(places, at) if at is not None else _around(places)
    found = _beyond_surfaces(places, points, at)
    many = [] if at is not None else [*_along(places, travel), *(_afar(places) if far else ())]
    modes = places.modes(np.column_stack(many)) if many and places.conditions else [()] * len(many)
    seen = {p.mode for p in found}
    for p, mode in zip(many, modes, strict=True):
        if mode in seen or len(seen) < MOST_MODES:
            seen.add(mode)
            found.append(_point(places, p, mode, "", sampled=True))
    return found


def borders(scene, points, period=1e-3):
    """Return (pair, whether x alone decides) of each surface: operating points, one place in the modes of both its sides."""
    places = Places(scene, period)
    found = {}
    for mode in dict.fromkeys(p.mode for p in points) if places.conditions else ():
        values = next(p.values for p in points if p.mode == mode)
        for p, sides, by_x in places.borders(np.array([values[name] for name in places.names])):
            found.setdefault(sides, (tuple(_point(places, p, side, "") for side in sides), by_x))
    return list(found.values())


def _along(places, travel):
    """Return the start with the handle at places over its travel, but not of a linkage that would stay where it is."""
    tied = {q for model in places.scene.form.models if model.constraints for q in model.coordinates}
    if travel is None or tied - {places.variables[k] for k in places.carried}:
        return []
    alone = not places.scene.form.coordinates and not places.scene.form.updates
    return list(places.with_handle_at(np.linspace(-travel, travel, PLACES_ALONE if alone else PLACES)))


def _afar(places):
    """Return the start with one position without a declared range far off, one after another."""
    found = []
    for k in np.flatnonzero(places.positions[2:]) + 2:
        far = FAR.get(str(places.kind(k).unit), 0.0)
        if not np.isfinite([places.kind(k).low, places.kind(k).high]).all():
            for part in (-1.0, -0.5, 0.5, 1.0) if far else ():
                p = places.rest.copy()
                p[k] = part * far
                found.append(p)
    return found


def _beyond_surfaces(places, points, at):
    if not places.conditions:
        return [_point(places, p, (), words) for words, p in points]
    found = [_point(places, p, mode, words) for (words, p), mode in zip(points, places.modes(_columns(points)), strict=True)]
    if at is not None:
        return found
    seen, waiting = {p.mode for p in found}, [points[0][1]]
    while waiting and len(seen) < MOST_MODES:
        beyond = places.across(waiting.pop(0))
        for p, mode in zip(beyond.T, places.modes(beyond), strict=True) if beyond.size else ():
            if mode not in seen:
                seen.add(mode)
                waiting.append(p)
                found.append(_point(places, p, mode, ""))
    return found


def _columns(points):
    return np.column_stack([p for _, p in points])


def _point(places, p, mode, words, sampled=False):
    values = dict(zip(places.names, map(float, p), strict=True)) | {TICKS[0]: 0.0}
    moved = [f"{name} = {value:.4g}" for name, value, start in zip(places.names, p, places.start, strict=True) if value != start]
    return OperatingPoint(mode, values, words or ", ".join(moved) or "the start", sampled)


def _given(places, at):
    found = []
    for one in [at] if isinstance(at, dict) else at:
        strangers = set(one) - set(places.names)
        if strangers:
            raise AnalysisError(f"at: {', '.join(sorted(strangers))} is not a state; the states are {', '.join(places.names)}")
        p = np.array([float(one.get(name, start)) for name, start in zip(places.names, places.start, strict=True)])
        found.append((", ".join(f"{name} = {value:g}" for name, value in one.items()) or "the start", p))
    return found


def _around(places):
    """Return (words, point) of the start, of rest, and of places within declared ranges of coordinates."""
    start, found = places.start, [("the start, x = 0", places.start)]
    rest = places.rest
    if (rest != start).any():
        found.append(("the start, at rest", rest))
    free = [k for k in np.flatnonzero(places.positions) if k > 0]
    bounded = [k for k in free if np.isfinite([places.kind(k).low, places.kind(k).high]).all()]
    generator = np.random.default_rng(17)
    for _ in range(_WITHIN if bounded else 0):
        p = rest.copy()
        for k in bounded:
            p[k] = generator.uniform(places.kind(k).low, places.kind(k).high)
        found.append(("", p))
    return found


def probes_of(points):
    """Return for each mode two places anywhere, at any time, where what is linear in it has the slopes it has elsewhere."""
    generator, found = np.random.default_rng(23), []
    for mode in dict.fromkeys(p.mode for p in points):
        values = next(p.values for p in points if p.mode == mode)
        for _ in range(2):
            moved = {name: value + generator.uniform(0.3, 0.9) for name, value in values.items()}
            moved[TICKS[0]] = float(generator.integers(1, 1000))
            found.append(OperatingPoint(mode, moved, "a probe"))
    return found


def kind_of(scene, points, probes, slopes):
    """The worth of a linearisation, from the slopes at the points and then at the probes, first axis.

    ``"linear"``, ``"piecewise linear"``, or ``"small-signal"`` where slopes change within a mode, or with time.
    """
    places = [*points, *probes]
    first = {p.mode: k for k, p in reversed([*enumerate(places)])}
    for k, p in enumerate(places):
        if not _alike(slopes[k], slopes[first[p.mode]]):
            return "small-signal"
    return "linear" if len(first) == 1 and not scene.instants else "piecewise linear"


def _alike(one, other):
    """Tell whether slopes are the same but for rounding; those that are no numbers are not."""
    with np.errstate(invalid="ignore"):
        return bool((np.abs(one - other) <= 1e-9 * np.abs(other).max(initial=0.0)).all())


def telling(points, slopes):
    """Points to look at closer: all but sampled ones whose slopes are no numbers, or those of another in the mode.

    Parameters
    ----------
    points : sequence of OperatingPoint
    slopes : sequence of array
        Of each point, all of one shape.
    """
    kept, seen = [], {}
    for k, p in enumerate(points):
        others, one = seen.setdefault(p.mode, []), slopes[k]
        finite = np.isfinite(one).all()
        if not p.sampled or (finite and not any(_alike(one, other) for other in others)):
            kept.append(k)
            others += [one] if finite else []
    return kept
