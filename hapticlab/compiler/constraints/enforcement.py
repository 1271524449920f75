"""What enforces the constraints of a model while it runs: closed form, multipliers, or a numerical embedding.

Each says which coordinates are integrated, ``second`` with their rates and ``first`` by a given rate, and for one instant
of a step what the other coordinates and rates are, the accelerations, the reactions, and the state after the tick.
``translate`` turns an expression into a value at that instant.
"""

import sympy as sp

from ...scene.mechanics.loop_solutions import is_holonomic
from ...scene.notation.derivative import Partial, Rate
from ...scene.notation.symbols import t
from ..algebra.linear_solve import solve
from ..ir.structural_zeros import dot, plus, scaled
from ..ir.trace import Value
from .loop_embedding import Instant, rate_of_itself
from .multipliers import LOST, embedded, multipliers, stiffened

#: Newton steps of a numerical embedding per tick: the first starts within T^2 of the solution, the second ends at rounding
NEWTON = 2


class Closed:
    """Loops solved in closed form; nothing can drift."""

    def __init__(self, coordinates, embedding, definite):
        self.coordinates, self.embedding, self.definite = coordinates, embedding, definite
        self.second, self.first = embedding.drivers, ()

    def instant(self, translate):
        """The loops at one instant, to ask for rows, offsets and reactions."""
        return Instant(self.embedding, translate)

    def rates(self, instant, M, f):
        """The accelerations of the drivers."""
        B, b = self._motion(instant)
        return embedded(M, f, B, b, self.definite), []

    def reactions(self, instant, M, f):
        """constraint -> multiplier."""
        B, b = self._motion(instant)
        w = embedded(M, f, B, b, self.definite)
        a = [plus(dot(row, w), offset) for row, offset in zip(B, b, strict=True)]
        rest = [plus(dot(row, a), scaled(-1.0, right)) for row, right in zip(M, f, strict=True)]
        return instant.reactions(dict(zip(self.coordinates, rest, strict=True)))

    def settle(self, at, state):
        """The state as it is: a closed form is always on the constraints."""
        return state

    def _motion(self, instant):
        return [instant.row(q) for q in self.coordinates], [instant.offset(q) for q in self.coordinates]


class Multipliers:
    """Multipliers, with a projection of positions and rates after each tick, or Baumgarte's feedback ``alpha`` [1/s].

    ``weight`` is zero where the mass matrix is definite, else what makes it so.
    """

    def __init__(self, coordinates, constraints, alpha=None, weight=0.0):
        self.coordinates, self.constraints, self.alpha, self.weight = coordinates, constraints, alpha, weight
        self.second, self.first = tuple(coordinates), ()

    def instant(self, translate):
        """The constraints at one instant, to ask for gradients and residuals."""
        return Unreduced(self.coordinates, self.constraints, translate)

    def rates(self, instant, M, f):
        """The accelerations of all coordinates."""
        return self._solved(instant, M, f)[0], []

    def reactions(self, instant, M, f):
        """constraint -> multiplier."""
        return dict(zip(self.constraints, self._solved(instant, M, f)[1], strict=True))

    def _solved(self, instant, M, f):
        c = [scaled(-1.0, value) for value in instant.curvature]
        if self.alpha is not None:
            c = [plus(a, scaled(-1.0, b)) for a, b in zip(c, instant.feedback(self.alpha), strict=True)]
        return self._saddle(M, instant.J, f, c)

    def _saddle(self, M, J, f, c):
        if self.weight:
            M, f = stiffened(M, J, f, c, self.weight)
        real = next(value for row in (*M, *J) for value in row if hasattr(value, "type")).type
        return multipliers(M, J, f, c, LOST[real])

    def settle(self, at, state):
        """The state moved back onto the constraints, by as little as the masses allow.

        ``at(state)`` returns the instant and the mass matrix there. One Newton step for the positions; the rates lose
        what would leave the constraints. Both use the same factors.
        """
        if self.alpha is not None:
            return state
        q, w, s = state
        instant, M = at(state)
        still = [0.0] * len(q)
        off = [scaled(-1.0, g) for g in instant.residuals]
        moved, _ = self._saddle(M, instant.J, still, off)
        slipping = [scaled(-1.0, g) for g in instant.rates_of_constraints]
        kicked, _ = self._saddle(M, instant.J, still, slipping)
        return [plus(a, b) for a, b in zip(q, moved, strict=True)], [plus(a, b) for a, b in zip(w, kicked, strict=True)], s


