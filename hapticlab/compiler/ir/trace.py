"""Trace ordinary arithmetic into a block: values are numbered, constants folded and identities removed as they appear.

The lines of a method, a wall law or a paddle are written once, in plain arithmetic. Given floats or NumPy arrays they
compute; given :class:`Value` they record. Value numbering: Cocke and Schwartz (1970), as hash-consing.
"""

import numpy as np

from ...errors import ProgramError
from .program import COMMUTATIVE, LEAVES, OPERATIONS, REAL_TYPES, Block, Instruction
from .simplify import NUMPY_TYPE, simplify


class Builder:
    """Collects the instructions of one block. ``real`` is the type a plain number takes when nothing else says."""

    def __init__(self, real="f64"):
        self.real = real
        self.instructions = []
        self._known = {}

    def const(self, value, type=None):
        """Return the constant, rounded to its type."""
        type = type or ("bool" if isinstance(value, (bool, np.bool_)) else self.real)
        rounded = value if type == "f64" and value.__class__ is float else NUMPY_TYPE[type](value).item()
        # the sign of zero and every nan are told apart by repr, which equality is not able to do
        return self._number(("const", type, repr(rounded)), Instruction("const", (), type, value=rounded))

    def leaf(self, op, index, type):
        """Return parameter, input or state number ``index``."""
        return self._number((op, index), Instruction(op, (), type, index=index))

    def result(self, number):
        """Return the value of an instruction already recorded."""
        return Value(self, number, self.instructions[number].type)

    def emit(self, op, *operands, type=None):
        """Record one operation and return its value; ``type`` is needed by cast and itof alone."""
        type = type or self._result_type(op, operands)
        simpler = simplify(self, op, operands, type)
        if simpler is not None:
            return simpler
        ids = tuple([o.id for o in operands])
        if op in COMMUTATIVE and ids[0] > ids[1]:
            ids = ids[::-1]
        return self._number((op, ids, type), Instruction(op, ids, type))

    def identify(self, op, operand, value):
        """From now on take ``value`` for ``op(operand)``: a result that is known already, at less cost."""
        self._known.setdefault((op, (operand.id,), value.type), value.id)

    def inline(self, block, **leaves):
        """Copy a block in, its leaves replaced: ``inline(block, param=[...], input=[...], state=[...])``.

        Returns
        -------
        outputs, states : list of Value
        """
        here = []
        for i in block.instructions:
            if i.op == "const":
                here.append(self.const(i.value, i.type))
            elif i.op in LEAVES:
                here.append(cast(self._value(leaves[i.op][i.index]), i.type))
            else:
                here.append(self.emit(i.op, *(here[a] for a in i.args), type=i.type))
        return [here[k] for k in block.outputs], [here[k] for k in block.states]

    def block(self, outputs=(), states=()):
        """Return the finished block: only what its results need, in order."""
        wanted = [v.id for v in (*outputs, *states)]
        keep = reachable(self.instructions, wanted)
        new = {old: position for position, old in enumerate(keep)}
        kept = (self.instructions[k] for k in keep)
        renumbered = (Instruction(i.op, tuple(new[a] for a in i.args), i.type, i.value, i.index) for i in kept)
        return Block(tuple(renumbered), tuple(new[v.id] for v in outputs), tuple(new[v.id] for v in states))

    def _value(self, v):
        return v if isinstance(v, Value) else self.const(v)

    def _number(self, key, instruction):
        number = self._known.get(key)
        if number is None:
            number = self._known[key] = len(self.instructions)
            self.instructions.append(instruction)
        return Value(self, number, self.instructions[number].type)

    def _result_type(self, op, operands):
        result = OPERATIONS[op][1]
        if result == "R":
            reals = {o.type for o in operands}.intersection(REAL_TYPES)
            if len(reals) != 1:
                raise ProgramError(f"{op} of {', '.join(o.type for o in operands)}: cast one of them first")
            return reals.pop()
        return {"B": "bool", "I": "i32"}[result]


def reachable(instructions, wanted, known=()):
    """Return, in order, the positions that the wanted ones need and that are not known yet."""
    seen, stack = set(), list(wanted)
    while stack:
        k = stack.pop()
        if k not in seen and k not in known:
            seen.add(k)
            stack.extend(instructions[k].args)
    return sorted(seen)


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

    def _with(self, op, other, swap=False):
        if not isinstance(other, Value):
            other = self.builder.const(other, self.type)
        return self.builder.emit(op, *((other, self) if swap else (self, other)))

    def __add__(self, other):
        return self._with("add", other)

    def __radd__(self, other):
        return self._with("add", other, True)

    def __sub__(self, other):
        return self._with("sub", other)

    def __rsub__(self, other):
        return self._with("sub", other, True)

    def __mul__(self, other):
        return self._with("mul", other)

    def __rmul__(self, other):
        return self._with("mul", other, True)

    def __truediv__(self, other):
        return self._with("div", other)

    def __rtruediv__(self, other):
        return self._with("div", other, True)

    def __neg__(self):
        return self.builder.emit("neg", self)

    def __abs__(self):
        return self.builder.emit("abs", self)

    def __lt__(self, other):
        return self._with("lt", other)

    def __le__(self, other):
        return self._with("le", other)

    def __gt__(self, other):
        return self._with("lt", other, True)

    def __ge__(self, other):
        return self._with("le", other, True)

    def __and__(self, other):
        return self._with("and", other)

    def __or__(self, other):
        return self._with("or", other)

    __rand__, __ror__ = __and__, __or__  # of a plain bool on the left

    def __invert__(self):
        return self.builder.emit("not", self)

    def __bool__(self):
        raise ProgramError("a traced condition has no truth value yet: write select(condition, a, b) instead of if")

    def __repr__(self):
        return f"Value({self.type} %{self.id})"


def select(condition, a, b):
    """Return a where condition holds, else b; both are evaluated."""
    if not isinstance(condition, Value):
        return np.where(condition, a, b) if isinstance(condition, np.ndarray) else (a if condition else b)
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


def equal(a, b):
    """Compare for equality (``==`` on values compares the values themselves, not their numbers)."""
    return a._with("eq", b) if isinstance(a, Value) else a == b


def cast(a, type):
    """Return a in another real type."""
    return a if not isinstance(a, Value) or a.type == type else a.builder.emit("cast", a, type=type)


def _function(name, of_numbers):
    def apply(a):
        return a.builder.emit(name, a) if isinstance(a, Value) else of_numbers(a)

    apply.__name__ = name
    apply.__doc__ = f"Return {name}(a) of a traced value, a float or an array."
    return apply


sqrt, floor = _function("sqrt", np.sqrt), _function("floor", np.floor)
sin, cos, atan = _function("sin", np.sin), _function("cos", np.cos), _function("atan", np.arctan)
exp, log, tanh = _function("exp", np.exp), _function("log", np.log), _function("tanh", np.tanh)
