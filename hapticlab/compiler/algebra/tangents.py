"""Slopes of straight-line programs in numbers: values and tangents together, over many points at once.

Forward differentiation (Griewank and Walther, *Evaluating Derivatives*, ch. 3): exact to rounding, no differences are
taken. A comparison has no slope, so that what is differentiated is the case that holds at the point.
"""

import numpy as np

from ..ir.program import LEAVES
from ..ir.simplify import EVALUATE, NUMPY_TYPE
from ..ir.trace import reachable

_FUNCTIONS = {"sin": np.sin, "cos": np.cos, "exp": np.exp, "log": np.log, "atan": np.arctan, "tanh": np.tanh}
#: what computes a value, in the precision of the computer
_VALUES = EVALUATE | _FUNCTIONS | {
    "exp2i": np.exp2, "exponent": lambda a: np.floor(np.log2(np.abs(a))),
    "itof": lambda a: np.asarray(a, float), "cast": lambda a: a,
}  # fmt: skip
#: operation -> the partial derivatives by its operands, of its result r and its operands
_SLOPES = {
    "neg": lambda r, a: (-1.0,),
    "abs": lambda r, a: (np.where(a < 0.0, -1.0, 1.0),),
    "add": lambda r, a, b: (1.0, 1.0),
    "sub": lambda r, a, b: (1.0, -1.0),
    "mul": lambda r, a, b: (b, a),
    "div": lambda r, a, b: (1.0 / b, -r / b),
    "sqrt": lambda r, a: (0.5 / r,),
    "sin": lambda r, a: (np.cos(a),),
    "cos": lambda r, a: (-np.sin(a),),
    "exp": lambda r, a: (r,),
    "log": lambda r, a: (1.0 / a,),
    "atan": lambda r, a: (1.0 / (1.0 + a * a),),
    "tanh": lambda r, a: (1.0 - r * r,),
    "cast": lambda r, a: (1.0,),
}


def tangents(instructions, wanted, leaves, directions, points=1):
    """Return (values, slopes) of some results: arrays of shape (results, points) and (results, directions, points).

    Parameters
    ----------
    instructions : sequence of Instruction
    wanted : sequence of int
        Positions of the results.
    leaves : dict (op, index) -> number or array of shape (points,)
        What parameters, inputs and states are.
    directions : sequence of (op, index)
        The leaves by which is differentiated, in order.
    points : int

    Examples
    --------
    >>> from hapticlab.compiler.ir.trace import Builder, sin
    >>> b = Builder()
    >>> x = b.leaf("input", 0, "f64")
    >>> y = x * sin(x)
    >>> values, slopes = tangents(b.instructions, [y.id], {("input", 0): 2.0}, [("input", 0)])
    >>> float(slopes[0, 0, 0].round(9))
    0.077003754
    """
    value, slope, number = {}, {}, {leaf: k for k, leaf in enumerate(directions)}
    with np.errstate(all="ignore"):
        for p in reachable(instructions, wanted):
            i = instructions[p]
            if i.op == "const":
                value[p] = NUMPY_TYPE[i.type](i.value)
            elif i.op in LEAVES:
                value[p] = leaves[i.op, i.index]
                if (i.op, i.index) in number:
                    slope[p] = np.eye(len(directions))[number[i.op, i.index]][:, None]
            else:
                value[p] = _VALUES[i.op](*(value[a] for a in i.args))
                found = _slope(i, value, slope, p)
                if found is not None:
                    slope[p] = found
    shape, none = (len(directions), points), np.zeros((len(directions), 1))
    values = [np.broadcast_to(np.asarray(value[p], float), (points,)) for p in wanted]
    slopes = [np.broadcast_to(slope.get(p, none), shape) for p in wanted]
    return np.reshape(values, (len(wanted), points)), np.reshape(slopes, (len(wanted), *shape))


def _slope(i, value, slope, p):
    """Return the slope of an instruction, None where nothing of it moves."""
    moving = [a in slope for a in i.args]
    if not any(moving):
        return None
    if i.op == "select":
        c, a, b = i.args
        return np.where(value[c], slope.get(a, 0.0), slope.get(b, 0.0)) if a in slope or b in slope else None
    if i.op not in _SLOPES:
        return None  # whole numbers and conditions
    total = None
    for a, part in zip(i.args, _SLOPES[i.op](value[p], *(value[a] for a in i.args)), strict=True):
        if a in slope:
            term = slope[a] * part
            total = term if total is None else total + term
    return total
