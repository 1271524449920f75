"""The words a scene is written in: x(n), x(t), v(t), parameters, coordinates, signals, when and delay."""

from __future__ import annotations

import copyreg
import math
from typing import TYPE_CHECKING, Any

import sympy as sp
from sympy.core.function import AppliedUndef, FunctionClass, UndefinedFunction

from ...base.units import dimension, in_si
from ...errors import SceneError, SignalError
from .cases import when
from .parameters import Parameter, T, parameters
from .written import CONDITIONS, check_name, expression

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...base.annotations import Term
    from ..laws.estimators import VelocityEstimate


__all__ = ["Parameter", "T", "coordinate", "delay", "lag_of", "n", "parameters", "signal", "t", "v", "when", "x"]

#: time [s]; a plain SymPy symbol, so that expressions of sympy.physics.mechanics speak of the same time
t = sp.Symbol("t")
#: number of the present sample
n = sp.Symbol("n", integer=True)


def coordinate(
    name: str, *, unit: str, initial: Term = 0, rate: Term = 0, range: Sequence[float] = (-math.inf, math.inf)
) -> sp.Expr:
    """Declare a generalized coordinate q(t) of the virtual environment.

    Parameters
    ----------
    name : str
        One word that is not the name of a parameter, a signal, another coordinate or a column of a record.
    unit : str
        SI unit, such as ``m`` or ``rad``.
    initial, rate : number, text with a unit, or expression
        Value and rate at the first sample, a number in ``unit`` and ``unit``/s; may use parameters and x(n), so that a
        body can start at the handle.
        A coordinate with an equation of first order starts with its value alone.
    range : (low, high)
        Range of the coordinate, in SI. When a scene is compiled, contact pairs, cases and ranks are decided over this
        range, so a coordinate that leaves it during a run is a fault, which switches the motor off. A start outside the
        range is rejected. A coordinate on which no output depends is left out of the program and not checked.

    Returns
    -------
    sympy expression ``q(t)``; its rate is ``q.diff(t)``.

    Examples
    --------
    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m", initial=hl.x(hl.n))
    >>> z.diff(hl.t, 2)
    Derivative(z(t), (t, 2))
    """
    check_name(name, "coordinate")
    dimension(unit)
    start = {
        "initial": _start(initial, unit, f"initial of {name}"),
        "rate": _start(rate, "1/s" if unit == "1" else f"{unit}/s", f"rate of {name}"),
    }
    if isinstance(range, tuple | list):
        range = tuple(in_si(end, unit, name) if isinstance(end, str) else end for end in range)
    if not _is_range(range):
        raise SceneError(f"{name}: range = {range!r}; needs (low, high) in {unit} with low < high, such as (-0.05, 0.05)")
    start |= {"low": float(range[0]), "high": float(range[1])}
    return sp.Function(name, real=True, unit=unit, role="coordinate", **start)(t)


def _start(given, unit, where):
    return sp.Float(in_si(given, unit, where)) if isinstance(given, str) else expression(given, where)


def _is_range(given):
    try:
        low, high = map(float, given)
    except (TypeError, ValueError, OverflowError):
        return False
    return low < high


class _Unapplied(FunctionClass):
    """A function of time, which is no number until it is applied; arithmetic on it is refused in words."""

    def _refuse(cls, *_):
        name = cls.__name__
        or_at = f", or {name}(t) in an equation of motion" if cls.role == "handle" else ""
        raise SignalError(f"{name} is a function of time; write {name}(n) for its sample{or_at}")

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = __pow__ = __neg__ = _refuse
    __lt__ = __le__ = __gt__ = __ge__ = _refuse


class _Sampled:
    """One value a sample: it changes with the clock, so SymPy must not take its rate for zero."""

    @property
    def free_symbols(self) -> set[Any]:
        """What SymPy takes the value to depend on; the time is among it."""
        symbols = super().free_symbols  # type: ignore[misc]
        return symbols | {t} if n in symbols else symbols

    def _eval_derivative(self, s):
        # not refused here but in a scene, for SymPy takes derivatives of its own while it simplifies
        return sp.Derivative(self, s, evaluate=False) if self.args[0].has(n) else super()._eval_derivative(s)


class _Signal(_Sampled, AppliedUndef):
    """A sample y(n-k) of a signal."""


class _SignalFunction(_Unapplied, UndefinedFunction):
    """A signal y; a type of its own because SymPy restores its undefined functions without their base class."""


def _restored(name, facts):
    return _SignalFunction(name, (_Signal,), **facts)


copyreg.pickle(_SignalFunction, lambda made: (_restored, (made.name, dict(made._kwargs))))


