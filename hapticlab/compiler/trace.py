"""Trace ordinary arithmetic into a block: values are numbered, constants folded and identities removed as they appear.

The lines of a method, a wall law or a paddle are written once, in plain arithmetic. Given floats or NumPy arrays they
compute; given :class:`Value` they record. Value numbering: Cocke and Schwartz (1970), as hash-consing.
"""

import math

import numpy as np

from ..errors import ProgramError
from .ir import COMMUTATIVE, LEAVES, OPERATIONS, REAL_TYPES, Block, Instruction

NUMPY_TYPE = {"f32": np.float32, "f64": np.float64, "bool": np.bool_, "i32": np.int32}


class Builder:
    """Collects the instructions of one block. ``real`` is the type a plain number takes when nothing else says."""

    def __init__(self, real="f64"):
        self.real = real
        self.instructions = []
        self._known = {}

    def const(self, value, type=None):
        """Return the constant, rounded to its type."""
        type = type or ("bool" if isinstance(value, (bool, np.bool_)) else self.real)
        rounded = NUMPY_TYPE[type](value).item()
        # the sign of zero and every nan are told apart by repr, which equality is not able to do
        return self._number(("const", type, repr(rounded)), Instruction("const", (), type, value=rounded))

    def leaf(self, op, index, type):
        """Return parameter, input or state number ``index``."""
        return self._number((op, index), Instruction(op, (), type, index=index))

    def emit(self, op, *operands, type=None):
        """Record one operation and return its value; ``type`` is needed by cast and itof alone."""
        type = type or self._result_type(op, operands)
        simpler = _simplify(self, op, operands, type)
        if simpler is not None:
            return simpler
        ids = tuple(o.id for o in operands)
        if op in COMMUTATIVE:
            ids = tuple(sorted(ids))
        return self._number((op, ids, type), Instruction(op, ids, type))

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
        if key not in self._known:
            self.instructions.append(instruction)
            self._known[key] = len(self.instructions) - 1
        return Value(self, self._known[key], instruction.type)

    def _result_type(self, op, operands):
        result = OPERATIONS[op][1]
        if result == "R":
            reals = {o.type for o in operands} & set(REAL_TYPES)
            if len(reals) != 1:
                raise ProgramError(f"{op} of {', '.join(o.type for o in operands)}: cast one of them first")
            return reals.pop()
        return {"B": "bool", "I": "i32"}[result]


def reachable(instructions, wanted):
    """Return, in order, the positions that the wanted ones need."""
    seen, stack = set(), list(wanted)
    while stack:
        k = stack.pop()
        if k not in seen:
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


#: the primitive operations on NumPy values; elementary functions are expanded before anything is evaluated
EVALUATE = {
    "neg": np.negative, "abs": np.abs, "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide,
    "sqrt": np.sqrt, "floor": np.floor, "lt": np.less, "le": np.less_equal, "eq": np.equal,
    "and": np.logical_and, "or": np.logical_or, "not": np.logical_not, "select": np.where,
    "iadd": np.add,
}  # fmt: skip


def _simplify(builder, op, operands, type):
    """Return a value that is the same number at less cost, or None."""
    constants = [o.constant for o in operands]
    if op in EVALUATE and all(c is not None for c in constants):
        with np.errstate(all="ignore"):
            arguments = [NUMPY_TYPE[o.type](c) for o, c in zip(operands, constants, strict=True)]
            return builder.const(EVALUATE[op](*arguments).item(), type)
    if op == "cast" and constants[0] is not None:
        return builder.const(constants[0], type)
    rule = _RULES.get(op)
    return rule(builder, operands, constants, type) if rule else None


def _is_neg(v):
    i = v.builder.instructions[v.id]
    return Value(v.builder, i.args[0], v.type) if i.op == "neg" else None


def _simplify_add(builder, operands, constants, type):
    for (a, b), c in ((operands, constants[1]), (operands[::-1], constants[0])):
        if c == 0:
            return a  # exact but for -0 + 0, which stays -0
        if _is_neg(b) is not None:
            return a - _is_neg(b)
    return None


def _simplify_sub(builder, operands, constants, type):
    a, b = operands
    if constants[1] == 0:
        return a
    if constants[0] == 0:
        return -b  # exact but for 0 - 0, which becomes -0
    return a + _is_neg(b) if _is_neg(b) is not None else None


def _simplify_mul(builder, operands, constants, type):
    for a, c in ((operands[0], constants[1]), (operands[1], constants[0])):
        if c is not None and c in (0, 1, -1):
            # a product with a structural zero is not computed at all, so it cannot carry a nan into the result
            return builder.const(0.0, type) if c == 0 else a if c == 1 else -a
    a, b = (_is_neg(o) for o in operands)
    return a * b if a is not None and b is not None else None


def _simplify_div(builder, operands, constants, type):
    a, c = operands[0], constants[1]
    if constants[0] == 0 and c is None:
        return builder.const(0.0, type)
    if c is not None and 2.0**-100 < abs(c) < 2.0**100 and abs(math.frexp(c)[0]) == 0.5:
        return a * (1 / c)  # a power of two has an exact reciprocal, in either type within these bounds
    return None


def _simplify_select(builder, operands, constants, type):
    condition, a, b = operands
    if constants[0] is not None:
        return a if constants[0] else b
    return a if a.id == b.id else None


def _simplify_not(builder, operands, constants, type):
    i = builder.instructions[operands[0].id]
    return Value(builder, i.args[0], "bool") if i.op == "not" else None


def _simplify_logic(absorbing):
    def rule(builder, operands, constants, type):
        for a, c in ((operands[0], constants[1]), (operands[1], constants[0])):
            if c is not None:
                return builder.const(absorbing) if c == absorbing else a
        return operands[0] if operands[0].id == operands[1].id else None

    return rule


def _simplify_neg(builder, operands, constants, type):
    return _is_neg(operands[0])


_RULES = {
    "add": _simplify_add, "sub": _simplify_sub, "mul": _simplify_mul, "div": _simplify_div, "neg": _simplify_neg,
    "select": _simplify_select, "not": _simplify_not, "and": _simplify_logic(False), "or": _simplify_logic(True),
}  # fmt: skip
