"""Units of what a student writes, carried as exponents of the SI base through an expression, and checked term by term."""

from collections import Counter
from fractions import Fraction

import sympy as sp
from sympy.logic.boolalg import BooleanAtom, BooleanFunction

from ...base.units import dimension, si_name
from ...errors import UnitsError

#: the two symbols every scene shares: time and the number of the sample
_CLOCK = {"t": "s", "n": "1"}


def _times(*factors):
    total = Counter()
    for factor in factors:
        for k, p in factor:
            total[k] += p
    return tuple(sorted((k, p) for k, p in total.items() if p))


def _power(dimensions, exponent):
    return tuple((k, p * exponent) for k, p in dimensions)


def fixed(exponent):
    """A float exponent as the fraction it stands for, 2.0 as 2 and 1.5 as 3/2; any other as it is.

    Examples
    --------
    >>> import sympy as sp
    >>> from hapticlab.scene.notation.units import fixed
    >>> fixed(sp.Float(1.5))
    3/2
    """
    if exponent.is_Float:
        near = Fraction(float(exponent)).limit_denominator(12)
        if abs(float(exponent) - near) <= 1e-12:
            return sp.Rational(near.numerator, near.denominator)
    return exponent


def dimension_of(expr, where):
    """SI exponents of an expression; None for zero, which fits every unit.

    Parameters
    ----------
    expr : sympy expression
    where : str
        What the expression is, for the message.

    Raises
    ------
    UnitsError
        Two terms differ, or a function takes a quantity with a unit; the message names both terms.
    """
    if expr.is_number:
        return None if expr.is_zero else ()
    if isinstance(expr, sp.Symbol) and expr.name in _CLOCK:
        return dimension(_CLOCK[expr.name])
    unit = getattr(expr, "unit", None) or getattr(type(expr), "unit", None)
    if unit is not None:
        return dimension(unit)
    if isinstance(expr, sp.Derivative):
        order = sum(count for _, count in expr.variable_count)
        return _times(dimension_of(expr.expr, where), _power(dimension("s"), Fraction(-order)))
    if hasattr(expr, "per"):
        whole, part = dimension_of(expr.args[0], where), dimension_of(expr.per, where)
        return None if whole is None else _times(whole, _power(part or (), Fraction(-1)))
    if isinstance(expr, (BooleanFunction, BooleanAtom)):
        for a in expr.args:
            dimension_of(a, where)
        return ()
    rule = next((rule for kinds, rule in _RULES if isinstance(expr, kinds)), None)
    if rule is not None:
        return rule(expr, where)
    if getattr(type(expr), "keeps_unit", False):
        return dimension_of(expr.args[0], where)
    if expr.is_Function:
        return _pure(expr, where)
    raise UnitsError(f"{where}: {expr} has no unit; declare it: {expr} = hl.parameters('{expr}', units='...')")


def unit_of(expr):
    """SI unit of an expression whose units have been checked."""
    return si_name(dimension_of(expr, str(expr)) or ())


def agree(terms, where):
    """The one dimension of several terms; the error names two that differ."""
    known = [(term, d) for term in terms if (d := dimension_of(term, where)) is not None]
    for term, d in known[1:]:
        if d != known[0][1]:
            first = known[0][0]
            number = next((f"{abs(float(e)):g}" for e in (first, term) if e.is_number), None)
            cure = (
                f" {number} is a bare number: give it a unit with hl.parameters('name', units=..., values={number})."
                if number
                else _of_a_factor(first, known[0][1], d)
                or _of_a_factor(term, d, known[0][1])
                or " Correct one of them, or the declared unit of a parameter in it."
            )
            one, other = (f"{float(e):g}" if e.is_number else e for e in (first, term))
            raise UnitsError(f"{where}: {one} is in {si_name(known[0][1])} but {other} is in {si_name(d)}.{cure}")
    return known[0][1] if known else None


def _of_a_factor(term, has, wanted):
    """The cure where a number such as the 300 of 300*x(n) would need a unit; empty for a term without one."""
    factor = abs(term.as_coeff_Mul()[0])
    if factor in (1, 2) or not (factor.is_Float or factor.is_Integer):
        return ""
    unit = si_name(_times(wanted, _power(has, Fraction(-1))))
    return f" If {float(factor):g} is in {unit}, declare it: hl.parameters('name', units='{unit}', values={float(factor):g})."


def _of_product(expr, where):
    parts = [dimension_of(a, where) for a in expr.args]
    return None if None in parts else _times(*parts)


def _of_power(expr, where):
    base, exponent = expr.as_base_exp() if not isinstance(expr, sp.exp) else (sp.S.One, expr.args[0])
    d, exponent = dimension_of(base, where), fixed(exponent)
    if exponent.is_Rational:
        return None if d is None else _power(d, Fraction(int(exponent.p), int(exponent.q)))
    if d or dimension_of(exponent, where):
        raise UnitsError(f"{where}: {expr} raises a quantity with a unit to a power that is not a fixed fraction")
    return ()


def _of_pieces(expr, where):
    for _, condition in expr.args:
        dimension_of(condition, where)
    return agree([branch for branch, _ in expr.args], where)


def _pure(expr, where):
    for a in expr.args:
        d = dimension_of(a, where)
        if d:
            raise UnitsError(
                f"{where}: {type(expr).__name__} needs a number without unit, but {a} is in {si_name(d)}; "
                "divide it by a quantity of the same unit first"
            )
    return ()


def _same(expr, where):
    return agree(expr.args, where)


def _compared(expr, where):
    agree(expr.args, where)
    return ()


_RULES = (
    (sp.Add, _same),
    (sp.Mul, _of_product),
    ((sp.Pow, sp.exp), _of_power),
    (sp.Piecewise, _of_pieces),
    ((sp.core.relational.Relational, sp.atan2), _compared),
    ((sp.Abs, sp.Min, sp.Max, sp.Mod), _same),
    ((sp.sign, sp.Heaviside), lambda expr, where: (agree(expr.args[:1], where), ())[1]),
)
