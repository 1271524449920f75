"""Units of what a student writes: read here or by pint, carried as exponents of the SI base, checked term by term."""

import re
from collections import Counter
from fractions import Fraction
from functools import lru_cache

import sympy as sp
from sympy.logic.boolalg import BooleanAtom, BooleanFunction

from ...errors import ParameterError, UnitsError
from .metric import metric

#: names for dimensions that have one, so that an error reads N and not kg*m/s^2
_NAMES = ("1", "m", "s", "kg", "N", "N/m", "N*s/m", "m/s", "m/s^2", "N*m", "N*s", "1/s", "kg*m^2", "W", "A", "V", "1/m")
#: passive elements: a negative one feeds energy to the user, so it must be asked for by a declared range
_PASSIVE = {"N/m": "stiffness", "N*s/m": "damping", "s": "time", "N*m/rad": "stiffness", "N*m*s/rad": "damping"}
_INERTIA = {"kg": "mass", "kg*m^2": "moment of inertia"}
#: a number, then its unit; pint alone would read '10 N/m; 5' as 50 N/m and 'N/m' as 1 N/m
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)")
_UNIT = re.compile(r"[\w\s*/^().+°·%-]*")
#: the two symbols every scene shares: time and the number of the sample
_CLOCK = {"t": "s", "n": "1"}


@lru_cache(maxsize=1)
def _registry():
    import pint

    return pint.UnitRegistry()


def _parsed(number, unit):
    """A pint quantity; a ValueError has pint's reason."""
    if not _UNIT.fullmatch(unit):
        raise ValueError("a unit is made of names, numbers and * / ^ ( )")
    try:
        return _registry().Quantity(number, unit)
    except Exception as problem:  # pint lets Python's own parser and arithmetic fail on what is no unit
        raise ValueError(f"{type(problem).__name__}: {problem}") from None


def dimension(unit):
    """SI exponents of a unit as a sorted tuple, ("[length]", 1), ...; refuse units that are not SI.

    Raises
    ------
    UnitsError
        The unit is unknown, or is a multiple of its SI unit (mm, deg): a plain number in it would be a silent error.
    """
    if not isinstance(unit, str):
        raise UnitsError(f"unit {unit!r} is not a text; write it like 'N*s/m', 'm/s^2', 'kg' or '1'")
    return _dimension(unit)


@lru_cache(maxsize=1024)
def _dimension(unit):
    try:
        size, exponents = _read(unit)
    except ValueError as problem:
        raise UnitsError(f"unit {unit!r} is not known ({problem}); write it like N*s/m, m/s^2, kg or 1") from None
    if size != 1.0:
        si = si_name(exponents)
        raise UnitsError(f"unit {unit!r} is not SI; declare {si} and bind a value with its unit, as in '10 {unit}'")
    return exponents


def _read(unit):
    """(Value in SI, SI exponents) of one of a unit; metric units without pint, the others by pint."""
    known = metric(unit)
    if known is not None:
        return known
    one = _parsed(1.0, unit)
    return one.to_base_units().magnitude, _exponents(one)


def _exponents(quantity):
    return tuple(sorted((k, Fraction(p).limit_denominator(64)) for k, p in quantity.dimensionality.items()))


def si_name(dimensions):
    """A readable unit for SI exponents."""
    for name in _NAMES:
        if dimension(name) == dimensions:
            return name
    base = {"[length]": "m", "[mass]": "kg", "[time]": "s", "[current]": "A", "[temperature]": "K"}
    return "*".join(base.get(k, k.strip("[]")) + (_exponent(p) if p != 1 else "") for k, p in dimensions)


def _exponent(p):
    return f"^{p}" if p.denominator == 1 else f"^({p})"


def in_si(value, unit, name):
    """A bound value as a float in its declared unit; a text such as '10 mm' is converted."""
    if isinstance(value, str):
        return _converted(value, unit, name)
    try:
        if not isinstance(value, bool):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass  # refused below, in words
    shown = "a number past 1e308" if isinstance(value, int) and abs(value) > 1e308 else repr(value)
    raise ParameterError(f"{name} = {shown}; needs a number in {unit} or a text such as '10 {unit}'")


def _converted(text, unit, name):
    written = _QUANTITY.fullmatch(text)
    cure = f"{name} = {text!r}; needs a quantity in {unit}, like '2 {unit}'"
    if not written:
        raise UnitsError(f"{cure} (it does not begin with a number)")
    number, own = written.groups()
    given, wanted = metric(own or "1"), metric(unit)
    if given and wanted and given[1] == wanted[1]:
        return float(number) * (given[0] / wanted[0])
    try:
        quantity = _parsed(float(number), own or "dimensionless")
        return float(quantity.to(unit if unit != "1" else "dimensionless").magnitude)
    except (AttributeError, TypeError, ValueError, OverflowError) as problem:
        raise UnitsError(f"{cure} ({problem})") from None


def quantity(text, name):
    """(Number, SI unit) of a text such as '5 N/mm'."""
    written = _QUANTITY.fullmatch(text)
    number, own = written.groups() if written else ("", "")
    if not own:
        raise UnitsError(f"{name} = {text!r}; needs a number and its unit, such as '2 N/m'")
    try:
        size, exponents = _read(own)
        if size == 1.0:
            return float(number), own
        # by pint itself, as degC begins elsewhere than K: twice the number need not be twice the quantity
        value = float(number) * size if metric(own) else float(_parsed(float(number), own).to_base_units().magnitude)
    except (AttributeError, TypeError, ValueError, OverflowError) as problem:
        raise UnitsError(f"{name} = {text!r}; needs a quantity ({problem})") from None
    return value, si_name(exponents)


def kind_of(unit):
    """("inertia" | "passive" | None, its name) of a parameter's unit."""
    for names, kind in ((_INERTIA, "inertia"), (_PASSIVE, "passive")):
        for name, word in names.items():
            if dimension(unit) == dimension(name) and unit != "rad":
                # N*m and N*m/rad share a dimension; only a unit that names the radian is a rotational stiffness
                if "rad" in name and "rad" not in unit:
                    continue
                return kind, word
    return None, None


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
                else " Correct one of them, or the declared unit of a parameter in it."
            )
            one, other = (f"{float(e):g}" if e.is_number else e for e in (first, term))
            raise UnitsError(f"{where}: {one} is in {si_name(known[0][1])} but {other} is in {si_name(d)}.{cure}")
    return known[0][1] if known else None


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
                f"{where}: {type(expr).__name__} takes a pure number, but {a} is in {si_name(d)}; "
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
    ((sp.Abs, sp.Min, sp.Max), _same),
    ((sp.sign, sp.Heaviside), lambda expr, where: (agree(expr.args[:1], where), ())[1]),
)
