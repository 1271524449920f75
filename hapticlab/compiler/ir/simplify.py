"""The same number at less cost: the identities of each operation, applied as it is recorded.

A rule is given the builder, the operands, their constants (None where an operand is none) and the type of the result. It
returns a value, or None where nothing is simpler. Where all operands are constants the builder has folded them before.
"""

import math


def _is_neg(v):
    i = v.builder.instructions[v.id]
    return v.builder.result(i.args[0]) if i.op == "neg" else None


def total(builder, operands, constants, type):
    for (a, b), c in ((operands, constants[1]), (operands[::-1], constants[0])):
        if c == 0:
            return a  # exact but for -0 + 0, which stays -0
        if _is_neg(b) is not None:
            return a - _is_neg(b)
    return None


def difference(builder, operands, constants, type):
    a, b = operands
    if constants[1] == 0:
        return a
    if constants[0] == 0:
        return -b  # exact but for 0 - 0, which becomes -0
    return a + _is_neg(b) if _is_neg(b) is not None else None


def product(builder, operands, constants, type):
    for a, c in ((operands[0], constants[1]), (operands[1], constants[0])):
        if c is not None and c in (0, 1, -1):
            # a product with a structural zero is not computed at all, so it cannot carry a nan into the result
            return builder.const(0.0, type) if c == 0 else a if c == 1 else -a
    a, b = (_is_neg(o) for o in operands)
    return a * b if a is not None and b is not None else None


def quotient(builder, operands, constants, type):
    a, c = operands[0], constants[1]
    if constants[0] == 0 and c is None:
        return builder.const(0.0, type)
    if c is not None and 2.0**-100 < abs(c) < 2.0**100 and abs(math.frexp(c)[0]) == 0.5:
        return a * (1 / c)  # a power of two has an exact reciprocal, in either type within these bounds
    return None


def choice(builder, operands, constants, type):
    _, a, b = operands
    if constants[0] is not None:
        return a if constants[0] else b
    return a if a.id == b.id else None


def negation(builder, operands, constants, type):
    i = builder.instructions[operands[0].id]
    return builder.result(i.args[0]) if i.op == "not" else None


def logic(absorbing):
    def rule(builder, operands, constants, type):
        for a, c in ((operands[0], constants[1]), (operands[1], constants[0])):
            if c is not None:
                return builder.const(absorbing) if c == absorbing else a
        return operands[0] if operands[0].id == operands[1].id else None

    return rule


def negative(builder, operands, constants, type):
    return _is_neg(operands[0])
