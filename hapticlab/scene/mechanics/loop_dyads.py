"""Solve one or two loop equations in closed form: a length, an angle, or a dyad (RRR, RRP, RPR) of two unknowns.

Each is at most a quadratic in the field's own terms: ``A cos(beta) + B sin(beta) + C = 0`` has the two solutions that a
loop has assemblies, and the initial state chooses between them. Norton, *Design of Machinery*, ch. 4.
"""

import math
from dataclasses import dataclass

import sympy as sp

from .loop_terms import NotClosed, Terms, number


@dataclass(frozen=True)
class Step:
    """One dependent coordinate, as an expression of the drivers and of the coordinates solved before it.

    Attributes
    ----------
    coordinate : sympy expression
    value : sympy expression
    cos, sin : sympy expression or None
        Of an angle, without the angle itself: what is cheaper than the cosine of an arc tangent.
    margin : sympy expression
        1 where the solution is best determined, 0 where two assemblies meet, negative where the loop cannot close.
    """

    coordinate: sp.Expr
    value: sp.Expr
    margin: sp.Expr = sp.S.One
    cos: sp.Expr = None
    sin: sp.Expr = None


class Equations(Terms):
    """Solves loop equations; see :class:`~hapticlab.scene.mechanics.loop_terms.Terms` for its arguments."""

    # one equation, one unknown

    def alone(self, expr, q):
        """The step that solves ``expr = 0`` for q."""
        found = self.terms(expr, {q})
        if set(found) <= {(q,), ()} and (q,) in found:
            return self._linear(q, found[q,], found.get((), sp.S.Zero))
        if set(found) <= {(q, q), (q,), ()}:
            return self._quadratic(q, *(found.get(m, sp.S.Zero) for m in ((q, q), (q,), ())))
        angle = _angle_in(found)
        return self._of(angle, q, self._circle(angle, found))

    def _linear(self, q, slope, rest):
        # a slope that moves is judged by its size at the start
        margin = sp.S.One if not _moves(slope) else slope**2 / number(slope, self.start) ** 2
        return Step(q, -rest / slope, margin)

    def _quadratic(self, q, a, b, c):
        if a == 0:
            raise NotClosed(f"{q} drops out")
        inside = b**2 - 4 * a * c
        size = b**2 + 4 * sp.Abs(a * c) if b != 0 else number(inside, self.start)
        side = 1 if 2 * number(a, self.start) * self.start[q] + number(b, self.start) >= 0 else -1
        return Step(q, (side * sp.sqrt(inside) - b) / (2 * a), inside / size)

    def _circle(self, angle, found):
        """(Cos, sin, margin) of an angle with A cos + B sin + C = 0."""
        cos, sin = sp.cos(angle), sp.sin(angle)
        if not set(found) <= {(cos,), (sin,), ()}:
            raise NotClosed(f"{angle} does not enter as A cos + B sin + C")
        A, B, C = (found.get(m, sp.S.Zero) for m in ((cos,), (sin,), ()))
        size = A**2 + B**2
        inside = size - C**2
        beta = number(angle, self.start)
        # the derivative of A cos + B sin at the solution is +- the root
        side = 1 if number(B, self.start) * math.cos(beta) - number(A, self.start) * math.sin(beta) >= 0 else -1
        root = side * sp.sqrt(inside)
        return (B * root - A * C) / size, (-A * root - B * C) / size, inside / size

    def _of(self, angle, q, solution):
        """The step of a coordinate from the cosine and sine of an angle, q or -q plus a known angle."""
        cos, sin, margin = solution
        sign = -1 if angle.coeff(q) == -1 else 1
        rest = sp.expand(angle - sign * q)
        if rest.has(q):
            raise NotClosed(f"{angle} is not {q} plus known angles")
        if rest == 0:
            return Step(q, _atan2(sign * sin, cos, self.start[q]), margin, cos, sign * sin)
        return Step(q, sign * (_atan2(sin, cos, number(angle, self.start)) - rest), margin)

    # two equations, two unknowns

    def pair(self, first, second, p, q):
        """The two steps that solve ``first = second = 0`` for p and q."""
        angles = {}
        found = [self.terms(e, {p, q}, angles) for e in (first, second)]
        angles = list(angles.values())
        lengths = [u for u in (p, q) if any(u in m for f in found for m in f)]
        if len(angles) == 2 and not lengths:
            return self._rrr(found, angles, (p, q))
        if len(angles) == 1 and len(lengths) == 1:
            length = lengths[0]
            other = q if length == p else p
            bilinear = any(len(m) == 2 for f in found for m in f)
            return (self._rpr if bilinear else self._rrp)(found, angles[0], other, length)
        if not angles and all(len(m) < 2 for f in found for m in f):
            return self._two_lengths(found, p, q)
        raise NotClosed("not a dyad")

    def _two_lengths(self, found, p, q):
        (a, b, c), (d, e, f) = ([row.get(m, sp.S.Zero) for m in ((p,), (q,), ())] for row in found)
        both = a * e - b * d
        first = self._linear(p, both, e * c - b * f)
        return first, Step(q, (d * c - a * f) / both)

    def _rrr(self, found, angles, unknown):
        """Two links: the second turns the first's end onto a circle about the other pivot."""
        first, last = sorted(angles, key=lambda a: sum(map(a.has, unknown)))
        of_links = {(kind(angle),) for kind in (sp.cos, sp.sin) for angle in angles}
        if not all(set(f) <= of_links | {()} for f in found) or all(map(first.has, unknown)):
            raise NotClosed("the angles are multiplied with each other")
        (pc, ps), (qc, qs) = self._link(found, last), self._link(found, first)
        rest = [f.get((), sp.S.Zero) for f in found]
        cos, sin = sp.cos(first), sp.sin(first)
        circle = {
            (cos,): 2 * (qc[0] * rest[0] + qc[1] * rest[1]),
            (sin,): 2 * (qs[0] * rest[0] + qs[1] * rest[1]),
            (): qc[0] ** 2 + qc[1] ** 2 + rest[0] ** 2 + rest[1] ** 2 - pc[0] ** 2 - pc[1] ** 2,
        }
        size = pc[0] ** 2 + pc[1] ** 2
        arm = [qc[k] * cos + qs[k] * sin + rest[k] for k in (0, 1)]
        turned = [-(link[0] * arm[0] + link[1] * arm[1]) / size for link in (pc, ps)]
        p, q = unknown if first.has(unknown[0]) else unknown[::-1]
        return self._of(first, p, self._circle(first, circle)), self._of(last, q, (*turned, sp.S.One))

    def _link(self, found, angle):
        """The coefficients (of x and y) of cos and of sin, which must be those of a link that turns."""
        c, s = ([f.get((kind(angle),), sp.S.Zero) for f in found] for kind in (sp.cos, sp.sin))
        if not (self.zero(c[0] ** 2 + c[1] ** 2 - s[0] ** 2 - s[1] ** 2) and self.zero(c[0] * s[0] + c[1] * s[1])):
            raise NotClosed(f"{angle} does not turn a rigid link")
        return c, s

    def _rrp(self, found, angle, q, length):
        """A slider on a line that does not turn with the angle: the length is eliminated first."""
        k = [f.pop((length,), sp.S.Zero) for f in found]
        monomials = set(found[0]) | set(found[1])
        across = {m: k[0] * found[1].get(m, sp.S.Zero) - k[1] * found[0].get(m, sp.S.Zero) for m in monomials}
        turned = self._of(angle, q, self._circle(angle, across))
        rest = [sp.Add(*(c * sp.Mul(*m) for m, c in f.items())) for f in found]
        return turned, Step(length, -(k[0] * rest[0] + k[1] * rest[1]) / (k[0] ** 2 + k[1] ** 2))

    def _rpr(self, found, angle, q, length):
        """A slider on a line that turns with the angle: the distance is known, and so the length."""
        cos, sin = sp.cos(angle), sp.sin(angle)
        keys = {(): "rest", (cos,): "c", (sin,): "s"}
        keys |= {tuple(sorted((length, a), key=sp.default_sort_key)): kind for a, kind in ((cos, "C"), (sin, "S"))}
        if not all(set(f) <= set(keys) for f in found):
            raise NotClosed("the slide has a part that does not turn")
        by = {name: [f.get(m, sp.S.Zero) for f in found] for m, name in keys.items()}
        C, S, c, s, e = (by[name] for name in ("C", "S", "c", "s", "rest"))
        turn = 1 if self.zero(S[0] + C[1]) and self.zero(S[1] - C[0]) else -1
        if not all(self.zero(b[0] + turn * a[1]) and self.zero(b[1] - turn * a[0]) for a, b in ((C, S), (c, s))):
            raise NotClosed(f"{angle} does not turn a rigid link")
        slide = self._quadratic(
            length, C[0] ** 2 + C[1] ** 2, 2 * (C[0] * c[0] + C[1] * c[1]),
            c[0] ** 2 + c[1] ** 2 - e[0] ** 2 - e[1] ** 2,
        )  # fmt: skip
        arm = [C[j] * length + c[j] for j in (0, 1)]
        size = e[0] ** 2 + e[1] ** 2
        turned = (
            -(e[0] * arm[0] + e[1] * arm[1]) / size,
            -turn * (e[1] * arm[0] - e[0] * arm[1]) / size,
            sp.S.One,
        )
        return slide, self._of(angle, q, turned)


def _moves(expr):
    """Whether an expression holds more than parameters."""
    return bool(expr.atoms(sp.Function)) or any(s.name == "t" for s in expr.free_symbols)


def _angle_in(found):
    angles = {a.args[0] for monomial in found for a in monomial if isinstance(a, (sp.cos, sp.sin))}
    if len(angles) != 1:
        raise NotClosed("no single angle is unknown")
    return angles.pop()


def _atan2(sin, cos, near):
    """The angle of a sine and cosine that lies nearest a value; its branch cut is half a turn away."""
    quarter = round(near / (math.pi / 2))
    y, x = [(sin, cos), (-cos, sin), (-sin, -cos), (cos, -sin)][quarter % 4]
    # left as it is: SymPy would ask at length for the signs of its arguments
    return sp.atan2(y, x, evaluate=False) + quarter * sp.pi / 2
