"""Answers written as expressions or equations of SymPy: their values at given points.

Nothing is simplified and no text is parsed: symbols are replaced by numbers, and whether two expressions mean the same
is for the numbers to tell. Points name what an expression may hold as it is written, without spaces:

======================================  ===================================================
``k``, ``x_o``, ``T``                   a parameter, or a plain symbol
``x(n)``, ``x(n-1)``, ``v(n)``          a sample
``x(t)``, ``v(t)``                      the handle, in an equation of motion
``z``, ``z'``, ``z''``, ``theta'``      a coordinate, or another function of time, and its rates
======================================  ===================================================
"""

import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef

from ..base.units import dimension, si_name
from ..errors import UnitsError
from ..scene.notation.symbols import delay, n
from ..scene.notation.units import agree
from .plain_values import NotPlain, a

#: how far an equation may be from a straight line in what it is solved for, of its largest term
STRAIGHT = 1e-9


def values(answer, at, solve_for=()):
    """Values of an expression at points, or an equation's solutions there.

    Parameters
    ----------
    answer : sympy expression or number; with ``solve_for`` sympy.Eq, or an expression that is zero, or a list of these
    at : dict of str to sequence of float
        What the answer may hold, and its value at each point.
    solve_for : str or sequence of str
        What the equations, as many, are solved for; they must be linear in it.

    Returns
    -------
    list of float, one a point; a dict of them by name where ``solve_for`` is a sequence

    Raises
    ------
    NotPlain
        In words: it holds something else, has no real value at a point, or cannot be solved.

    Examples
    --------
    >>> z, m, K = sp.Function("z")(sp.Symbol("t")), *sp.symbols("m K")
    >>> values(K * z, {"K": [100.0, 200.0], "z": [0.01, 0.02], "m": [1.0, 2.0]})
    [1.0, 4.0]
    >>> motion = sp.Eq(m * z.diff("t", 2), -K * z)
    >>> values(motion, {"K": [100.0, 200.0], "z": [0.01, 0.02], "m": [1.0, 2.0]}, solve_for="z''")
    [-1.0, -2.0]
    """
    points = [dict(zip(at, point, strict=True)) for point in zip(*at.values(), strict=True)]
    if not solve_for:
        expression = _expression(answer)
        held = _held(expression, at)
        return [_worth(expression, held, point) for point in points]
    names = [solve_for] if isinstance(solve_for, str) else list(solve_for)
    equations = list(answer) if isinstance(answer, list | tuple) else [answer]
    if len(equations) != len(names):
        raise NotPlain(f"it is {len(equations)} equations; needs {len(names)}, which are solved for {', '.join(names)}")
    residuals = [_cleared(_residual(equation), names) for equation in equations]
    held = [_held(residual, [*at, *names]) for residual in residuals]
    missing = [name for name in names if not any(name in one.values() for one in held)]
    if missing:
        raise NotPlain(
            f"it does not contain {missing[0]}; needs an equation of motion, such as sp.Eq(..., ...) with {missing[0]}"
        )
    solved = np.transpose([_solution(list(zip(residuals, held, strict=True)), point, names) for point in points]).tolist()
    return solved[0] if isinstance(solve_for, str) else dict(zip(names, solved, strict=True))


def unit_remark(answer, unit=""):
    """The fault in the units of an expression or an equation whose symbols all carry one, or an empty text.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, b = hl.parameters("k b", units="N/m N*s/m")
    >>> unit_remark(k * hl.x(hl.n) ** 2, "N")
    'By the units of its symbols it is in N*m, needs N.'
    >>> unit_remark(b * hl.x(hl.n) + k * hl.x(hl.n))[:65]
    'By the units of its symbols: b*x(n) is in N*s but k*x(n) is in N.'
    """
    terms = answer.args if isinstance(answer, sp.Eq) else [answer]
    if not all(isinstance(one, sp.Expr) and all(map(_has_unit, symbols(one))) and not _holds_a_constant(one) for one in terms):
        return ""
    try:
        found = agree(terms, "By the units of its symbols")
    except UnitsError as problem:
        return str(problem)
    if not unit or isinstance(answer, sp.Eq) or found in (None, dimension(unit)):
        return ""
    return f"By the units of its symbols it is in {si_name(found)}, needs {unit}."


def _holds_a_constant(term):
    """Whether a term holds a number such as 9.81, which may have a unit; a half or a 2 has none."""
    return not all(one.is_finite and abs(one) <= 4 and abs(12 * one - round(12 * one)) < 1e-9 for one in term.atoms(sp.Number))


def _has_unit(node):
    node = node.expr if isinstance(node, sp.Derivative) else node
    return hasattr(node, "unit") or hasattr(type(node), "unit")


