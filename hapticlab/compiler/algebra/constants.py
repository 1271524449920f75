"""The numbers a scene brings into a program: refused where its real type has no such number.

A float32 ends at 3.4e38 and loses digits below 1.2e-38. A constant past either end would turn into an infinity or a zero
without a word, and a force into nothing.
"""

import math

import numpy as np
import sympy as sp

from ...errors import ProgramError
from ..ir.program import NUMPY_TYPE

DTYPE = {"f32": "float32", "f64": "float64"}


def entering(value, type, shown, error=ProgramError):
    """Return a float, or raise ``error`` where it has no equal in a real type but for its last digits.

    Parameters
    ----------
    value : float or sympy number
    type : {"f32", "f64"}
    shown : str
        What the message calls it.

    Examples
    --------
    >>> from hapticlab.compiler.algebra.constants import entering
    >>> entering(3.9e-57, "f32", "e*s**6 = 3.9e-57")
    Traceback (most recent call last):
    hapticlab.errors.ProgramError: e*s**6 = 3.9e-57 is 0 in float32; use units of a larger scale or dtype='float64'
    """
    try:
        number = float(value)
    except OverflowError:
        number = math.inf if value > 0 else -math.inf
    if not math.isfinite(number) and getattr(value, "is_finite", False) is not True:
        raise error(f"{shown} is not a finite number; only finite numbers run at the sample rate")
    with np.errstate(all="ignore"):
        became = NUMPY_TYPE[type](number).item()
    nothing = value == 0 or (number == 0 and getattr(value, "is_zero", False) is not False)
    if nothing or is_ordinary(became, type):
        return number
    cure = "" if type == "f64" else " or dtype='float64'"
    scale = "smaller" if math.isinf(became) else "larger"
    what = f"{became:g}" if became == 0 or math.isinf(became) else "without its digits"
    raise error(f"{shown} is {what} in {DTYPE[type]}; use units of a {scale} scale{cure}")


def is_ordinary(value, type):
    """True of a number of a real type that is neither zero nor denormal, infinite or nan."""
    return float(np.finfo(NUMPY_TYPE[type]).tiny) <= abs(value) < math.inf


def check_product(expr, value, known, bound, settled=None):
    """Refuse what parameters alone make, and the program's arithmetic turns into zero or infinity where it is neither.

    Parameters
    ----------
    expr : sympy expression
    value : Value
        What it was translated to.
    known : dict sympy expression -> Value
        Values of the symbols in it.
    bound : dict name -> float
        The values of live parameters.
    settled : dict sympy expression -> bool, optional
        Remembers, from one call to the next, which expressions parameters alone make.
    """
    if (
        value.type not in DTYPE
        or not expr.args
        or (value.constant is not None and is_ordinary(value.constant, value.type))
        or not _settled(expr, known, bound, {} if settled is None else settled)
    ):
        return  # samples, states, time, and what has no value yet
    numbers = {s: _number_of(s, known, bound) for s in expr.free_symbols}
    exact = expr.xreplace({s: sp.Float(number) for s, number in numbers.items()}).evalf()
    if exact.is_Float and exact.is_finite:
        entering(exact, value.type, f"{expr} = {str(sp.Float(exact, 3)).lower()}")


def _number_of(symbol, known, bound):
    """Return the number that a symbol is, or None."""
    constant = known[symbol].constant if symbol in known else None
    return bound.get(symbol.name) if constant is None else constant


def _settled(expr, known, bound, remembered):
    """True of an expression whose symbols are all numbers."""
    if expr not in remembered:
        one = _number_of(expr, known, bound) is not None if expr.is_Symbol else None
        remembered[expr] = all(_settled(a, known, bound, remembered) for a in expr.args) if one is None else one
    return remembered[expr]
