"""Ordinary arithmetic that computes on floats and NumPy arrays, and records on traced values.

A line such as ``k * maximum(x - x_o, 0.0)`` is written once. With a float in it is a float, with an array over lanes an
array; with a :class:`Value` in it becomes instructions of the block whose builder made the value.
"""

import operator

import numpy as np

from ...errors import ProgramError


class Value:
    """A result inside a builder; arithmetic on it records instructions."""

    __slots__ = ("builder", "id", "type")
    __array_ufunc__ = None  # numpy scalars on the left must defer to us

    def __init__(self, builder, id, type):
        self.builder, self.id, self.type = builder, id, type

    @property
    def constant(self):
        """The number this value is, or None."""
        i = self.builder.instructions[self.id]
        return i.value if i.op == "const" else None

    def _emit(self, op, *operands):
        """Record an operation of values and numbers; a number becomes a constant of this value's type."""
        const = self.builder.const
        return self.builder.emit(op, *[o if isinstance(o, Value) else const(o, self.type) for o in operands])

    def __add__(self, other):
        return self._emit("add", self, other)

    def __radd__(self, other):
        return self._emit("add", other, self)

    def __sub__(self, other):
        return self._emit("sub", self, other)

    def __rsub__(self, other):
        return self._emit("sub", other, self)

    def __mul__(self, other):
        return self._emit("mul", self, other)

    def __rmul__(self, other):
        return self._emit("mul", other, self)

    def __truediv__(self, other):
        return self._emit("div", self, other)

    def __rtruediv__(self, other):
        return self._emit("div", other, self)

    def __neg__(self):
        return self.builder.emit("neg", self)

    def __abs__(self):
        return self.builder.emit("abs", self)

    def __lt__(self, other):
        return self._emit("lt", self, other)

    def __le__(self, other):
        return self._emit("le", self, other)

    def __gt__(self, other):
        return self._emit("lt", other, self)

    def __ge__(self, other):
        return self._emit("le", other, self)

    def __and__(self, other):
        return self._emit("and", self, other)

    def __or__(self, other):
        return self._emit("or", self, other)

    __rand__, __ror__ = __and__, __or__  # of a plain bool on the left

    def __invert__(self):
        return self.builder.emit("not", self)

    def __bool__(self):
        raise ProgramError("a traced condition has no truth value yet: write select(condition, a, b) instead of if")

    def __repr__(self):
        return f"Value({self.type} %{self.id})"


def select(condition, a, b):
    """Return a where condition holds, else b; both are evaluated."""
    if isinstance(condition, np.ndarray):
        return np.where(condition, a, b)
    if not isinstance(condition, Value):
        return a if condition else b
    builder = condition.builder
    type = next((o.type for o in (a, b) if isinstance(o, Value)), builder.real)
    a, b = (o if isinstance(o, Value) else builder.const(o, type) for o in (a, b))
    return builder.emit("select", condition, a, b)


def minimum(a, b):
    """Return a if a < b else b, in that order of evaluation on every engine."""
    return select(a < b, a, b)


def maximum(a, b):
    """Return a if b < a else b."""
    return select(b < a, a, b)


def clip(a, low, high):
    """Return a held within [low, high]."""
    return minimum(maximum(a, low), high)


def cast(a, type):
    """Return a in another real type."""
    return a if not isinstance(a, Value) or a.type == type else a.builder.emit("cast", a, type=type)


def recorded(name, of_numbers):
    """The operation ``name``: computed of numbers and arrays by ``of_numbers``, recorded of traced values.

    Examples
    --------
    >>> import numpy as np
    >>> float(recorded("sqrt", np.sqrt)(9.0))
    3.0
    """

    def apply(*operands):
        for o in operands:
            if isinstance(o, Value):
                return o._emit(name, *operands)
        return of_numbers(*operands)

    apply.__name__ = name
    return apply


#: of a real type, by the bytes of a number: exponent bias, mantissa bits and the integer of the same width
_LAYOUT = {4: (127, 23, np.int32), 8: (1023, 52, np.int64)}


def _exp2i_of_numbers(k):
    k = np.asarray(k)
    bias, bits, integer = _LAYOUT[k.itemsize]
    held = np.clip(np.where(np.isnan(k), 0, k), 1 - bias, bias)
    return ((held.astype(integer) + integer(bias)) << integer(bits)).view(k.dtype)


def _exponent_of_numbers(a):
    a = np.asarray(a)
    bias, bits, integer = _LAYOUT[a.itemsize]
    field = (a.view(integer) >> integer(bits)) & integer(2 * bias + 1)
    return (field - integer(bias)).astype(a.dtype)


sqrt, floor = recorded("sqrt", np.sqrt), recorded("floor", np.floor)
sin, cos, atan = recorded("sin", np.sin), recorded("cos", np.cos), recorded("atan", np.arctan)
exp, log, tanh = recorded("exp", np.exp), recorded("log", np.log), recorded("tanh", np.tanh)
exp2i, exponent = recorded("exp2i", _exp2i_of_numbers), recorded("exponent", _exponent_of_numbers)
iadd = recorded("iadd", np.add)
#: of values, ``==`` compares the values themselves, not their numbers
equal = recorded("eq", operator.eq)
