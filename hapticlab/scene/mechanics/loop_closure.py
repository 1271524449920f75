"""Whether loops close over the whole range of their drivers, and what a message calls them."""

import math

import numpy as np
import sympy as sp

from .loop_terms import NotClosed, number

#: of Step.margin: a sine of 1e-4 between a link and the circle it must meet, what float32 still resolves
CLOSEST = 1e-8


class Open(NotClosed):
    """A loop that cannot close somewhere on the range."""


def check_range(drivers, sources, start):
    """Refuse drivers that the loops do not follow over their whole range.

    Parameters
    ----------
    drivers : tuple of coordinates
    sources : list of (constraints, steps)
    start : dict
    """
    if not any(step.margin.atoms(sp.Function) for _, steps in sources for step in steps):
        return
    for q in drivers:
        if _limits(q, start) is None:
            raise NotClosed(f"{name(q)} has no declared range over which the closing of the loop can be checked")
    margin, which, worst = _closest(drivers, sources, start)
    where = ", ".join(f"{name(q)} = {value:.4g}" for q, value in zip(drivers, worst, strict=True))
    loop = shown([group for group, steps in sources for _ in steps][which])
    if margin < -CLOSEST:
        raise Open(f"{loop} cannot close at {where}{_where_it_closes(drivers, sources, start)}")
    if margin < CLOSEST:
        raise NotClosed(f"{loop} has a dead centre or change point at {where}: two assemblies meet there")


def _closest(drivers, sources, start):
    """(Margin, number of the step, drivers) where a loop is closest to opening, by a search that narrows."""
    generator = np.random.default_rng(23)
    centre, half = np.array([_box(q, start) for q in drivers]).reshape(-1, 2).T
    one = len(drivers) == 1
    points = np.linspace(-1, 1, 721)[:, None] if one else generator.uniform(-1, 1, (4096, len(drivers)))
    best, width = (np.inf,), 1.0
    for _ in range(9):
        margins = _margins(drivers, sources, start, centre + half * points)
        which, k = np.unravel_index(np.argmin(margins), margins.shape)
        if margins[which, k] < best[0]:
            best = margins[which, k], which, points[k]
        width *= 0.02 if one else 0.25
        around = np.linspace(-1, 1, 65)[:, None] if one else generator.uniform(-1, 1, (512, len(drivers)))
        points = np.clip(best[2] + width * around, -1, 1)
    return best[0], best[1], centre + half * best[2]


def _where_it_closes(drivers, sources, start):
    """Range of a single driver, about the start, in which the loop closes."""
    if len(drivers) > 1:
        return ""
    points = np.linspace(*_limits(drivers[0], start), 721)
    closes = np.all(_margins(drivers, sources, start, points[:, None]) > 0, axis=0)
    here = int(np.argmin(np.abs(points - start[drivers[0]])))
    if not closes[here]:
        return ""
    low = here - int(np.argmin([*closes[here::-1], False])) + 1
    high = here + int(np.argmin([*closes[here:], False])) - 1
    return f"; near the start it closes from {name(drivers[0])} = {points[low]:.3g} to {points[high]:.3g}"


def _box(q, start):
    low, high = _limits(q, start)
    return (low + high) / 2, (high - low) / 2


def _margins(drivers, sources, start, points):
    """Margin of each step at each point, shape (steps, points)."""
    at = {**start, **dict(zip(drivers, points.T, strict=True))}
    rows = []
    with np.errstate(all="ignore"):
        for step in [step for _, steps in sources for step in steps]:
            margin = np.broadcast_to(np.asarray(number(step.margin, at), float), len(points))
            # what follows a step that cannot close is not looked at
            rows.append(np.where(np.isnan(margin), np.inf if rows and (rows[-1] < 0).any() else -1.0, margin))
            at[step.coordinate] = number(step.value, at)
    return np.array(rows)


def driven_over(drivers, start):
    """Driver -> many values over its checked range, for the drivers that have one."""
    generator = np.random.default_rng(17)
    ranged = [q for q in drivers if _limits(q, start) is not None]
    if len(ranged) == 1:
        return {ranged[0]: np.linspace(*_limits(ranged[0], start), 721)}
    return {q: generator.uniform(*_limits(q, start), 2048) for q in ranged}


def wraps(drivers, sources, start):
    """The dependent angles that jump when a driver goes through its range."""
    found = set()
    for q in drivers:
        if _limits(q, start) is None:
            continue
        at = {**start, q: np.linspace(*_limits(q, start), 721)}
        with np.errstate(all="ignore"):
            for step in [step for _, steps in sources for step in steps]:
                at[step.coordinate] = value = number(step.value, at)
                if is_angle(step.coordinate) and np.any(np.abs(np.diff(np.atleast_1d(value))) > math.pi):
                    found.add(step.coordinate)
    return frozenset(found)


def declared_range(q):
    """(Low, high) of a coordinate, infinite where none was declared."""
    return getattr(type(q), "low", -math.inf), getattr(type(q), "high", math.inf)


def _limits(q, start):
    """The checked range of a driver, or None."""
    low, high = declared_range(q)
    if not math.isinf(low) and not math.isinf(high):
        return low, high
    return (start[q] - math.pi, start[q] + math.pi) if is_angle(q) else None


def is_angle(q):
    """Whether a coordinate is an angle, which may go round."""
    return type(q).unit in ("rad", "1")


def is_coordinate(symbol):
    """Whether a symbol is a coordinate, as q(t)."""
    return getattr(type(symbol), "role", None) == "coordinate"


def name(q):
    """Name of a coordinate, without its (t)."""
    return type(q).__name__


def names(coordinates):
    """Names of coordinates, for a message."""
    return ", ".join(map(name, coordinates))


def values(coordinates, at):
    """The text "q = 0.1, z = 0.2" of coordinates, for a message."""
    return ", ".join(f"{name(q)} = {at[q]:.6g}" for q in coordinates)


def in_unit(q, value, per=""):
    """A start as it can be declared: every digit, and the unit a parameter for it needs."""
    return f"{name(q)} = {float(value)!r} {type(q).unit}{per}".removesuffix(" 1")


def shown(constraints):
    """Constraints as equations, for a message."""
    return " and ".join(f"{c} = 0" for c in constraints)
