"""Expressions of a scene as plain Python functions of named numbers, for pictures: fast, and nothing is compiled."""

from functools import cache, reduce

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.printing.numpy import NumPyPrinter

from ...scene.notation.amount import Amount
from ...scene.notation.symbols import delay, v, x

#: the handle's place in a formula
HANDLE = sp.Symbol("x", real=True)


def plain_symbols(expr):
    """Return an expression at rest, of symbols alone: every sample of the handle is its place, what moves has no rate."""
    rates = dict.fromkeys(expr.atoms(sp.Derivative), sp.S.Zero)
    expr = expr.xreplace(rates)
    while expr.atoms(delay):
        expr = expr.xreplace({held: held.args[0] for held in expr.atoms(delay)})
    known = dict.fromkeys(expr.atoms(x), HANDLE) | dict.fromkeys(expr.atoms(v), sp.S.Zero)
    known |= {one: one.value for one in expr.atoms(Amount)}
    known |= {f: sp.Symbol(type(f).__name__, real=True) for f in expr.atoms(AppliedUndef)}
    return expr.xreplace(known).xreplace({s: sp.Symbol(s.name, real=True) for s in expr.free_symbols})


def formula(*expressions):
    """Return a function of a dict of numbers, which gives the value of each expression, and the names it needs.

    Parameters
    ----------
    *expressions : sympy expressions
        Of the handle ``x``, coordinates, signals and parameters; taken at rest. Where one of them is not given as a number but as
        an array, or a node of :mod:`~hapticlab.analysis.pictures.graph`, NumPy does it: what has no value is nan there.

    Returns
    -------
    function, frozenset of str

    Examples
    --------
    >>> import hapticlab as hl
    >>> force, names = formula(hl.wall().force)
    >>> sorted(names), force({"x": 0.012, "x_o": 0.01, "k": 500.0})
    (['k', 'x', 'x_o'], [1.0])
    """
    plain = [plain_symbols(sp.sympify(expr)) for expr in expressions]
    symbols = sorted(set().union(*(expr.free_symbols for expr in plain)), key=str)
    names = [symbol.name for symbol in symbols]
    numbers = sp.lambdify(symbols, plain, "math", cse=True)
    arrays = cache(lambda: sp.lambdify(symbols, plain, "numpy", cse=True, printer=_Printer))

    def values(known):
        given = [known[name] for name in names]
        return (numbers if all(isinstance(one, (int, float)) for one in given) else arrays())(*given)

    return values, frozenset(names)


class _Printer(NumPyPrinter):
    """Writes cases and extremes in functions of two arrays, which a node takes, too."""

    def __init__(self, settings=None):
        super().__init__({"fully_qualified_modules": False, "inline": True, "allow_unknown_functions": True, **(settings or {})})

    def _print_Piecewise(self, cases):
        return reduce(lambda other, case: self._where(*case.args, other), reversed(cases.args), "nan")

    def _where(self, value, condition, other):
        return f"where({self._print(condition)}, {self._print(value)}, {other})"

    def _print_Max(self, extreme):
        return reduce(lambda one, two: f"maximum({one}, {two})", map(self._print, extreme.args))

    def _print_Min(self, extreme):
        return reduce(lambda one, two: f"minimum({one}, {two})", map(self._print, extreme.args))

    def _print_And(self, conditions):
        return reduce(lambda one, two: f"logical_and({one}, {two})", map(self._print, conditions.args))

    def _print_Or(self, conditions):
        return reduce(lambda one, two: f"logical_or({one}, {two})", map(self._print, conditions.args))
