"""A text such as "10 mm" becomes a number in SI, and a unit exponents of the SI base; pint reads what is rare."""

import re
from fractions import Fraction
from functools import lru_cache

from ..errors import ParameterError, UnitsError
from .metric import metric

#: names for dimensions that have one, so that an error reads N and not kg*m/s^2
_NAMES = ("1", "m", "s", "kg", "N", "N/m", "N*s/m", "m/s", "m/s^2", "N*m", "N*s", "N/s", "1/s", "kg*m^2", "W", "A", "V", "1/m")
#: passive elements: a negative one is not passive, so it must be asked for by a declared range
_PASSIVE = {"N/m": "stiffness", "N*s/m": "damping", "s": "time", "N*m/rad": "stiffness", "N*m*s/rad": "damping"}
_INERTIA = {"kg": "mass", "kg*m^2": "moment of inertia"}
#: a number, then its unit; pint alone would read '10 N/m; 5' as 50 N/m and 'N/m' as 1 N/m
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)")
#: units of an angle, which has no dimension
_ANGLES = ("deg", "degree", "degrees", "°")
_UNIT = re.compile(r"[\w\s*/^().+°·%-]*")


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
    cure = _spelling(unit)
    try:
        size, exponents = _read(unit)
    except ValueError as problem:
        why = "" if cure or "TypeError" in str(problem) else f" ({problem})"  # which is about pint's own insides
        raise UnitsError(f"unit {unit!r} is not known{why}; {cure or 'write it like N*s/m, m/s^2, kg or 1'}") from None
    if size != 1.0 and cure and unit.startswith("N"):
        raise UnitsError(f"unit {unit!r} is not known; {cure}")  # Nm^-1, which pint reads as one over nanometres
    if size != 1.0:
        si = "rad" if unit in _ANGLES else si_name(exponents)
        raise UnitsError(f"unit {unit!r} is not SI; declare {si} and bind a value with its unit, as in '10 {unit}'")
    return exponents


def _spelling(unit):
    """How a unit is to be written that runs together or has a negative power, such as Ns/m or Nm-1; else nothing."""
    powers = re.fullmatch(r"([A-Za-z*]*?)[* ]?(m|s|kg|N|rad)\^?-([12])", unit)
    if powers:
        return f"write it {powers[1] or '1'}/{powers[2]}" + ("" if powers[3] == "1" else f"^{powers[3]}")
    joined = re.sub(r"\b(N|kg)(m|s)\b", r"\1*\2", unit)
    return f"write it {joined}" if joined != unit and metric(joined) else ""


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
    shown = "a number above 1e308" if isinstance(value, int) and abs(value) > 1e308 else repr(value)
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
