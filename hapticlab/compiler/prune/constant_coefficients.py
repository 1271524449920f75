"""Slopes of equations of motion, and whether they stay the same while a scene runs."""

import numpy as np
import sympy as sp

from ...scene.contact.contact import Contact
from ...scene.notation.derivative import Partial
from ...scene.notation.symbols import Parameter, T, delay, t, v, x
from ..algebra.graph import Graph, shown
from ..ir.channels import short
from .dependence import blocks, coupled
from .linear_parts import Linear, states_of

#: the handle as an equation of motion sees it
HANDLE = (x(t), v(t))
#: what jumps: its slope is zero on both sides
JUMPS = (sp.sign, sp.floor, sp.ceiling, sp.Mod, sp.Heaviside, sp.core.relational.Relational)


class Coefficients:
    """Slopes of a form's expressions, taken on the shared graph, with what they depend on.

    Parameters
    ----------
    form : ExplicitForm
    constants : dict name -> float
        Parameters whose value cannot change while it runs.
    T : float
        Sampling period [s].
    graph : Graph, optional
        Of the form's expressions, with the same constants.
    """

    def __init__(self, form, constants, T, graph=None):
        self.form, self.T, self.graph = form, T, graph or Graph(constants)
        self.states = states_of(form.coordinates, form.orders)

    def why_not(self, k):
        """Why equation k is not linear with constant coefficients, or None."""
        form, name = self.form, type(self.form.coordinates[k]).__name__
        for model in coupled(form):
            if form.coordinates[k] in model.coordinates:
                return _what_ties(name, model)
        moving = [(self._moving(m), q, m) for q, m in zip(form.coordinates, form.M[k], strict=True)]
        moving = [found for found in moving if found[0]]
        if not moving:
            return self.slope_moves(form.f[k], f"in the equation of {name}")
        # sin^2 + cos^2 holds an angle and stays the same: the cause is an entry whose number changes
        leaves, q, m = next((found for found in moving if self._varies(found[2])), moving[0])
        of = name if q == form.coordinates[k] else f"that couples {name} and {type(q).__name__}"
        of = f"of {of}" if of == name else of
        if not self._varies(m):
            return f"the inertia {short(m.doit(), 60)} {of} is written with {leaves}, although it is constant; simplify it"
        return f"the inertia {short(m.doit(), 60)} {of} changes with {leaves}"

    def slope_moves(self, expr, where):
        """The reason why an expression is not linear in states and handle, naming the term, or None."""
        cancels = None
        for term in sp.Add.make_args(expr):
            for jump in term.atoms(*JUMPS):  # its slope is zero on both sides, so that the slopes do not tell
                if {*self.graph.variables_of(jump.args)} & {*self.states, *HANDLE}:
                    return f"{short(term.doit(), 60)} {where} is not linear: it jumps with {short(jump, 40)}"
            for variable in (*self.states, *HANDLE):
                moving = self._moving(Partial(term, variable))
                if moving and self._varies(Partial(term, variable)):
                    return f"{short(term.doit(), 60)} {where} is not linear: its slope changes with {moving}"
                if moving:
                    cancels = cancels or (
                        f"{short(term.doit(), 60)} {where} is written with {moving}, although they cancel; simplify it"
                    )
        return cancels

    def _varies(self, expr):
        """Whether an expression is another number at other places; parameters keep their values."""
        somewhere = np.random.default_rng(1).uniform(0.5, 1.5, (64, 5))
        leaves = sorted(self.graph.variables_of([expr]), key=str)
        at = {a: row[0] if isinstance(a, Parameter) else row for a, row in zip(leaves, somewhere, strict=False)}
        values = np.broadcast_to(self.graph.evaluate([expr], at)[0], (5,)) if len(leaves) <= 64 else np.arange(2)
        return bool(np.ptp(values) > 1e-9 * np.abs(values).max() + 1e-12)

    def _moving(self, expr):
        """The variables of a coefficient that change while it runs, as text; empty where none do."""
        return ", ".join(sorted({shown(s) for s in self.graph.variables_of([expr]) if not isinstance(s, Parameter)}))

    def sees(self, k):
        """The equations whose states enter equation k, in order."""
        of = {s: s.expr if isinstance(s, sp.Derivative) else s for s in self.states}
        seen = {of[s] for s in self.graph.variables_of([*self.form.M[k], self.form.f[k]]) if s in of}
        return [j for j, q in enumerate(self.form.coordinates) if q in seen]

    def numbers(self, exprs, values=None):
        """Expressions as floats: at the start, with the handle at x = 0, where they depend on the state."""
        at = {s: self._start(s, values or {}) for s in self.graph.variables_of(exprs)}
        return [float(number) for number in self.graph.evaluate(exprs, at)]

    def _start(self, variable, values):
        if isinstance(variable, Parameter):
            return self.T if variable == T else values[variable.name]
        if isinstance(variable, sp.Derivative):
            return self.numbers([type(variable.expr).rate], values)[0]
        return self.numbers([getattr(type(variable), "initial", sp.S.Zero)], values)[0]

    def live(self, rows):
        """The names of parameters that would have to be constants for these equations, in order."""
        form, found = self.form, set()
        for k in rows:
            parts = [*form.M[k], *(Partial(form.f[k], variable) for variable in (*self.states, *HANDLE))]
            found |= {p.name for p in self.graph.variables_of(parts) if isinstance(p, Parameter) and p != T}
        return sorted(found)

    def linear(self, rows):
        """The :class:`Linear` of these equations, which are closed and linear."""
        form = self.form
        rows = sorted(rows, key=lambda k: -form.orders[k])
        coordinates, orders = tuple(form.coordinates[k] for k in rows), tuple(form.orders[k] for k in rows)
        states = states_of(coordinates, orders)

        def table(entries, width):
            return np.reshape(self.numbers(entries), (len(rows), width))

        return Linear(
            coordinates,
            orders,
            table([form.M[i][j] for i in rows for j in rows], len(rows)),
            table([Partial(form.f[i], state) for i in rows for state in states], len(states)),
            table([Partial(form.f[i], handle) for i in rows for handle in HANDLE], 2),
        )


def _what_ties(name, model):
    """Say what holds a coordinate of a model beside M and f: a constraint, an impact or a friction that sticks."""
    if model.constraints:
        return f"{name} is tied by a constraint"
    element = next(c for c in model.contacts if not c.is_force)
    does = "stops it instantaneously" if isinstance(element, Contact) else "may stick"
    return f"{name} is a coordinate of a model with {element.name}, which {does}"


def leaves(expr):
    """The leaves of an expression: states, samples, delays, the handle, time and parameters."""
    found, stack = set(), [expr]
    while stack:
        e = stack.pop()
        if isinstance(e, (sp.Symbol, sp.Derivative, delay)) or hasattr(type(e), "role"):
            found.add(e)
        else:
            stack.extend(e.args)
    return found


def linear_rows(coefficients):
    """(rows, reasons): the equations that are linear by themselves, and why each other is not, causes first.

    Equations of one mass matrix block go together; one that sees a state which is not linear is not linear itself.
    """
    form, reasons = coefficients.form, {}
    groups = blocks(form, coefficients.graph)
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
    return [k for k in range(len(form.coordinates)) if k not in reasons], reasons
