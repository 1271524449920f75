"""A number with a unit, where a parameter would be too much: the radius of a ball, a corner of a polygon."""

from __future__ import annotations

import math

import sympy as sp

from ...base.arguments import number
from ...base.units import in_si
from ...errors import SceneError
from .checks import agree_with
from .parameters import Parameter
from .written import expression


class Amount(sp.Expr):
    """A fixed quantity in SI, such as 0.05 m; it compiles to its number.

    Parameters
    ----------
    value : float
        In SI.
    unit : str
        Its SI unit, such as "m" or "N*s/m".

    Examples
    --------
    >>> from hapticlab.scene.notation.amount import Amount
    >>> 2 * Amount(0.05, "m")
    2*(0.05 m)
    """

    is_commutative = True
    is_real = True
    is_number = False

    def __new__(cls, value: float, unit: str) -> Amount:
        return super().__new__(cls, sp.Float(float(value)), sp.core.symbol.Str(str(unit)))

    @property
    def value(self) -> sp.Expr:
        """The number [``unit``]."""
        return self.args[0]

    @property
    def unit(self) -> str:
        """SI unit."""
        return self.args[1].name

    def _eval_derivative(self, symbol):
        return sp.S.Zero

    def _eval_evalf(self, prec):
        return self.value

    def _eval_is_zero(self):
        return bool(self.value == 0)

    def _eval_is_positive(self):
        return bool(self.value > 0)

    def _eval_is_negative(self):
        return bool(self.value < 0)

    def _sympystr(self, printer):
        return f"({float(self.value):g} {self.unit})"

    def _latex(self, printer):
        return rf"{float(self.value):g}\,\mathrm{{{self.unit}}}"


def amount(given, unit, where, owner="", **limits):
    """An expression in a unit, from a number, a text such as '5 mm' or an expression; refuse any other unit.

    A value that is known is held to the ``limits`` of :func:`hapticlab.base.arguments.number`.
    """
    expr = _in_unit(given, unit, where)
    known = number_of(expr)
    if limits and known.is_number:
        value = float(known)
        number(where, int(value) if value.is_integer() else value, unit, owner, error=SceneError, **limits)
    return expr


def _in_unit(given, unit, where):
    if isinstance(given, str) or (isinstance(given, (int, float)) and not isinstance(given, bool)):
        value = number(where, in_si(given, unit, where), unit, what="number", error=SceneError)
        return sp.S.Zero if value == 0 else Amount(value, unit) if unit not in ("1", "rad") else turned(value)
    expr = expression(given, where)
    if expr.is_number and not expr.is_real:
        raise SceneError(f"{where} = {expr}; needs a finite real number in {unit}")
    if expr.is_number and unit not in ("1", "rad"):
        return _in_unit(float(expr), unit, where)
    agree_with(expr, unit, where)
    return expr


def turned(angle):
    """An angle [rad]; one within a rounding of a quarter turn as that quarter turn, whose sine is 0 or 1.

    Examples
    --------
    >>> import math
    >>> turned(math.pi / 2), turned(0.25)
    (pi/2, 0.250000000000000)
    """
    quarters = round(2 * angle / math.pi)
    near = abs(angle - quarters * math.pi / 2) <= 4e-16 * max(1.0, abs(angle))
    return quarters * sp.pi / 2 if near else sp.Float(angle)


def number_of(expr):
    """An expression with its amounts as plain numbers."""
    return expr.xreplace({a: a.value for a in expr.atoms(Amount)})


def take_lengths(shape, *positive, zero=None):
    """Take a shape's lengths as expressions in m; refuse what cannot be a length."""
    for field in (*positive, *([zero] if zero else [])):
        where = f"{field} of a {type(shape).__name__}"
        length = amount(getattr(shape, field), "m", where)
        known = number_of(length)
        if known.is_number and (known < 0 or (known == 0 and field != zero)):
            raise SceneError(f"{where} = {float(known):g} m; a length needs {'>= 0' if field == zero else '> 0'}")
        if isinstance(length, Parameter) and not length.low >= 0:
            raise SceneError(
                f"{where} = {length.name}, which may be negative; declare hl.parameters('{length.name}', units='m', "
                "ranges=(low, high)) with low > 0"
            )
        object.__setattr__(shape, field, length)
