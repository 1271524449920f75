"""Where a scene is looked at: operating points, at least one in every mode that can be reached from its start."""

from dataclasses import dataclass

import numpy as np

from ..compiler.channels import channel_of
from ..compiler.first_sample import numbers
from ..compiler.graph import Graph
from ..compiler.phase import TICKS
from ..errors import AnalysisError, ParameterError
from ..scene.parameters import Parameter, T
from ..scene.symbols import delay, t, v, x
from .switches import BEYOND_SURFACE, MOST_MODES

#: what a linearisation of each kind is worth
WORTH = {
    "linear": "linear: exact",
    "piecewise linear": "piecewise linear: exact within each mode",
    "small-signal": "of small motions about these points",
}
#: places beside the start within declared ranges
_WITHIN = 6


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
    """

    mode: tuple
    values: dict
    words: str


class Places:
    """The states of a switched scene as vectors (x, v, q, q', s), and what its conditions are there."""

    def __init__(self, scene, period):
        self.scene, self.graph = scene, Graph()
        form = scene.form
        tied = {q for model in form.models if model.constraints for q in model.coordinates}
        second = [q for q, order in zip(form.coordinates, form.orders, strict=True) if order == 2]
        first = [q for q in form.coordinates if q not in second]
        self.rates = [q.diff(t) for q in second]
        self.variables = [x(t), v(t), *second, *self.rates, *first]
        self.names = ["x", "v", *(channel_of(s, "f64").name for s in self.variables[2:])]
        unbound = sorted(set(scene.parameters) - set(scene.values) - {s.name for s in scene.switches})
        if unbound:
            raise ParameterError(f"{', '.join(unbound)} has no value; bind it: scene({unbound[0]}=...)")
        start = numbers(self.variables[2:], scene.values)
        self.start = np.r_[0.0, 0.0, start]
        #: what a step across a surface may change, positions before rates
        self.positions = np.array([s not in self.rates and s != v(t) and s not in tied for s in self.variables])
        self.speeds = np.array([(s in self.rates and s.expr not in tied) or s == v(t) for s in self.variables])
        self.period = period
        self.conditions = list(scene.switches.values())

    def kind(self, k):
        """Return the class of a coordinate, which has its declared range."""
        return type(self.variables[k])

    def measures(self, points):
        """Return left less right side of every condition, shape (conditions, points), of points (variables, points)."""
        return self._evaluate([c.lhs - c.rhs for c in self.conditions], points)

    def modes(self, points):
        """Return the mode of every point, a list of tuples."""
        return [tuple(int(on) for on in column) for column in self._evaluate(self.conditions, points).T]

    def _evaluate(self, exprs, points):
        at = {leaf: self._at(leaf, points) for leaf in self.graph.variables_of(exprs)}
        found = self.graph.evaluate(exprs, at)
        return np.reshape([np.broadcast_to(row, points.shape[1:]) for row in found], (len(exprs), points.shape[1]))

    def _at(self, leaf, points):
        if leaf in self.variables:
            return points[self.variables.index(leaf)]
        if isinstance(leaf, (x, v)):  # past samples: the handle has been there
            return points[int(isinstance(leaf, v))]
        if isinstance(leaf, Parameter):
            return self.period if leaf == T else self.scene.values[leaf.name]
        if isinstance(leaf, delay):
            return self._evaluate([leaf.args[0]], points)[0]
        return numbers([leaf], self.scene.values)[0]

    def across(self, point):
        """Return the points just beyond each surface, on both sides, nearest to a point: shape (variables, crossings)."""
        steps = 1e-6 * np.eye(len(point))
        lanes = np.column_stack([point, point[:, None] + steps, point[:, None] - steps])
        found, n = self.measures(lanes), len(point)
        crossings = []
        for row in found:
            slope = (row[1 : n + 1] - row[n + 1 :]) / 2e-6
            along = np.where(self.positions, slope, 0.0)
            along = along if along.any() else np.where(self.speeds, slope, 0.0)
            if along.any() and np.isfinite(along).all() and np.isfinite(row[0]):
                for side in (-BEYOND_SURFACE, BEYOND_SURFACE):
                    crossings.append(point + along * (side - row[0]) / (along @ along))
        return np.reshape(crossings, (-1, n)).T


def operating_points(scene, at=None, period=1e-3):
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
    """
    places = Places(scene, period)
    points = _given(places, at) if at is not None else _around(places)
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


def _point(places, p, mode, words):
    values = dict(zip(places.names, map(float, p), strict=True)) | {TICKS[0]: 0.0}
    moved = [f"{name} = {value:.4g}" for name, value, start in zip(places.names, p, places.start, strict=True) if value != start]
    return OperatingPoint(mode, values, words or ", ".join(moved) or "the start")


def _given(places, at):
    found = []
    for one in [at] if isinstance(at, dict) else at:
        strangers = set(one) - set(places.names)
        if strangers:
            raise AnalysisError(f"at: {', '.join(sorted(strangers))} is no state; there are {', '.join(places.names)}")
        p = np.array([float(one.get(name, start)) for name, start in zip(places.names, places.start, strict=True)])
        found.append((", ".join(f"{name} = {value:g}" for name, value in one.items()) or "the start", p))
    return found


def _around(places):
    """Return (words, point) of the start, of rest, and of places within declared ranges of coordinates."""
    start, found = places.start, [("the start, x = 0", places.start)]
    rest = np.where(places.speeds, 0.0, start)
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
    """Return what a linearisation is worth, from the slopes at the points and then at the probes, first axis.

    ``"linear"``, ``"piecewise linear"``, or ``"small-signal"`` where slopes change within a mode, or with time.
    """
    places = [*points, *probes]
    first = {p.mode: k for k, p in reversed([*enumerate(places)])}
    for k, p in enumerate(places):
        one, other = slopes[k], slopes[first[p.mode]]
        scale = 1e-9 * np.abs(other).max(initial=0.0)
        if not np.allclose(one, other, rtol=0, atol=scale):
            return "small-signal"
    return "linear" if len(first) == 1 and not scene.instants else "piecewise linear"
