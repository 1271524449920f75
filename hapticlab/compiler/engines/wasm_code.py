"""The code of a block in WebAssembly: results in locals that are reused once free, arms of selects as ``if``.

The selects stay. Where an arm is skipped its results are 0, which a select does not take from an arm that it does not
choose; so every bit is as it would be without branches. (0 rather than what a local held: else the result of one tick would
live on into the next, and keep a register.)
"""

import functools
import math
from itertools import groupby

from ..ir.operations import ELEMENTARY, OPERATIONS
from ..ir.program import LEAVES
from .side_by_side import arithmetic
from .skipped_arms import Arm
from .wasm_words import OPCODES, unsigned


@functools.cache
def get(local):
    """Return the code that pushes a local."""
    return OPCODES["local.get"] + unsigned(local)


@functools.cache
def put(local):
    """Return the code that takes a local from the stack."""
    return OPCODES["local.set"] + unsigned(local)


class Locals:
    """The locals of a function after its arguments, taken and given back; those of ``apart`` are never taken here.

    Attributes
    ----------
    types : list of str
        Value type of each.
    lanes : Lanes
        What they hold.
    """

    def __init__(self, arguments, lanes, types=None):
        self.arguments, self.lanes, self.types, self._free = arguments, lanes, [] if types is None else types, {}

    def apart(self):
        return Locals(self.arguments, self.lanes, self.types)

    def take(self, type):
        """Return the number of a local that is free, for a type of a program."""
        return self.take_value(self.lanes.types[type])

    def take_value(self, type):
        """Return the number of a local that is free, for a value type."""
        if self._free.get(type):
            return self._free[type].pop()
        self.types.append(type)
        return self.arguments + len(self.types) - 1

    def give_back(self, number):
        self._free.setdefault(self.types[number - self.arguments], []).append(number)


class Functions:
    """The code of elementary functions, made once: arguments and results in locals of its own, copied in and out."""

    def __init__(self, locals):
        self._locals, self._made = locals.apart(), {}

    def code(self, ops, type):
        """Return the locals of the arguments, the code, and op -> what pushes its result, for functions of one family."""
        if (ops, type) not in self._made:
            block = arithmetic(ops, type)
            arguments = [self._locals.take(type) for _ in range(OPERATIONS[ops[0]].operands.count("R"))]
            inner = BlockCode(block, self._locals, {"input": arguments}, self)
            code = inner.write(inner.plan(range(len(block.instructions))))
            results = {op: inner.pushed[k] for op, k in zip(ops, block.outputs, strict=True)}
            for number in {*arguments, *(inner.local[k] for k in block.outputs if k in inner.local)}:
                self._locals.give_back(number)
            self._made[ops, type] = arguments, code, results
        return self._made[ops, type]


class BlockCode:
    """Writes the results of a block: first :meth:`plan` all that will be computed, then :meth:`write` it part by part.

    Parameters
    ----------
    block : Block
    locals : Locals
    leaves : dict
        param, input, state -> the locals of their channels.
    functions : Functions

    Attributes
    ----------
    pushed : dict
        Position -> the bytes that push its result.
    local : dict
        Position -> the local of its result.
    """

    def __init__(self, block, locals, leaves, functions):
        self._instructions, self._locals, self._functions, self._lanes = block.instructions, locals, functions, locals.lanes
        self.local, self.pushed, self._users = {}, {}, [[] for _ in block.instructions]
        for k, i in enumerate(block.instructions):
            if i.op in LEAVES:
                self.pushed[k] = self._lanes.constant(i.value, i.type) if i.op == "const" else get(leaves[i.op][i.index])
        #: how often each is used from here on
        self._left = [0] * len(block.instructions)
        self.keep((*block.outputs, *block.states))

    def plan(self, items, before=None):
        """Count the uses of positions and arms that will be written, and return them; ``before(k)`` must be known before k."""
        for item in items:
            if isinstance(item, Arm):
                self._left[item.condition] += 1
                self.plan(item.items, before)
                continue
            args = self._instructions[item].args
            for a in args:
                self._left[a] += 1
            for a in before(item) if before else args:
                self._users[a].append(item)
        return items

    def keep(self, positions):
        """Never give their locals back."""
        for k in positions:
            self._left[k] = math.inf

    def write(self, items):
        """Return the code that computes positions, and arms."""
        code = bytearray()
        for is_arm, some in groupby(items, lambda item: isinstance(item, Arm)):
            for piece in map(self._arm, some) if is_arm else (self._straight([*some]),):
                code += piece
        return bytes(code)

    def _straight(self, positions):
        code, together = bytearray(), {}
        for k in positions:
            i = self._instructions[k]
            if i.op in ELEMENTARY:
                together.setdefault((OPERATIONS[i.op].family or i.op, i.args), []).append(k)
        for k in positions:
            i = self._instructions[k]
            if k in self.pushed:  # a leaf, or a function that another of its family brought
                continue
            if i.op in ELEMENTARY:
                code += self._function(together[OPERATIONS[i.op].family or i.op, i.args])
                continue
            for a in (*i.args[1:], i.args[0]) if i.op == "select" else i.args:
                code += self.pushed[a]
            code += self._lanes.operation(i.op, i.type, self._instructions[i.args[0]].type)
            self._used(i.args)
            code += self._result(k)
        return code

    def _function(self, positions):
        i = self._instructions[positions[0]]
        ops = tuple(sorted({self._instructions[k].op for k in positions}))
        arguments, inner, results = self._functions.code(ops, i.type)
        code = b"".join(self.pushed[a] for a in i.args) + b"".join(put(local) for local in reversed(arguments))
        code += inner
        for k in positions:
            self._used(i.args)
            code += results[self._instructions[k].op] + self._result(k)
        return code

    def _arm(self, arm):
        code = self.pushed[arm.condition] + self._lanes.branch(arm.chosen)
        self._used((arm.condition,))
        code += self.write(arm.items)
        within = set(arm.positions())
        after = [k for k in within if k in self.local and not within.issuperset(self._users[k])]
        if after:
            code += OPCODES["else"]
        for k in sorted(after):
            code += self._lanes.constant(0, self._instructions[k].type) + put(self.local[k])
        return code + OPCODES["end"]

    def _used(self, positions):
        for k in positions:
            self._left[k] -= 1
            if not self._left[k] and k in self.local:
                self._locals.give_back(self.local[k])

    def _result(self, k):
        """Return the code that takes a result from the stack."""
        number = self.local[k] = self._locals.take(self._instructions[k].type)
        self.pushed[k] = get(number)
        if not self._left[k]:
            self._locals.give_back(number)
        return put(number)
