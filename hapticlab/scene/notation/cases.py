"""Cases: an expression that is one thing where a condition holds and another elsewhere, kept as written."""

from __future__ import annotations

from typing import Any

import sympy as sp
from sympy.functions.elementary.piecewise import ExprCondPair

from .written import condition as as_condition
from .written import expression


class Case(ExprCondPair):
    """A value and its condition; SymPy's own pair rewrites a condition that holds cases itself."""

    def __new__(cls, value, condition):
        return sp.Tuple.__new__(cls, value, condition)


class Piecewise(sp.Piecewise):
    """SymPy's Piecewise, never evaluated: SymPy would rearrange a condition, and move the boundary by a rounding.

    It keeps the name, by which SymPy's printers know how to set it.
    """

    def __new__(cls, *cases, **_):
        return sp.Basic.__new__(cls, *(Case(*getattr(case, "args", case)) for case in cases))


def when(condition: Any, value: sp.Expr | float, otherwise: sp.Expr | float = 0) -> sp.Expr:
    """One value where a condition holds and another value elsewhere, such as the cases of Eq. (23.1).

    Parameters
    ----------
    condition : sympy relation, such as ``x(n) >= x_o``
        ``sp.Eq(a, b)`` for equality; ``&``, ``|`` and ``~`` combine conditions.
    value, otherwise : expression

    Raises
    ------
    SceneError
        ``condition`` is not a relation of expressions, such as the False that ``x(n) == x_o`` gives in Python.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, x_o = hl.parameters("k x_o", units="N/m m")
    >>> hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o))
    Piecewise((k*(-x_o + x(n)), x(n) >= x_o), (0, True))
    """
    return Piecewise((expression(value, "value"), as_condition(condition)), (expression(otherwise, "otherwise"), sp.true))