def signal(name: str, *, unit: str, initial: Term = 0, instead: Sequence[VelocityEstimate] = ()) -> Callable[[sp.Expr], sp.Expr]:
    """Declare a discrete-time signal y(n), to be defined by an equation ``Eq(y(n), ...)`` in a scene's ``eom``.

    Its right side may use y(n-1), y(n-2): filters, observers and estimators are difference equations, and so are machines
    with a state, such as a relay; docs/how_to/scenes.md, section "Machines that remember".

    Parameters
    ----------
    name : str
        One word that is not the name of a parameter, a coordinate, another signal or a column of a record.
    unit : str
    initial : number, text with a unit, or expression
        The value of every sample before the first, a number in ``unit``.
    instead : tuple of VelocityEstimate
        Cheaper estimates that can replace it if a board has too little time, the most expensive first; the error names
        the one that fits.

    Returns
    -------
    A function to apply to ``n``, ``n-1``, ...

    Examples
    --------
    >>> import hapticlab as hl
    >>> y = hl.signal("y", unit="m")
    >>> y(hl.n - 1)
    y(n - 1)
    """
    check_name(name, "signal")
    dimension(unit)
    facts = {"unit": unit, "role": "signal", "initial": _start(initial, unit, f"initial of {name}")}
    facts |= {"instead": tuple(instead)} if instead else {}
    return _restored(name, {"real": True, **facts})


def lag_of(applied):
    """The lag k of a sample y(n-k), or None for y(t); any other argument is a SignalError."""
    (argument,) = applied.args
    if argument == t:
        return None
    lag = n - argument
    name = type(applied).__name__
    if lag.is_Integer and lag >= 0:
        return int(lag)
    if lag.is_Integer:
        raise SignalError(
            f"{applied} lies in the future: at sample n it has not been measured. "
            f"Predict it from the past, {name}(n+1) = 2*{name}(n) - {name}(n-1), Eq. (23.4)"
        )
    clock = sorted({s.name for s in argument.free_symbols - {n, t}} & {"n", "t"})
    if clock:
        raise SignalError(
            f"{applied}: this {clock[0]} is a different symbol with this name. Write from hapticlab import {clock[0]}"
        )
    cure = f"write {name}(n), {name}(n-1), ... or {name}(t), with n and t from hapticlab"
    raise SignalError(f"{applied} is not a sample: {cure}")


class _HandleSignal(_Sampled, sp.Function, metaclass=_Unapplied):
    """A signal of the handle: one argument, checked when written."""

    nargs = 1
    is_real = True
    is_number = False
    role = "handle"

    if TYPE_CHECKING:  # SymPy's stubs say that an applied function is a class

        def __new__(cls, argument: sp.Expr) -> sp.Expr: ...

    @classmethod
    def eval(cls, argument: sp.Expr) -> None:
        # SymPy tries other arguments while it substitutes and compares; in a scene they are refused later
        if not isinstance(argument, sp.Expr):
            what = f"{cls.__name__} was given an array or another object that is not an expression"
            raise SignalError(
                f"{what}. Was n or t given another value? Write from hapticlab import n, t, and then {cls.__name__}(n)"
            )
        if any((argument - clock).is_number for clock in (n, t)):
            lag_of(sp.Basic.__new__(cls, argument))


class v(_HandleSignal):
    """Velocity of the handle v_e [m/s]: v(n) at the present sample, v(t) in an equation of motion.

    In a force or a watched expression v(t) is the sample v(n), the plain backward difference on a board, while an
    equation of motion may see it half a period further on (see
    :class:`~hapticlab.methods.Hold`). The two differ by a T/2, with a the acceleration of the
    handle, on purpose: a force that predicts through a damper b needs b more device damping (2.29 instead of 1.29 N s/m
    at b = 1 N s/m). For a coupler the difference is 0.036 % of the force of its spring at 10 mm and 3 Hz (K = 500 N/m,
    b = 1 N s/m, T = 1 ms).

    Parameters
    ----------
    argument : n, n - k or t
        The sample, ``v(n)`` or one that lies k samples before it, or the time ``t`` in an equation of motion.
    """

    unit = "m/s"


class x(_HandleSignal):
    """Position of the handle x_e [m]: x(n) at the present sample, x(n-1) before it, x(t) in an equation of motion.

    Parameters
    ----------
    argument : n, n - k or t
        The sample, ``x(n)`` or one that lies k samples before it, or the time ``t`` in an equation of motion.
    """

    unit = "m"

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return v(self.args[0])


class acceleration(_HandleSignal):
    """Acceleration of the handle [m/s^2], which no sample holds: a program estimates it, (v(n) - v(n-1))/T."""

    unit = "m/s^2"


class delay(sp.Function):
    """The value an expression had one sample ago; at the first sample, its present value.

    The delay of a number is the number. A condition has no delay: delay ``hl.when(condition, 1, 0)`` instead.

    Parameters
    ----------
    argument : expression, number or text with a unit
        What is delayed by one sample; delays may be nested.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k = hl.parameters("k", units="N/m")
    >>> hl.laws.delay(k * hl.x(hl.n))
    delay(k*x(n))
    """

    nargs = 1
    is_real = True
    keeps_unit = True

    @classmethod
    def eval(cls, argument: Any) -> sp.Expr | None:
        if isinstance(argument, CONDITIONS):
            raise SignalError(f"delay({argument}): a condition has no delay; write hl.laws.delay(hl.when({argument}, 1, 0)) > 0")
        if not isinstance(argument, sp.Expr):
            raise SignalError(f"delay({argument!r}): needs an expression, such as hl.laws.delay(k * x(n))")
        return argument if argument.is_number else None

    def _eval_derivative(self, s):
        return sp.Derivative(self, s, evaluate=False)