class Unreduced:
    """Constraints at one instant, no coordinate solved for."""

    def __init__(self, coordinates, constraints, translate):
        self.coordinates, self.constraints, self.translate = coordinates, constraints, translate

    def leaf(self, expr):
        """None: every coordinate is integrated, so none follows from others."""
        return None

    @property
    def J(self):
        """Gradients by the coordinates, or by their rates where a constraint holds rates."""
        return [
            [self.translate(Partial(g, q if is_holonomic(g) else q.diff(t))) for q in self.coordinates] for g in self.constraints
        ]

    @property
    def curvature(self):
        """The second rate of each constraint less J a."""
        return [self.translate(Rate(Rate(g)) if is_holonomic(g) else Rate(g)) for g in self.constraints]

    @property
    def residuals(self):
        """What each constraint is off by; zero for one of rates, which no position can satisfy."""
        return [self.translate(g) if is_holonomic(g) else 0.0 for g in self.constraints]

    @property
    def rates_of_constraints(self):
        """What each constraint is off by in rate."""
        return [self.translate(Rate(g) if is_holonomic(g) else g) for g in self.constraints]

    def feedback(self, alpha):
        """Baumgarte's 2 alpha g' + alpha^2 g, or alpha times a constraint of rates."""
        terms = []
        for g, off, rate in zip(self.constraints, self.residuals, self.rates_of_constraints, strict=True):
            terms.append(2 * alpha * rate + alpha**2 * off if is_holonomic(g) else alpha * rate)
        return terms


class Partitioned:
    """A numerical embedding: some coordinates drive, the others follow by Newton's method from where they were.

    Between ticks the followers are integrated by their rates, which are exact; ``NEWTON`` steps a tick bring them back.
    """

    def __init__(self, coordinates, constraints, followers, definite):
        self.coordinates, self.constraints, self.definite = coordinates, constraints, definite
        self.first = tuple(followers)
        self.second = tuple(q for q in coordinates if q not in followers)

    def instant(self, translate):
        """The followers at one instant, to ask for their rates."""
        return Following(self, translate)

    def rates(self, instant, M, f):
        """The accelerations of the drivers and the rates of the followers."""
        return embedded(M, f, instant.B, instant.b, self.definite), [instant.leaf(u.diff(t)) for u in self.first]

    def reactions(self, instant, M, f):
        """constraint -> multiplier."""
        w = embedded(M, f, instant.B, instant.b, self.definite)
        a = [plus(dot(row, w), offset) for row, offset in zip(instant.B, instant.b, strict=True)]
        rest = [plus(dot(row, a), scaled(-1.0, right)) for row, right in zip(M, f, strict=True)]
        own = [rest[self.coordinates.index(u)] for u in self.first]
        return dict(zip(self.constraints, solve([list(column) for column in zip(*instant.J, strict=True)], own), strict=True))

    def settle(self, at, state):
        """The state with the followers back on the constraints."""
        for _ in range(NEWTON):
            instant, _ = at(state)
            q, w, s = state
            move = solve(instant.J, [instant.translate(g) for g in self.constraints])
            state = q, w, [plus(a, scaled(-1.0, b)) for a, b in zip(s, move, strict=True)]
        return state


class Following:
    """The followers of a numerical embedding at one instant."""

    def __init__(self, partition, translate):
        self.partition, self.translate = partition, translate
        self._rates = None

    @property
    def J(self):
        """Gradients of the constraints by the followers."""
        return [[self.translate(Partial(g, u)) for u in self.partition.first] for g in self.partition.constraints]

    def leaf(self, expr):
        """The rate of a follower, or None for any other expression."""
        if getattr(type(expr), "role", None) == "held":
            return self.translate(type(expr).of)
        if not (isinstance(expr, sp.Derivative) and expr.expr in self.partition.first):
            return None
        if self._rates is None:
            rest = []
            for g in self.partition.constraints:
                known = [p for p in self.partition.second if g.has(p)]
                moved = dot([self.translate(Partial(g, p)) for p in known], [self.translate(p.diff(t)) for p in known])
                rest.append(plus(moved, self.translate(rate_of_itself(g))))
            self._rates = [scaled(-1.0, value) for value in solve(self.J, rest)]
        rate = self._rates[self.partition.first.index(expr.expr)]
        return rate if isinstance(rate, Value) else self.translate(sp.Float(rate))

    @property
    def B(self):
        """How the rates of all coordinates follow the drivers'."""
        columns = []
        for p in self.partition.second:
            pull = [self.translate(Partial(g, p)) for g in self.partition.constraints]
            columns.append([scaled(-1.0, value) for value in solve(self.J, pull)])
        return self._filled(columns)

    def _filled(self, columns):
        second, first = self.partition.second, self.partition.first
        return [
            [1.0 if q == p else 0.0 for p in second] if q in second else [column[first.index(q)] for column in columns]
            for q in self.partition.coordinates
        ]

    @property
    def b(self):
        """What the accelerations are when the drivers have none."""
        curvature = [self.translate(Rate(Rate(g))) for g in self.partition.constraints]
        own = [scaled(-1.0, value) for value in solve(self.J, curvature)]
        first = self.partition.first
        return [own[first.index(q)] if q in first else 0.0 for q in self.partition.coordinates]
