"""How much mass is felt at the handle through a constraint: what the force gains with the handle's acceleration."""

import numpy as np

from ...scene.mechanics.loop_closure import driven_over
from ...scene.notation.symbols import acceleration, t
from ..algebra.expressions import Translator
from ..algebra.graph import Graph
from ..ir.trace import Builder, computed


def port_mass(enforced, force, M, f, start):
    """dF/dx'' [kg], the largest over the range of the drivers, at the rates of the start.

    Parameters
    ----------
    enforced : what enforces the constraints
    force : expression [N]
        Holding reactions of constraints.
    M, f : lists of expressions
        Of the coordinates that the constraints have in common.
    start : dict
        Every variable -> its value at the start.
    """
    builder, leaves = Builder("f64"), {}

    def leaf(expr):
        if getattr(type(expr), "role", None) == "reaction" and hasattr(type(expr), "constraint"):
            return enforced.reactions(instant, *motion)[type(expr).constraint]
        known = instant.leaf(expr)
        return builder.leaf("input", leaves.setdefault(expr, len(leaves)), "f64") if known is None else known

    translate = Translator(builder, leaf, clock=_Stopped, graph=Graph())
    instant = enforced.instant(translate)
    motion = [[translate(m) for m in row] for row in M], [translate(right) for right in f]
    felt = translate(force)
    at = start | driven_over(enforced.second, start)
    of_acceleration = [_evaluated(felt, [at.get(expr, 0.0) for expr in leaves], list(leaves), a) for a in (0.0, 1.0)]
    return float(np.nanmax(np.abs(np.subtract(*of_acceleration))))


class _Stopped:
    """The clock at the first sample: angles that time drives have not moved."""

    @staticmethod
    def angle(translator, f):
        return translator.builder.const(0.0)


def _evaluated(value, inputs, variables, a):
    """A traced value in numbers, with the handle's acceleration a."""
    inputs = [a if variable == acceleration(t) else number for variable, number in zip(variables, inputs, strict=True)]
    return computed(value.builder.instructions, [value.id], lambda i: inputs[i.index])[value.id]
