"""Constant folding and identities, applied to every operation as it is recorded."""

import math

import numpy as np

NUMPY_TYPE = {"f32": np.float32, "f64": np.float64, "bool": np.bool_, "i32": np.int32}

#: the primitive operations on NumPy values; elementary functions are expanded before anything is evaluated
EVALUATE = {
    "neg": np.negative, "abs": np.abs, "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide,
    "sqrt": np.sqrt, "floor": np.floor, "lt": np.less, "le": np.less_equal, "eq": np.equal,
    "and": np.logical_and, "or": np.logical_or, "not": np.logical_not, "select": np.where,
    "iadd": np.add,
}  # fmt: skip


def simplify(builder, op, operands, type):
    """Return a value that is the same number at less cost, or None."""
    constants = [o.constant for o in operands]
    if None not in constants and op in EVALUATE:
        with np.errstate(all="ignore"):
            arguments = [NUMPY_TYPE[o.type](c) for o, c in zip(operands, constants, strict=True)]
            return builder.const(EVALUATE[op](*arguments).item(), type)
    if op == "cast" and constants[0] is not None:
        return builder.const(constants[0], type)
    rule = _RULES.get(op)
    return rule(builder, operands, constants, type) if rule else None


def _is_neg(v):
    i = v.builder.instructions[v.id]
    return v.builder.result(i.args[0]) if i.op == "neg" else None


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
    _, a, b = operands
    if constants[0] is not None:
        return a if constants[0] else b
    return a if a.id == b.id else None


def _simplify_not(builder, operands, constants, type):
    i = builder.instructions[operands[0].id]
    return builder.result(i.args[0]) if i.op == "not" else None


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
