"""Equations of motion in explicit form: M(q, p) a = f(q, q', x, v, t; p), never inverted in symbols.

``a`` holds the highest derivative of each coordinate (second order, or first). M and f are read off the student's
equations; the compiler emits the solution as an unrolled LDL^T.
"""

import math
import random
from dataclasses import dataclass, replace

import mpmath
import sympy as sp

from ..errors import MassError, SceneError
from .aliases import definitions, substituted
from .symbols import Parameter, T, delay, t


@dataclass(frozen=True)
class ExplicitForm:
    """``M a = f`` with the difference equations and the outputs beside it.

    Attributes
    ----------
    coordinates : tuple of sympy expressions, shape (N,)
    orders : tuple of int, shape (N,)
        2 where the equation holds q'', 1 where it holds q' only.
    M : tuple of tuples of sympy expressions, shape (N, N)
    f : tuple of sympy expressions, shape (N,)
    updates : dict y(n) -> expression
    force : sympy expression [N]
    watch : dict name -> expression
    definite : bool
        M was symmetric and of one sign at every configuration looked at: the initial state and others over a turn of
        every angle, with parameters at their bound values. Then it may be factored without pivoting.
    """

    coordinates: tuple
    orders: tuple
    M: tuple
    f: tuple
    updates: dict
    force: sp.Expr
    watch: dict
    definite: bool = False

    def __str__(self):
        lines = [f"F = {self.force}"]
        for row, right in zip(self.M, self.f, strict=True):
            terms = [f"({m})*{a}" for m, a in zip(row, self.unknowns, strict=True) if m != 0]
            lines.append(f"{' + '.join(terms)} = {right}")
        return "\n".join(lines + [f"{y} = {expr}" for y, expr in self.updates.items()])

    @property
    def unknowns(self):
        """The highest derivative of each coordinate."""
        return tuple(q.diff(t, order) for q, order in zip(self.coordinates, self.orders, strict=True))


def explicit_form(scene):
    """Return the scene's :class:`ExplicitForm`.

    Raises
    ------
    MassError
        A coordinate has no equation, the equations outnumber the coordinates, or they are dependent (singular mass).
    SceneError
        A highest derivative enters nonlinearly, a signal does not stand alone on the left of its equation, or a
        coordinate of first order is given an initial rate.
    """
    updates = {e.lhs: e.rhs for e in scene.eom if getattr(type(e.lhs), "role", None) == "signal"}
    equations = [e for e in scene.eom if e.lhs not in updates]
    known, equations = definitions(equations, scene.coordinates)

    def put(expr):
        return substituted(expr, known)

    equations = [sp.Eq(*map(put, e.args), evaluate=False) for e in equations] if known else equations
    updates = {y: put(expr) for y, expr in updates.items()}
    coordinates = tuple(q for q in scene.coordinates if q not in known)
    _check_signals(equations)
    orders = tuple(_order(q, equations) for q in coordinates)
    if len(equations) != len(coordinates):
        named = ", ".join(type(q).__name__ for q in coordinates) or "none"
        raise MassError(
            f"{len(equations)} equations of motion for {len(coordinates)} coordinates ({named}); give one for each"
        )
    unknowns = tuple(q.diff(t, order) for q, order in zip(coordinates, orders, strict=True))
    rows = [_affine(e.lhs - e.rhs, unknowns, e) for e in equations]
    M = [tuple(coefficients.get(a, sp.S.Zero) for a in unknowns) for coefficients, _ in rows]
    M, f = _in_order(M, [-rest for _, rest in rows], coordinates)
    watch = {name: put(expr) for name, expr in scene.watch.items()}
    form = ExplicitForm(coordinates, orders, tuple(M), tuple(f), updates, put(scene.force), watch)
    return replace(form, definite=_check_mass(form, scene.values))


