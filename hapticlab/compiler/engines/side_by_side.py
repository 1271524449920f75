"""Elementary functions of one lane computed side by side, as lanes of one vector.

The sines and cosines of a stage do not wait for each other. As one vector they are a tenth of the instructions to compile
and to run; lane by lane the arithmetic is that of elementary.py, so the bits are the same.
"""

import functools
from itertools import groupby

from ..ir.operations import ELEMENTARY, OPERATIONS
from ..ir.trace import Builder

#: of a vector of 512 bits; a machine with less takes it in parts
LANES = {"f64": 8, "f32": 16}


def in_order(block, positions):
    """Yield lists of positions, in an order in which they can be computed: a single one, or functions of one family.

    Every path from one function to another of the same list would make the second one deeper, so there is none.
    """
    instructions, depth = block.instructions, {}
    for k in sorted(positions):
        depth[k] = max((depth.get(a, 0) for a in instructions[k].args), default=0) + (instructions[k].op in ELEMENTARY)

    def key(k):
        i = instructions[k]
        function = i.op in ELEMENTARY
        return depth[k], not function, (OPERATIONS[i.op].family or i.op, i.type) if function else ()

    for (_, plain, _), alike in groupby(sorted(sorted(positions), key=key), key):
        if plain:
            yield from ([k] for k in alike)
        else:
            yield list(alike)


@functools.cache
def arithmetic(ops, type):
    """The block that computes elementary functions ``ops`` of the same operands, its inputs."""
    builder = Builder(type)
    operands = [builder.leaf("input", k, type) for k in range(len(OPERATIONS[ops[0]].operands))]
    return builder.block([ELEMENTARY[op](*operands) for op in ops])


def functions(writer, block, names, alike):
    """The lines of LLVM that compute elementary functions of one family, for a writer of one lane."""
    calls = [block.instructions[k] for k in alike]
    ops, type_ = sorted({i.op for i in calls}), calls[0].type
    made, scalar = arithmetic(tuple(ops), type_), writer.types[type_]
    operands, lines = [*dict.fromkeys(i.args for i in calls)], []
    for first in range(0, len(operands), LANES[type_]):
        lane_of = {args: lane for lane, args in enumerate(operands[first : first + LANES[type_]])}
        vector = type(writer)(1 << (len(lane_of) - 1).bit_length())
        base = f"{names[alike[0]]}.{first}."
        for k, positions in enumerate(zip(*lane_of, strict=True)):
            lines += _gathered(vector, f"{base}x{k}", [names[a] for a in positions], type_, scalar)
        inner = vector.names(made, base[1:], {"input": f"{base}x"})
        lines += vector.lines(made, inner, range(len(made.instructions)))
        for k, i in zip(alike, calls, strict=True):
            if i.args in lane_of:
                result, lane = inner[made.outputs[ops.index(i.op)]], lane_of[i.args]
                take = f"extractelement {vector.types[type_]} {result}, i32 {lane}"
                lines.append(f"{names[k]} = {take if vector.lanes > 1 else _same(scalar, result)}")
        writer.intrinsics |= vector.intrinsics
    return lines


def _gathered(vector, result, values, type, scalar):
    """The lines that make a vector of scalars, the last one repeated where lanes are left."""
    if vector.lanes == 1:
        return [f"{result} = {_same(scalar, values[0])}"]
    lines, so_far = [], "undef"
    for lane in range(vector.lanes):
        after = result if lane == vector.lanes - 1 else f"{result}.{lane}"
        value = values[min(lane, len(values) - 1)]
        lines.append(f"{after} = insertelement {vector.types[type]} {so_far}, {scalar} {value}, i32 {lane}")
        so_far = after
    return lines


def _same(scalar, value):
    return f"bitcast {scalar} {value} to {scalar}"
