"""Trace ordinary arithmetic into a block: values are numbered, constants folded and identities removed as they appear.

The lines of a method, a wall law or a paddle are written once, in the arithmetic of :mod:`hapticlab.compiler.ir.values`.
A :class:`Builder` collects what they record. Value numbering: Cocke and Schwartz (1970), as hash-consing.
"""

from dataclasses import replace

import numpy as np

from ...errors import ProgramError
from .operations import ELEMENTARY, OPERATIONS
from .program import LEAVES, NUMPY_TYPE, REAL_TYPES, Block, Instruction
from .values import Value, atan, cast, clip, cos, equal, exp, floor, log, maximum, minimum, select, sin, sqrt, tanh

__all__ = [
    "Builder", "Value", "atan", "cast", "clip", "computed", "cos", "equal", "exp", "expand", "floor", "log", "maximum", "minimum",
    "reachable", "select", "sin", "sqrt", "tanh",
]  # fmt: skip


class Builder:
    """Collects the instructions of one block. ``real`` is the type a plain number takes when nothing else says."""

    def __init__(self, real="f64"):
        self.real = real
        self.instructions = []
        self.implied = set()  #: results that hold wherever another condition beside them in an "and" does
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
        operation = OPERATIONS[op]
        type = type or self._result_type(operation, operands)
        simpler = self._simpler(operation, operands, type)
        return self._record(operation, operands, type) if simpler is None else simpler

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

    def _record(self, operation, operands, type):
        ids = tuple([o.id for o in operands])
        if operation.commutes and ids[0] > ids[1]:
            ids = ids[::-1]
        return self._number((operation.name, ids, type), Instruction(operation.name, ids, type))

    def _simpler(self, operation, operands, type):
        """Return a value that is the same number at less cost, or None."""
        constants = [o.constant for o in operands]
        # an elementary function is folded where it is expanded, in the arithmetic of every engine
        if None not in constants and not operation.definition:
            with np.errstate(all="ignore"):
                numbers = [NUMPY_TYPE[o.type](c) for o, c in zip(operands, constants, strict=True)]
                return self.const(operation.compute(*numbers).item(), type)
        return operation.simpler(self, operands, constants, type) if operation.simpler else None

    def _result_type(self, operation, operands):
        if operation.result == "R":
            reals = {o.type for o in operands}.intersection(REAL_TYPES)
            if len(reals) != 1:
                raise ProgramError(f"{operation.name} of {', '.join(o.type for o in operands)}: cast one of them first")
            return reals.pop()
        return {"B": "bool", "I": "i32"}[operation.result]

    def _expand(self, block):
        """Record a block with its elementary functions as their arithmetic, and return what it became."""
        here = []
        for i in block.instructions:
            if i.op in ELEMENTARY:
                here.append(ELEMENTARY[i.op](*(here[a] for a in i.args)))
            elif i.op == "const":
                here.append(self.const(i.value, i.type))
            elif i.op in LEAVES:
                here.append(self.leaf(i.op, i.index, i.type))
            else:  # as it stands: an expansion is not the place to simplify
                here.append(self._record(OPERATIONS[i.op], [here[a] for a in i.args], i.type))
        return self.block([here[k] for k in block.outputs], [here[k] for k in block.states])


def expand(program):
    """The program with every elementary function replaced by its arithmetic.

    Nothing else is touched; sin and cos of one angle share their reduction.

    Examples
    --------
    >>> from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
    >>> x, y = Instruction("input", (), "f32"), Instruction("sin", (0,), "f32")
    >>> p = Program("p", (Channel("x"),), (), (), (Channel("F"),), Block(), Block((x, y), outputs=(1,)), T=1e-3)
    >>> len(p), len(expand(p)) > 20
    (1, True)
    """
    init, tick = (
        Builder()._expand(block) if any(i.op in ELEMENTARY for i in block.instructions) else block
        for block in (program.init, program.tick)
    )
    return replace(program, init=init, tick=tick)


def reachable(instructions, wanted, known=()):
    """Return, in order, the positions that the wanted ones need and that are not known yet."""
    seen, stack = set(), list(wanted)
    while stack:
        k = stack.pop()
        if k not in seen and k not in known:
            seen.add(k)
            stack.extend(instructions[k].args)
    return sorted(seen)


def computed(instructions, wanted, leaf):
    """The numbers of some positions, and of what they need: a dict position -> number or array.

    Parameters
    ----------
    instructions : sequence of Instruction
    wanted : sequence of int
    leaf : callable Instruction -> number or array
        What an input, a state or a parameter is.
    """
    done = {}
    with np.errstate(all="ignore"):
        for k in reachable(instructions, wanted):
            i = instructions[k]
            if i.args:
                done[k] = OPERATIONS[i.op].compute(*[done[a] for a in i.args])
            else:
                # a condition that is a state stays one: floats have no "not"
                real = bool if i.type == "bool" else float
                done[k] = NUMPY_TYPE[i.type](i.value) if i.op == "const" else np.asarray(leaf(i), real)
    return done