def _order(q, equations):
    sides = [side for e in equations for side in e.args]
    counts = [d.derivative_count for side in sides for d in side.atoms(sp.Derivative) if d.expr == q]
    name = type(q).__name__
    if not counts:
        raise MassError(
            f"no equation determines {name}: none holds its rate or acceleration; "
            f"add an equation of motion with {name}.diff(t, 2), or define {name} as an expression"
        )
    if max(counts) > 2:
        raise MassError(f"{name} appears with derivative {max(counts)}; equations of motion go up to the second")
    rate = getattr(type(q), "rate", sp.S.Zero)
    if max(counts) == 1 and rate != 0:
        raise SceneError(
            f"{name} has an equation of first order, which gives its rate; rate={rate} would be lost: leave it out, "
            f"or write an equation with {name}.diff(t, 2)"
        )
    return max(counts)


def _check_signals(equations):
    """Refuse an equation that moves no coordinate and defines no signal."""
    for e in equations:
        functions = e.atoms(sp.Function)
        signals = sorted({type(a).__name__ for a in functions if getattr(type(a), "role", None) == "signal"})
        if signals and not e.atoms(sp.Derivative):
            raise SceneError(
                f"{e.lhs} = {e.rhs} defines nothing: write the signal alone on the left, sp.Eq({signals[0]}(n), ...)"
            )


def _affine(expr, unknowns, equation):
    """Split into ({unknown: coefficient}, rest), by walking sums and products only: no expansion, no swell."""
    if expr in unknowns:
        return {expr: sp.S.One}, sp.S.Zero
    if not expr.has(*unknowns):
        return {}, expr
    if isinstance(expr, sp.Add):
        total, rest = {}, []
        for part in expr.args:
            coefficients, remainder = _affine(part, unknowns, equation)
            rest.append(remainder)
            for a, c in coefficients.items():
                total.setdefault(a, []).append(c)
        return {a: sp.Add(*cs) for a, cs in total.items()}, sp.Add(*rest)
    holding = [a for a in expr.args if a.has(*unknowns)]
    if isinstance(expr, sp.Mul) and len(holding) == 1:
        others = sp.Mul(*(a for a in expr.args if a is not holding[0]))
        coefficients, rest = _affine(holding[0], unknowns, equation)
        return {a: c * others for a, c in coefficients.items()}, rest * others
    raise SceneError(
        f"{equation.lhs} = {equation.rhs}: the accelerations must enter linearly, but {expr} does not; "
        "solve that term for the acceleration, or move it out of functions, powers and cases"
    )


def _in_order(M, f, coordinates):
    """Put each equation on the row of a coordinate it determines, so that pivots lie on the diagonal.

    The rows are kept where the student's order already does. Otherwise: a maximum matching of equations to unknowns.
    """
    N = len(coordinates)
    if all(M[k][k] != 0 for k in range(N)):
        return M, f
    row_of = [None] * N

    def place(row, tried):
        for column in range(N):
            if M[row][column] != 0 and column not in tried:
                tried.add(column)
                if row_of[column] is None or place(row_of[column], tried):
                    row_of[column] = row
                    return True
        return False

    if not all(place(row, set()) for row in range(N)):
        missing = next((type(q).__name__ for q, row in zip(coordinates, row_of, strict=True) if row is None), "?")
        raise MassError(
            f"singular mass: no equation is left to determine {missing}; each coordinate needs an equation of its own"
        )
    return [M[row] for row in row_of], [f[row] for row in row_of]


def _check_mass(form, values):
    """Tell whether the mass matrix is definite; refuse one that is singular at three generic configurations."""
    configurations = _configurations(form, values)
    generic = [M for M in (_mass_at(form, next(configurations)) for _ in range(3)) if M]
    if all(map(_singular, generic)) and generic:
        _, _, directions = mpmath.svd_r(mpmath.matrix(_balanced(generic[-1])))
        worst = directions[len(form.M) - 1, :]
        names = [type(q).__name__ for q, c in zip(form.coordinates, worst, strict=True) if abs(c) > 1e-6]
        raise MassError(
            f"singular mass: the equations do not determine the accelerations of {' and '.join(names)} "
            "(a massless direction, or an equation that repeats another); give each its own mass or equation"
        )
    return (
        len(generic) == 3
        and all(map(_definite, generic))
        and all(_definite(_mass_at(form, at)) for at in configurations)
    )


