"""Loops solved in closed form, as traced values: positions, rates, what the drivers move, and reactions.

With the drivers' rates w, the rates of all coordinates are B w and what the handle and time add, their accelerations
B w' + b. Each group of one or two constraints gives the rows of its coordinates, by one division.
"""

import sympy as sp

from ...scene.notation.derivative import Partial, Rate, rates_of
from ...scene.notation.symbols import t
from ..ir.structural_zeros import dot, less_product, plus, scaled, times
from ..ir.trace import Value


class Instant:
    """The dependent coordinates at one instant.

    Parameters
    ----------
    embedding : Embedding
    translate : callable expression -> Value
        What asks :meth:`leaf` for the dependent coordinates and their rates.
    """

    def __init__(self, embedding, translate):
        self.embedding, self.translate = embedding, translate
        self.group_of = {step.coordinate: k for k, (_, steps) in enumerate(embedding.groups) for step in steps}
        self.step_of = {step.coordinate: step for step in embedding.steps}
        self.gradients, self.rates, self.rows, self.offsets = {}, {}, {}, {}

    def leaf(self, expr):
        """A dependent coordinate or its rate, or None for any other expression."""
        if expr in self.step_of:
            return self._position(self.step_of[expr])
        if isinstance(expr, sp.Derivative) and expr.expr in self.step_of and expr.derivative_count == 1:
            return self._rate(expr.expr)
        return self.translate(type(expr).of) if getattr(type(expr), "role", None) == "held" else None

    def _position(self, step):
        value = self.translate(step.value)
        for op, known in (("cos", step.cos), ("sin", step.sin)):
            if known is not None and isinstance(value, Value):
                # the cosine of an arc tangent is known before the angle is
                value.builder.identify(op, value, self.translate(known))
        return value

    def _rate(self, q):
        if q not in self.rates:
            constraints, own = self._group(q)
            rest = []
            for g in constraints:
                before = self._before(g, own)
                moved = dot([self._gradient(g, p) for p in before], [self.translate(p.diff(t)) for p in before])
                rest.append(plus(moved, self.translate(rate_of_itself(g))))
            self._solve(self.rates, constraints, own, rest)
        rate = self.rates[q]
        return rate if isinstance(rate, Value) else self.translate(sp.Float(rate))

    def row(self, q):
        """The row of B: how the rate of q follows those of the drivers."""
        drivers = self.embedding.drivers
        if q in drivers:
            return [1.0 if q == driver else 0.0 for driver in drivers]
        if q not in self.rows:
            constraints, own = self._group(q)
            columns = []
            for j in range(len(drivers)):
                rest = []
                for g in constraints:
                    before = self._before(g, own)
                    rest.append(dot([self._gradient(g, p) for p in before], [self.row(p)[j] for p in before]))
                columns.append(self._solve({}, constraints, own, rest))
            for u in own:
                self.rows[u] = [column[u] for column in columns]
        return self.rows[q]

    def offset(self, q):
        """The acceleration of q when the drivers have none."""
        if q in self.embedding.drivers:
            return 0.0
        if q not in self.offsets:
            constraints, own = self._group(q)
            rest = []
            for g in constraints:
                total = self.translate(Rate(Rate(g)))
                for p in self._before(g, own):
                    total = plus(total, times(self._gradient(g, p), self.offset(p)))
                rest.append(total)
            self._solve(self.offsets, constraints, own, rest)
        return self.offsets[q]

    def reactions(self, unbalanced):
        """constraint -> multiplier, from coordinate -> M a - f: what the reactions J^T lambda must provide."""
        found = {}
        for constraints, steps in reversed(self.embedding.groups):
            own = [step.coordinate for step in steps]
            right = []
            for u in own:
                value = unbalanced[u]
                for g, multiplier in found.items():
                    value = less_product(value, self._gradient(g, u), multiplier)
                right.append(value)
            J = [[self._gradient(g, u) for g in constraints] for u in own]
            found.update(zip(constraints, solved(J, right), strict=True))
        return found

    def _group(self, q):
        constraints, steps = self.embedding.groups[self.group_of[q]]
        return constraints, [step.coordinate for step in steps]

    def _before(self, g, own):
        return [p for p in rates_of(g) if p not in own and getattr(type(p), "role", None) == "coordinate"]

    def _gradient(self, g, p):
        if (g, p) not in self.gradients:
            self.gradients[g, p] = self.translate(Partial(g, p))
        return self.gradients[g, p]

    def _solve(self, into, constraints, own, rest):
        """Give the coordinates of a group what makes J u + rest = 0; return the dict."""
        J = [[self._gradient(g, u) for u in own] for g in constraints]
        into.update((u, scaled(-1.0, value)) for u, value in zip(own, solved(J, rest), strict=True))
        return into


def rate_of_itself(g):
    """The rate of a constraint with its coordinates held: what time and the handle do to it."""
    moving = [q for q in rates_of(g) if getattr(type(q), "role", None) == "coordinate"]
    held = {q: sp.Function(f"held_{type(q).__name__}", real=True, unit=type(q).unit, role="held", of=q)(t) for q in moving}
    still = g.xreplace(dict.fromkeys(held, sp.S.One))
    return Rate(g.xreplace(held)) if still.has(t) else sp.S.Zero


def solved(J, right):
    """J^-1 right for one or two unknowns; the determinant is inverted once, whatever is solved with it.

    Examples
    --------
    >>> from hapticlab.compiler.constraints.loop_embedding import solved
    >>> solved([[2.0, 1.0], [0.0, 4.0]], [4.0, 8.0])
    [1.0, 2.0]
    """
    if len(right) == 1:
        return [times(right[0], 1.0 / J[0][0])]
    (a, b), (c, d) = J
    whole = 1.0 / less_product(times(a, d), b, c)
    first = less_product(times(d, right[0]), b, right[1])
    second = less_product(times(a, right[1]), c, right[0])
    return [times(first, whole), times(second, whole)]
