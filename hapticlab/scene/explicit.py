"""Equations of motion in explicit form: M(q, p) a = f(q, q', x, v, t; p), never inverted in symbols.

``a`` holds the highest derivative of each coordinate (second order, or first). M and f are read off the student's
equations; the compiler emits the solution as an unrolled LDL^T.
"""

from dataclasses import dataclass

import sympy as sp

from ..base.shows_itself import Typeset
from ..errors import MassError, SceneError
from .aliases import definitions, substituted
from .mechanics.lagrange import Mechanics
from .notation.checks import applied
from .notation.derivative import Rate
from .notation.symbols import t
from .notation.typeset import typeset


@dataclass(frozen=True)
class ExplicitForm(Typeset):
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
    models : tuple of Mechanics
        The models among the equations of motion, with their constraints and contacts.
    """

    coordinates: tuple
    orders: tuple
    M: tuple
    f: tuple
    updates: dict
    force: sp.Expr
    watch: dict
    models: tuple = ()

    def _sentence(self):
        return f"the equations solved for {len(self.coordinates)} accelerations and {len(self.updates)} signals"

    def _facts(self):
        return []

    def _equations(self):
        rows = [sum(m * a for m, a in zip(row, self.unknowns, strict=True)) for row in self.M]
        lines = [f"{typeset(row)} = {typeset(right)}" for row, right in zip(rows, self.f, strict=True)]
        return [f"F_e = {typeset(self.force)}", *lines, *(f"{typeset(y)} = {typeset(expr)}" for y, expr in self.updates.items())]

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
    """The :class:`ExplicitForm` of a scene.

    Raises
    ------
    MassError
        A coordinate has no equation, the equations outnumber the coordinates, or they are dependent (singular mass).
    SceneError
        A highest derivative enters nonlinearly, a signal does not stand alone on the left of its equation, or a
        coordinate of first order is given an initial rate.
    """
    models = scene.models
    written = [e for e in scene.eom if not isinstance(e, Mechanics)]
    updates = {e.lhs: e.rhs for e in written if getattr(type(e.lhs), "role", None) == "signal"}
    modelled = [q for model in models for q in model.coordinates]
    _check_models(modelled)
    equations = [e for e in written if e.lhs not in updates]
    known, equations = definitions(equations, [q for q in scene.coordinates if q not in modelled]) if equations else ({}, [])

    def put(expr):
        return substituted(expr, known) if known else expr

    equations = [sp.Eq(*map(put, e.args), evaluate=False) for e in equations] if known else equations
    updates = {y: put(expr) for y, expr in updates.items()}
    _check_signals(equations)
    own = tuple(q for q in scene.coordinates if q not in known and q not in modelled)
    if len(equations) != len(own):
        named = ", ".join(type(q).__name__ for q in own) or "none"
        for q in own:
            _order(q, equations)  # names the one that has no equation
        _check_unmodelled(equations, modelled)
        raise MassError(f"{len(equations)} equations of motion for {len(own)} coordinates ({named}); give one for each")
    orders = {q: _order(q, equations) for q in own}
    orders |= {q: order for model in models for q, order in zip(model.coordinates, model.orders, strict=True)}
    _check_gaps([c for model in models for c in model.contacts], orders)
    coordinates = tuple(q for q in scene.coordinates if q in orders)
    M, f = _rows(equations, own, coordinates, orders)
    for model in models:
        for q, row, right in zip(model.coordinates, model.M, model.f, strict=True):
            entries = dict(zip(model.coordinates, row, strict=True))
            M[q], f[q] = tuple(put(entries.get(p, sp.S.Zero)) for p in coordinates), put(right)
    return ExplicitForm(
        coordinates,
        tuple(orders[q] for q in coordinates),
        tuple(M[q] for q in coordinates),
        tuple(f[q] for q in coordinates),
        updates,
        put(scene.force),
        {name: put(expr) for name, expr in scene.watch.items()},
        models,
    )


def _rows(equations, own, coordinates, orders):
    """Two dicts, coordinate -> row of M and coordinate -> right side, of the equations as written."""
    unknowns = [q.diff(t, orders[q]) for q in coordinates]
    rows = [_affine(e.lhs - e.rhs, unknowns, e) for e in equations]
    M = [tuple(coefficients.get(a, sp.S.Zero) for a in unknowns) for coefficients, _ in rows]
    M, f = _in_order(M, [-rest for _, rest in rows], [coordinates.index(q) for q in own], coordinates)
    return dict(zip(own, M, strict=True)), dict(zip(own, f, strict=True))


def _check_models(modelled):
    twice = next((q for q in modelled if modelled.count(q) > 1), None)
    if twice is not None:
        name = type(twice).__name__
        raise SceneError(f"two Lagrangians move {name}; add the energies and give one hl.mechanics.lagrange(L_1 + L_2)")


def _check_gaps(contacts, orders):
    """Refuse a law that asks for the rate or the acceleration of a gap where no state has them."""
    for c in contacts:
        first = [type(q).__name__ for q in applied([getattr(c, "gap", sp.S.Zero)], "coordinate") if orders.get(q) == 1]
        if first and (not c.is_force or c.force.has(Rate)):
            asks = "damps with the rate" if c.is_force else "needs the acceleration"
            raise SceneError(
                f"{c.name}: its gap contains {first[0]}, which has an equation of first order, and its law {asks} of the "
                "gap. Use a penalty law without damping, hl.contact.penalty(k=...). With found = hl.shapes.track(...), a "
                "damped law works "
                "as forces={q: found.generalized_force(law, q)} instead of the contact"
            )


def _check_unmodelled(equations, modelled):
    for q in modelled:
        if any(d.expr == q and d.derivative_count == 2 for e in equations for d in e.atoms(sp.Derivative)):
            name = type(q).__name__
            raise MassError(
                f"{name} is moved by a Lagrangian, which moves every coordinate in it, and also by an equation of its own. "
                f"Add the energy of {name} to the Lagrangian, its forces as forces={{{name}: ...}}, and leave out the equation"
            )


def _order(q, equations):
    sides = [side for e in equations for side in e.args]
    counts = [d.derivative_count for side in sides for d in side.atoms(sp.Derivative) if d.expr == q]
    name = type(q).__name__
    if not counts:
        raise MassError(
            f"no equation determines {name}, because none contains its rate or acceleration. Add an equation of motion with "
            f"{name}.diff(t, 2), or define {name} as an expression"
        )
    if max(counts) > 2:
        raise MassError(f"{name} appears with derivative {max(counts)}; equations of motion go up to the second")
    rate = getattr(type(q), "rate", sp.S.Zero)
    if max(counts) == 1 and rate != 0:
        raise SceneError(
            f"{name} has an equation of first order, which gives its rate, so rate={rate} would have no effect. Leave it "
            f"out, or write an equation with {name}.diff(t, 2)"
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


def _in_order(M, f, columns, coordinates):
    """Put each equation on the row of a coordinate it determines, so that pivots lie on the diagonal.

    ``columns`` are those of the coordinates that have equations of their own. The rows are kept where the student's
    order already does; otherwise: a maximum matching of equations to unknowns.
    """
    if all(M[row][column] != 0 for row, column in enumerate(columns)):
        return M, f
    row_of = dict.fromkeys(columns)

    def place(row, tried):
        for column in columns:
            if M[row][column] != 0 and column not in tried:
                tried.add(column)
                if row_of[column] is None or place(row_of[column], tried):
                    row_of[column] = row
                    return True
        return False

    if not all(place(row, set()) for row in range(len(columns))):
        missing = next((type(coordinates[column]).__name__ for column, row in row_of.items() if row is None), "?")
        raise MassError(f"singular mass: no equation determines {missing}; each coordinate needs an equation of its own")
    return [M[row_of[column]] for column in columns], [f[row_of[column]] for column in columns]
