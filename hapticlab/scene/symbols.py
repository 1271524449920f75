"""The words a scene is written in: x(n), x(t), v(t), parameters, coordinates, signals, when and delay."""

import math

import sympy as sp

from ..errors import ParameterError, SignalError
from .units import dimension, in_si, kind_of

#: time [s]; a plain SymPy symbol, so that expressions of sympy.physics.mechanics speak of the same time
t = sp.Symbol("t")
#: number of the present sample
n = sp.Symbol("n", integer=True)


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
        """Return the value as a float in SI, or raise ParameterError saying what is needed."""
        number = in_si(value, self.unit, self.name)
        kind, word = kind_of(self.unit)
        if not math.isfinite(number):
            raise ParameterError(f"{self.name} = {number}; needs a finite number in {self.unit}")
        if kind == "inertia" and number <= 0:
            raise ParameterError(f"{self.name} = {number:g} {self.unit}; a {word} needs {self.name} > 0")
        if not self.low <= number <= self.high:
            raise ParameterError(f"{self.name} = {number:g} {self.unit}; {self._range(word)}")
        return number

    def _range(self, word):
        if self.low == 0 and math.isinf(self.high) and word:
            return (
                f"a {word} needs {self.name} >= 0. A negative one feeds energy to the user; if that is meant, "
                f"declare it: hl.parameters('{self.name}', units='{self.unit}', ranges=(-limit, limit))"
            )
        return f"it was declared to lie within {self.low:g} and {self.high:g}"


#: sampling period [s], bound when a scene is compiled
T = Parameter("T", "s", 0.0)


def parameters(names, *, units, values=None, ranges=None):
    """Declare the parameters of a scene, each with its unit.

    Parameters
    ----------
    names : str
        Names separated by spaces.
    units : str
        One SI unit for each, separated by spaces; ``1`` for a pure number.
    values : number, sequence or dict, optional
        Default values in SI, or texts with a unit such as ``"10 mm"``.
    ranges : (low, high), sequence of them, or dict, optional
        Closed ranges in SI. Without one a mass must be > 0, and a stiffness, damping or time >= 0.

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
    names, units = names.replace(",", " ").split(), units.replace(",", " ").split()
    if len(names) != len(units) or not names:
        raise ParameterError(
            f"{len(names)} names ({' '.join(names)}) but {len(units)} units ({' '.join(units)}); "
            "give one unit a name, separated by spaces, such as units='N/m m'"
        )
    if len(names) == 1:
        values = values if isinstance(values, dict) else {names[0]: values}
        ranges = ranges if isinstance(ranges, dict) else {names[0]: ranges}
    made = tuple(
        _parameter(name, unit, _entry(values, names, k), _entry(ranges, names, k))
        for k, (name, unit) in enumerate(zip(names, units, strict=True))
    )
    return made if len(made) > 1 else made[0]


def _entry(given, names, k):
    if isinstance(given, dict):
        strangers = set(given) - set(names)
        if strangers:
            raise ParameterError(f"{', '.join(sorted(strangers))} is not among the names {' '.join(names)}")
        return given.get(names[k])
    if given is not None and len(given) != len(names):
        raise ParameterError(f"{len(given)} entries for {len(names)} names ({' '.join(names)}); give one for each")
    return None if given is None else given[k]


def _parameter(name, unit, value, limits):
    dimension(unit)  # refuses what is not SI
    if not name.isidentifier() or name in ("n", "t", "T", "x", "v", "F"):
        raise ParameterError(f"{name!r} cannot name a parameter; n, t, T, x, v and F are taken, others must be like k_1")
    kind, _ = kind_of(unit)
    low, high = limits if limits is not None else ((0.0 if kind else -math.inf), math.inf)
    if not low <= high:
        raise ParameterError(f"{name}: range ({low}, {high}) is empty; give (low, high) with low <= high")
    made = Parameter(name, unit, float(low), float(high))
    return made if value is None else Parameter(name, unit, float(low), float(high), made.check(value))


def coordinate(name, *, unit, initial=0, rate=0):
    """Declare a generalized coordinate q(t) of the virtual environment.

    Parameters
    ----------
    name : str
    unit : str
        SI unit, such as ``m`` or ``rad``.
    initial, rate : number or expression
        Value and rate at the first sample; may use parameters and x(n), so that a body can start at the handle.

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
    dimension(unit)
    facts = {"role": "coordinate", "initial": sp.sympify(initial), "rate": sp.sympify(rate)}
    return sp.Function(name, real=True, unit=unit, **facts)(t)


def signal(name, *, unit, initial=0):
    """Declare a discrete-time signal y(n), to be defined by an equation ``Eq(y(n), ...)`` in a scene's ``eom``.

    Its right side may use y(n-1), y(n-2): filters, observers and estimators are difference equations.

    Parameters
    ----------
    name : str
    unit : str
    initial : number or expression
        The value of every sample before the first.

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
    dimension(unit)
    return sp.Function(name, real=True, unit=unit, role="signal", initial=sp.sympify(initial))


def lag_of(applied):
    """Return k of a sample y(n-k), or None for y(t); raise SignalError for any other argument."""
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
    cure = f"write {name}(n), {name}(n-1), ... or {name}(t), with n and t from hapticlab"
    raise SignalError(f"{applied} is not a sample: {cure}")


class _HandleSignal(sp.Function):
    """A signal of the handle: one argument, checked when written."""

    nargs = 1
    is_real = True
    role = "handle"

    @classmethod
    def eval(cls, argument):
        if not argument.free_symbols & {n, t}:
            raise SignalError(f"{cls.__name__}({argument}) is not a sample: write {cls.__name__}(n) or {cls.__name__}(t)")
        applied = sp.Basic.__new__(cls, argument)
        lag_of(applied)


class v(_HandleSignal):
    """Velocity of the handle v_e [m/s]: v(n) at the present sample, v(t) in an equation of motion."""

    unit = "m/s"


class x(_HandleSignal):
    """Position of the handle x_e [m]: x(n) at the present sample, x(n-1) before it, x(t) in an equation of motion."""

    unit = "m"

    def fdiff(self, argindex=1):
        return v(self.args[0])


class delay(sp.Function):
    """The value an expression had one sample ago; at the first sample, its present value.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k = hl.parameters("k", units="N/m")
    >>> hl.delay(k * hl.x(hl.n))
    delay(k*x(n))
    """

    nargs = 1
    is_real = True
    keeps_unit = True


def when(condition, value, otherwise=0):
    """Return value where condition holds, else otherwise, as the cases of Eq. (23.1).

    Parameters
    ----------
    condition : sympy relation, such as ``x(n) >= x_o``
    value, otherwise : expression

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, x_o = hl.parameters("k x_o", units="N/m m")
    >>> hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o))
    Piecewise((k*(-x_o + x(n)), x(n) >= x_o), (0, True))
    """
    # not evaluated: SymPy would rearrange the condition, and the boundary would move by a rounding
    return sp.Piecewise((sp.sympify(value), sp.sympify(condition)), (sp.sympify(otherwise), True), evaluate=False)
