"""Slopes of straight-line programs in numbers: values and tangents together, over many points at once.

Forward differentiation (Griewank and Walther, *Evaluating Derivatives*, ch. 3): exact to rounding, no differences are
taken. A comparison has no slope, so that what is differentiated is the case that holds at the point.
"""

import numpy as np

from ..ir.operations import OPERATIONS
from ..ir.trace import computed


def tangents(instructions, wanted, leaves, directions, points=1):
    """(values, slopes) of some results: arrays of shape (results, points) and (results, directions, points).

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
    value = computed(instructions, wanted, lambda i: leaves[i.op, i.index])
    slope = {}
    with np.errstate(all="ignore"):
        for p in value:
            i = instructions[p]
            # a constant is none, though ("const", 0) stands among the directions for the impulse of force_at="mean"
            if i.op != "const" and (i.op, i.index) in directions:
                slope[p] = np.eye(len(directions))[directions.index((i.op, i.index))][:, None]
            if not i.args:
                continue
            given = value[p], *(value[a] for a in i.args)
            for a, rule in zip(i.args, OPERATIONS[i.op].derivative, strict=False):  # a step function has none
                if a in slope:
                    # no factor 0 for the arm that is not chosen: its slope may be infinite
                    term = rule(slope[a], *given) if i.op == "select" else slope[a] * rule(1.0, *given)
                    slope[p] = slope[p] + term if p in slope else term
    shape, none = (len(directions), points), np.zeros((len(directions), 1))
    values = [np.broadcast_to(np.asarray(value[p], float), (points,)) for p in wanted]
    slopes = [np.broadcast_to(slope.get(p, none), shape) for p in wanted]
    return np.reshape(values, (len(wanted), points)), np.reshape(slopes, (len(wanted), *shape))