def _configurations(form, values):
    """Yield what every symbol of M is: three times generic, at the initial state, then over a turn of every angle."""
    symbols = set().union(*(_variables(m) for row in form.M for m in row))
    starts = {s: _start(s) for s in symbols}
    symbols = sorted(symbols.union(*map(_variables, starts.values())), key=str)
    bound = {s: sp.Float(values[s.name]) for s in symbols if isinstance(s, Parameter) and s.name in values}
    bound[T] = sp.Float(1e-3)
    generator = random.Random(23)

    def sample(most=None):
        ranges = ((0.5, 1.5) if most is None or isinstance(s, Parameter) else (-most, most) for s in symbols)
        return {s: sp.Float(generator.uniform(*limits)) for s, limits in zip(symbols, ranges, strict=True)} | bound

    for _ in range(3):
        yield sample()
    at = {s: value if isinstance(s, Parameter) else sp.S.Zero for s, value in sample().items()}
    yield at | {s: start.xreplace(at) for s, start in starts.items()}
    for _ in range(5):
        yield sample(most=3.0)


def _variables(expr):
    """Return what a number can be put in place of: symbols, coordinates, their rates, samples and delays."""
    functions = expr.atoms(sp.Function, sp.Derivative)
    return expr.free_symbols | {
        f for f in functions if hasattr(type(f), "role") or isinstance(f, (sp.Derivative, delay))
    }


def _start(symbol):
    """Return the initial value of a variable; the handle and time start at zero, a parameter is what it is."""
    if isinstance(symbol, sp.Derivative):
        return getattr(type(symbol.expr), "rate", sp.S.Zero)
    return symbol if isinstance(symbol, Parameter) else getattr(type(symbol), "initial", sp.S.Zero)


def _mass_at(form, at):
    """Return M as floats, or None where it is not real and finite."""
    known = {}
    for m in {m for row in form.M for m in row}:
        number = m.xreplace(at).evalf()
        if not (number.is_Float or number.is_Rational):
            return None
        known[m] = float(number)
    return [[known[m] for m in row] for row in form.M] if all(map(math.isfinite, known.values())) else None


def _singular(M):
    singular_values = mpmath.svd_r(mpmath.matrix(_balanced(M)), compute_uv=False)
    return singular_values[len(M) - 1] <= 1e-10 * singular_values[0]


def _definite(M):
    """Tell whether M is symmetric and its pivots, of entries scaled to a unit diagonal, have one sign and are not small."""
    if not M or not all(row[k] * M[0][0] > 0 for k, row in enumerate(M)):
        return False
    N = len(M)
    sign = math.copysign(1.0, M[0][0])
    S = [[sign * m / math.sqrt(M[i][i] * M[j][j]) for j, m in enumerate(row)] for i, row in enumerate(M)]
    if any(abs(S[i][j] - S[j][i]) > 1e-12 for i in range(N) for j in range(i)):
        return False
    for j in range(N):
        if S[j][j] < 1e-6:
            return False
        for i in range(j + 1, N):
            factor = S[i][j] / S[j][j]
            S[i] = [a - factor * b for a, b in zip(S[i], S[j], strict=True)]
    return True


def _balanced(M):
    """Scale rows and columns to their largest entries, so that grams beside kilograms are not taken for nothing."""
    rows = [max(map(abs, row)) or 1.0 for row in M]
    columns = [max(map(abs, column)) or 1.0 for column in zip(*M, strict=True)]
    return [[m / math.sqrt(r * c) for m, c in zip(row, columns, strict=True)] for row, r in zip(M, rows, strict=True)]
