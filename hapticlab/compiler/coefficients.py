"""Slopes of equations of motion, and whether they stay the same while a scene runs."""

from dataclasses import replace

import numpy as np
import sympy as sp

from ..scene.symbols import Parameter, T, delay, t, v, x
from .linear import Linear, states_of

#: the handle as an equation of motion sees it
HANDLE = (x(t), v(t))


class Coefficients:
    """Derivatives of a form's expressions, with what they hold.

    Parameters
    ----------
    form : ExplicitForm
    constants : dict name -> float
        Parameters whose value cannot change while it runs.
    """

    def __init__(self, form, constants, T):
        self.form, self.T = worked_out(form), T
        self.constants = dict(constants)
        self.states = states_of(form.coordinates, form.orders)
        self._known = {}

    def of(self, expr, variable):
        """Return the derivative of an expression."""
        key = expr, variable
        if key not in self._known:
            self._known[key] = derivative(expr, variable)
        return self._known[key]

    def why_not(self, k):
        """Return why equation k is not linear with constant coefficients, or None."""
        form, name = self.form, type(self.form.coordinates[k]).__name__
        for m in form.M[k]:
            moving = self._moving(m)
            if moving:
                return f"the inertia {m} of {name} changes with {moving}"
        why = self.slope_moves(form.f[k], f"in the equation of {name}")
        if why is None and t in leaves(form.f[k]):
            why = f"t drives the equation of {name} between two samples"
        return why

    def slope_moves(self, expr, where):
        """Return which term of an expression is not linear in states and handle, or None."""
        for term in sp.Add.make_args(expr):
            for variable in (*self.states, *HANDLE):
                moving = self._moving(self.of(term, variable))
                if moving:
                    return f"{_short(term)} {where} is not linear: its slope changes with {moving}"
        return None

    def _moving(self, expr):
        """Return what changes while it runs in a coefficient, as text, or nothing."""
        return ", ".join(sorted(str(leaf) for leaf in leaves(expr) if not isinstance(leaf, Parameter)))

    def sees(self, k):
        """Return the equations whose states enter equation k, in order."""
        of = {s: s.expr if isinstance(s, sp.Derivative) else s for s in self.states}
        seen = {of[leaf] for e in (*self.form.M[k], self.form.f[k]) for leaf in leaves(e) if leaf in of}
        return [j for j, q in enumerate(self.form.coordinates) if q in seen]

    def number(self, expr):
        """Return a coefficient as a float."""
        values = {p: sp.Float(self.T if p == T else self.constants[p.name]) for p in expr.atoms(Parameter)}
        return float(expr.xreplace(values))

    def at_start(self, expr):
        """Return an expression as a float, at the initial state with the handle at x = 0."""
        for _ in range(9):  # a start may be written with another
            starts = {leaf: _start(leaf) for leaf in leaves(expr) if not isinstance(leaf, Parameter)}
            if not starts:
                break
            expr = expr.xreplace(starts)
        return self.number(expr)

    def live(self, rows):
        """Return the names of parameters that would have to be constants for these equations, in order."""
        form, found = self.form, set()
        for k in rows:
            parts = [*form.M[k], *(self.of(form.f[k], var) for var in (*self.states, *HANDLE))]
            found |= {p.name for e in parts for p in e.atoms(Parameter) if p != T}
        return sorted(found - set(self.constants))

    def linear(self, rows):
        """Return the :class:`Linear` of these equations, which are closed and linear."""
        form = self.form
        rows = sorted(rows, key=lambda k: -form.orders[k])
        coordinates, orders = tuple(form.coordinates[k] for k in rows), tuple(form.orders[k] for k in rows)
        states = states_of(coordinates, orders)

        def numbers(table):
            return np.array([[self.number(e) for e in row] for row in table], float).reshape(len(rows), -1)

        return Linear(
            coordinates,
            orders,
            numbers([[form.M[i][j] for j in rows] for i in rows]),
            numbers([[self.of(form.f[i], s) for s in states] for i in rows]),
            numbers([[self.of(form.f[i], h) for h in HANDLE] for i in rows]),
        )


def worked_out(form):
    """Return a form whose derivatives are worked out in symbols."""
    return replace(
        form,
        M=tuple(tuple(m.doit() if _has_derivative(m) else m for m in row) for row in form.M),
        f=tuple(f.doit() if _has_derivative(f) else f for f in form.f),
        force=form.force.doit() if _has_derivative(form.force) else form.force,
    )


def _has_derivative(expr):
    return any(hasattr(e, "_worked_out") for e in sp.preorder_traversal(expr))


def derivative(expr, variable):
    """Return the partial derivative of an expression, its other leaves held."""
    held = {leaf: sp.Dummy(real=True) for leaf in leaves(expr)}
    back = {dummy: leaf for leaf, dummy in held.items()}
    return expr.xreplace(held).diff(held[variable]).xreplace(back) if variable in held else sp.S.Zero


def leaves(expr):
    """Return what an expression is made of: states, samples, delays, the handle, time and parameters."""
    found, stack = set(), [expr]
    while stack:
        e = stack.pop()
        if isinstance(e, (sp.Symbol, sp.Derivative, delay)) or hasattr(type(e), "role"):
            found.add(e)
        else:
            stack.extend(e.args)
    return found


def _start(leaf):
    if isinstance(leaf, sp.Derivative):
        return type(leaf.expr).rate
    return getattr(type(leaf), "initial", sp.S.Zero)


def _short(term):
    text = str(term)
    return text if len(text) <= 60 else f"{text[:57]}..."


def blocks(form):
    """Return the groups of equations that share a mass matrix block, as lists of rows."""
    N = len(form.coordinates)
    group = list(range(N))
    for i in range(N):
        for j in range(N):
            if form.M[i][j] != 0 and group[i] != group[j]:
                old, new = group[j], group[i]
                group = [new if g == old else g for g in group]
    return [[k for k in range(N) if group[k] == g] for g in sorted(set(group))]


def linear_rows(coefficients):
    """Return (rows, reasons): the equations that are linear by themselves, and why each other is not.

    Equations of one mass matrix block go together; one that sees a state which is not linear is not linear itself.
    """
    form, reasons = coefficients.form, {}
    groups = blocks(form)
    for rows in groups:
        why = next((why for why in map(coefficients.why_not, rows) if why), None)
        reasons |= {k: why for k in rows if why}
    settled = False
    while not settled:
        settled = True
        for rows in groups:
            driven = [(k, j) for k in rows for j in coefficients.sees(k) if j in reasons]
            if driven and not set(rows) & set(reasons):
                k, j = driven[0]
                names = [type(form.coordinates[i]).__name__ for i in (k, j)]
                why = f"{names[1]}, which is not linear, drives {names[0]} between two samples"
                reasons |= dict.fromkeys(rows, why)
                settled = False
    return [k for k in range(len(form.coordinates)) if k not in reasons], dict(sorted(reasons.items()))