def _expression(answer):
    """Return an answer as an expression, samples of the past as such."""
    if isinstance(answer, sp.Eq):
        raise NotPlain("it is an equation; needs an expression only, the right side of the equation")
    if isinstance(answer, int | float) and not isinstance(answer, bool):
        return sp.Float(answer)
    if not isinstance(answer, sp.Expr):
        quotes = ", without quotes" if isinstance(answer, str) else ""
        raise NotPlain(f"it is {a(answer)}, needs an expression of symbols{quotes}")
    worked_out = answer.replace(sp.Derivative, lambda inner, *by: sp.diff(inner, *by))  # m z' over t, unevaluated
    return worked_out.replace(delay, lambda delayed: delayed.subs(n, n - 1))


def _residual(equation):
    """Return an equation as an expression that is zero."""
    if isinstance(equation, sp.Eq):
        return _expression(equation.lhs) - _expression(equation.rhs)
    if equation in (True, False):
        raise NotPlain(
            f"it is an equation that is always {bool(equation)}, because both sides are the same or contain only numbers"
        )
    if not isinstance(equation, sp.Expr):
        raise NotPlain(f"it is {a(equation)}, needs an equation, sp.Eq(..., ...)")
    return _expression(equation)


def _cleared(residual, names):
    """Return an equation multiplied by what it is divided by, where what it is solved for stands there: m = F/z''."""
    below = [power.base for power in residual.atoms(sp.Pow) if power.exp.could_extract_minus_sign()]
    if any(spelling(node) in names for base in below for node in symbols(base)):
        return sp.fraction(sp.together(residual))[0]
    return residual


def symbols(expression):
    """Yield the symbols, samples, coordinates and rates in an expression."""
    walk = sp.preorder_traversal(expression)
    for node in walk:
        if spelling(node):
            walk.skip()
            yield node


def spelling(node):
    """The text of a symbol, a sample, a function of time or its rate; empty for anything else."""
    if isinstance(node, sp.Derivative) and len(node.variable_count) == 1:
        name, (_, order) = spelling(node.expr), node.variable_count[0]
        return name and name + "'" * int(order)
    if isinstance(node, AppliedUndef) or getattr(type(node), "role", "") == "handle":
        clock = ",".join(str(argument).replace(" ", "") for argument in node.args)
        name = type(node).__name__
        return name if clock == "t" and isinstance(node, AppliedUndef) else f"{name}({clock})"
    return node.name if isinstance(node, sp.Symbol) else ""


def _held(expression, allowed):
    """Symbols of an expression by the names of ``allowed``; refuse one that is not among them."""
    bound = {symbol for one in expression.atoms(sp.Integral, sp.Sum) for symbol in one.bound_symbols}
    texts = {node: spelling(node) for node in symbols(expression) if node not in bound}
    strange = sorted({text for text in texts.values() if text not in allowed})
    if strange:
        raise NotPlain(f"it contains {', '.join(strange)[:200]}; it may contain {', '.join(allowed)}")
    return texts


def _worth(expression, held, point):
    """Return the value of an expression at a point."""
    numbers = expression.xreplace({node: sp.Float(point[text]) for node, text in held.items()})
    found = sp.N(numbers.replace(sp.Piecewise, _branch))
    where = ", ".join(f"{name} = {value:g}" for name, value in point.items())
    try:
        value = complex(found)
    except (TypeError, OverflowError):
        raise NotPlain(f"it is not a number at {where}: {str(found)[:60]}") from None
    if not np.isfinite(value):
        raise NotPlain(f"it has no finite value at {where}: is something divided by zero there?")
    if abs(value.imag) > STRAIGHT * abs(value):
        raise NotPlain(f"it is a complex number at {where}: the root or the logarithm of a negative number?")
    return value.real


def _branch(*cases):
    """Return the first case whose condition holds; the package's own cases are kept as written, and decide nothing."""
    return next((case.args[0] for case in cases if case.args[1] == True), sp.nan)  # noqa: E712 - SymPy's own true


def _solution(equations, point, names):
    """The solution of equations at a point: a straight line is known by its value at 0 and its slope."""

    def residuals(trial):
        tried = {**point, **dict(zip(names, map(float, trial), strict=True))}
        return np.array([_worth(expression, held, tried) for expression, held in equations])

    offset = residuals(np.zeros(len(names)))
    slopes = np.column_stack([residuals(one) - offset for one in np.eye(len(names))])
    probe = 2.0 + np.arange(len(names))
    if (np.abs(residuals(probe) - offset - slopes @ probe) > STRAIGHT * (np.abs(offset) + np.abs(slopes) @ probe)).any():
        raise NotPlain(f"it is not linear in {', '.join(names)}, so it gives no single value")
    try:
        return np.linalg.solve(slopes, -offset)
    except np.linalg.LinAlgError:
        raise NotPlain(f"it cannot be solved for {', '.join(names)}, which cancels") from None
