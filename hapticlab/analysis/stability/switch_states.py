"""The states of a switched scene as vectors: what its conditions are there, and where its surfaces are."""

import numpy as np
import sympy as sp

from ...compiler.algebra.first_sample import numbers
from ...compiler.algebra.graph import Graph
from ...compiler.ir.channels import channel_of
from ...errors import ParameterError
from ...scene.notation.parameters import Parameter, T
from ...scene.notation.symbols import delay, t, v, x
from .condition_switches import BEYOND_SURFACE

#: how far from a surface its two sides are told apart
_BESIDE = 1e-9


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
        at_first = {k: sp.sympify(type(s).initial) for k, s in enumerate(self.variables) if s in form.coordinates}
        self.carried = {k: e for k, e in at_first.items() if e.atoms(x)}
        self.speeds = np.array([(s in self.rates and s.expr not in tied) or s == v(t) for s in self.variables])
        self.period = period
        self.conditions = list(scene.switches.values())
        self.rest = np.where(self.speeds, 0.0, self.start)

    def with_handle_at(self, xs):
        """Return places at rest with the handle at each of ``xs`` [m], coordinates moved along that begin where it is."""
        points = np.repeat(self.rest[:, None], len(xs), axis=1)
        points[0] = xs
        if self.carried:
            points[list(self.carried)] = self._evaluate(list(self.carried.values()), points)
        return points.T

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

    def across(self, point, by=BEYOND_SURFACE):
        """Return the points ``by`` beyond each surface, on both sides, nearest to a point: shape (variables, crossings)."""
        steps = 1e-6 * np.eye(len(point))
        lanes = np.column_stack([point, point[:, None] + steps, point[:, None] - steps])
        found, n = self.measures(lanes), len(point)
        crossings = []
        for row in found:
            slope = (row[1 : n + 1] - row[n + 1 :]) / 2e-6
            along = np.where(self.positions, slope, 0.0)
            along = along if along.any() else np.where(self.speeds, slope, 0.0)
            if along.any() and np.isfinite(along).all() and np.isfinite(row[0]):
                for side in (-by, by):
                    crossings.append(point + along * (side - row[0]) / (along @ along))
        return np.reshape(crossings, (-1, n)).T

    def borders(self, point):
        """Return (place, modes of its sides, whether x alone decides) on each nearest surface, from small to large x."""
        near = self.across(point)
        if not near.size:
            return []
        pairs, surfaces = [], (near[:, ::2] + near[:, 1::2]) / 2
        for surface in surfaces.T:
            beside = self.across(surface, _BESIDE)
            first = np.abs(beside - surface[:, None]).max(axis=0).reshape(-1, 2).max(axis=1).argmin()
            sides = beside[:, 2 * first : 2 * first + 2]
            sides = sides[:, np.argsort(sides[0], kind="stable")]
            one, other = self.modes(sides)
            if one != other:
                pairs.append((sides.mean(axis=1), (one, other), bool((sides[1:, 0] == sides[1:, 1]).all())))
        return pairs
