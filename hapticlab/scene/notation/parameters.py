"""Parameters: named quantities with a unit and a range."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import sympy as sp

from ...base.units import dimension, in_si, kind_of
from ...errors import ParameterError
from .written import check_name

if TYPE_CHECKING:
    pass


class Parameter(sp.Symbol):
    """A named quantity with a unit and a range, bound to a value by calling the scene. Made by :func:`parameters`."""

    def __new__(cls, name, unit, low=-math.inf, high=math.inf, value=math.nan):
        self = sp.Symbol.__xnew__(cls, name, real=True)
        self.unit, self.low, self.high, self.value = unit, low, high, value
        return self

    def __getnewargs_ex__(self):
        return (self.name, self.unit, self.low, self.high, self.value), {}

    def _hashable_content(self):
        return (*super()._hashable_content(), self.unit, self.low, self.high, str(self.value))

    def check(self, value):
        """The value as a float in SI, within the parameter's range."""
        number = in_si(value, self.unit, self.name)
        needs = self.needs()
        if not math.isfinite(number):
            raise ParameterError(f"{self.name} = {number}; needs a finite number in {self.unit}")
        if needs["positive"] and number <= 0:
            raise ParameterError(f"{self.name} = {number:g} {self.unit}; {needs['positive']}")
        if not self.low <= number <= self.high:
            raise ParameterError(f"{self.name} = {number:g} {self.unit}; {needs['range']}")
        return number

    def needs(self):
        """What a value must be, in words: ``positive``, empty where it may be zero or less, and ``range``."""
        kind, word = kind_of(self.unit)
        return {"positive": f"a {word} needs {self.name} > 0" if kind == "inertia" else "", "range": self._range(word)}

    def _range(self, word):
        if self.low == 0 and math.isinf(self.high):
            if not word:
                return f"needs {self.name} >= 0"
            return (
                f"a {word} needs {self.name} >= 0. A negative one is not passive; if you want one, declare it: "
                f"hl.parameters('{self.name}', units='{self.unit}', ranges=(-limit, limit))"
            )
        return f"it was declared to lie between {self.low:g} and {self.high:g}"


#: sampling period [s], bound when a scene is compiled
T = Parameter("T", "s", 0.0)


def parameters(names: str, *, units: str, values: Any = None, ranges: Any = None) -> Any:
    """Declare the parameters of a scene, each with its unit.

    Parameters
    ----------
    names : str
        Names separated by spaces; none may be a word of Python, or what a scene or a record calls its own (x, T,
        delay).
    units : str
        One SI unit for each, separated by spaces; ``1`` for a pure number.
    values : number, sequence or dict, optional
        Default values in SI, or texts with a unit such as ``"10 mm"``; one for each name.
    ranges : (low, high), sequence of them, or dict, optional
        Closed ranges in SI, one for each name. Without a range a mass must be > 0, and a stiffness, damping or time >=
        0.

    Returns
    -------
    Parameter, or tuple of Parameter

    Raises
    ------
    UnitsError, ParameterError

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, x_o = hl.parameters("k x_o", units="N/m m")
    >>> g = hl.parameters("g", units="m/s^2", values=9.81)
    >>> k.unit, g.value
    ('N/m', 9.81)
    """
    names = _words("names", names)
    units = _words("units", units, whole=len(names) == 1)
    if len(names) != len(units) or not names:
        raise ParameterError(
            f"{len(names)} names ({' '.join(names)}) but {len(units)} units ({' '.join(units)}); "
            "give one unit for each name, separated by spaces, and a product with *, such as units='N/m N*s/m'"
        )
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice:
        raise ParameterError(f"{twice} is declared twice in '{' '.join(names)}'; give every parameter its own name")
    if len(names) == 1:
        values = values if isinstance(values, dict) else {names[0]: values}
        ranges = ranges if isinstance(ranges, dict) else {names[0]: ranges}
    made = tuple(
        _parameter(name, unit, _entry("values", values, names, k), _entry("ranges", ranges, names, k))
        for k, (name, unit) in enumerate(zip(names, units, strict=True))
    )
    return made if len(made) > 1 else made[0]


def _words(what, given, whole=False):
    if not isinstance(given, str):
        example = "hl.parameters('k m', units='N/m kg')"
        raise ParameterError(f"{what} = {given!r}; needs one text, with spaces between names, as in {example}")
    return [given.strip()] if whole and given.strip() else given.replace(",", " ").split()


def _entry(what, given, names, k):
    if given is None:
        return None
    if isinstance(given, dict):
        strangers = {str(name) for name in given} - set(names)
        if strangers:
            raise ParameterError(f"{', '.join(sorted(strangers))} is not among the names {' '.join(names)}")
        return given.get(names[k])
    if isinstance(given, str) or not hasattr(given, "__len__"):
        raise ParameterError(f"{what} = {given!r} for {len(names)} names ({' '.join(names)}); give one for each, in a tuple")
    if len(given) != len(names):
        raise ParameterError(f"{len(given)} entries for {len(names)} names ({' '.join(names)}); give one for each")
    return given[k]


def _parameter(name, unit, value, limits):
    dimension(unit)  # refuses what is not SI
    check_name(name, "parameter", ParameterError)
    kind, _ = kind_of(unit)
    try:
        low, high = map(float, limits) if limits is not None else ((0.0 if kind else -math.inf), math.inf)
    except (TypeError, ValueError, OverflowError):
        raise ParameterError(f"{name}: range {limits!r}; needs (low, high) in {unit}, such as (0, 10)") from None
    if not low <= high:
        raise ParameterError(f"{name}: range ({low}, {high}) is empty; give (low, high) with low <= high")
    made = Parameter(name, unit, low, high)
    return made if value is None else Parameter(name, unit, low, high, made.check(value))
