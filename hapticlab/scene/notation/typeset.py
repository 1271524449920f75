"""Equations as LaTeX in the order in which they are written by hand: x(n) - x_o, not -x_o + x(n).

SymPy keeps the terms of a sum in an order of its own, so the order in which they were typed is lost. This printer begins
with what is positive, puts what moves before constants, and samples from the newest to the oldest. Coordinates stand
without their time, and their rates carry dots.
"""

from __future__ import annotations

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.printing.latex import LatexPrinter

from .symbols import delay, lag_of, n, t, v, x


def typeset(expr: sp.Basic) -> str:
    r"""An expression or equation as LaTeX.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, x_o = hl.parameters("k x_o", units="N/m m")
    >>> print(typeset(k * (hl.x(hl.n) - x_o)))
    k \left(x(n) - x_{o}\right)
    >>> z = hl.coordinate("z", unit="m")
    >>> print(typeset(-k * z - z.diff(hl.t) + hl.x(hl.n - 1)))
    x(n-1) - k z - \dot{z}
    """
    return _Printer({"mul_symbol": None}).doprint(expr)


class _Printer(LatexPrinter):
    """SymPy's printer with the terms of a sum as a hand writes them."""

    def _as_ordered_terms(self, expr, order=None):
        return in_order(expr)

    def _print_Function(self, expr, exp=None):
        name, at = self._deal_with_super_sub(type(expr).__name__), expr.args
        if not is_named(expr):
            return super()._print_Function(expr, exp)
        if at[0] != t:
            name += f"({sample_of(expr) or self._print(at[0])})"
        return f"{name}^{{{exp}}}" if exp else name

    def _print_Derivative(self, expr):
        return _dotted(self, expr) or super()._print_Derivative(expr)

    def _print_Pow(self, expr):
        dotted = isinstance(expr.base, sp.Derivative) and expr.exp.is_Integer and expr.exp > 0 and _dotted(self, expr.base)
        return f"{dotted}^{{{expr.exp}}}" if dotted else super()._print_Pow(expr)


def _dotted(printer, expr):
    """A rate or an acceleration of a coordinate with its dots, or None for other derivatives."""
    return rf"\{'d' * dots(expr)}ot{{{printer._print(expr.expr)}}}" if dots(expr) else None


def dots(expr):
    """Return how many dots a derivative has over its coordinate, 1 or 2, or 0 where it is another derivative."""
    order = dict(expr.variable_count).get(t)
    return order if isinstance(expr.expr, AppliedUndef) and expr.expr.args == (t,) and order in (1, 2) else 0


def is_named(expr):
    """Tell whether a function is a coordinate, a signal or the handle, which have names of their own."""
    return isinstance(expr, (AppliedUndef, x, v)) and len(expr.args) == 1


def sample_of(expr):
    """Return which sample a signal is taken at, such as "n-1", or nothing where it is none."""
    lag = lag_of(expr) if expr.args[0].has(n) else None
    return "" if lag is None else f"n{-lag:+d}" if lag else "n"


def in_order(expr):
    """Return the terms of a sum as a hand writes them."""
    kinds = {term: _moving(term) for term in expr.args}
    leading: dict = {}
    for term in sorted(expr.args, key=lambda term: (kinds[term][2], str(term))):
        leading.setdefault(kinds[term][:2], term.could_extract_minus_sign())
    return sorted(expr.args, key=lambda term: (leading[kinds[term][:2]], *kinds[term], str(term)))


def _moving(term):
    """What orders a term of a sum: whether nothing moves in it, what does (accelerations first), and the newest sample's lag."""
    orders = [sum(count for _, count in d.variable_count) for d in term.atoms(sp.Derivative)]
    moving = term.atoms(AppliedUndef, x, v)
    highest = max(orders, default=0)
    names = sorted({"x": "", "v": "~"}.get(type(one).__name__, type(one).__name__) for one in moving)
    lags = [lag_of(one) for one in moving if one.args[0].has(n)]
    late = min(lags, default=0) + len(term.atoms(delay))
    return (not moving, (0 if highest >= 2 else 1, min(highest, 1), *names), late)
