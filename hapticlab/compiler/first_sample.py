"""What expressions are at the first sample, as numbers."""

import math

import sympy as sp

from ..scene.parameters import Parameter
from ..scene.symbols import n, t
from .elementary import expand
from .expressions import Translator
from .interpreter import evaluate
from .ir import Block, Program
from .trace import Builder


def numbers(expressions, values):
    """Return what expressions are at the first sample as floats, or None where a parameter has no value."""
    builder, at = Builder("f64"), []

    def start(leaf):
        if isinstance(leaf, Parameter):
            return values.get(leaf.name, leaf.value)
        if leaf in (n, t) or getattr(type(leaf), "role", None) == "handle":
            return 0.0
        initial = type(leaf.expr).rate if isinstance(leaf, sp.Derivative) else type(leaf).initial
        return (numbers([initial], values) or [math.nan])[0]

    def leaf(expr):
        at.append((float(start(expr)), builder.leaf("input", len(at), "f64")))
        return at[-1][1]

    outputs = list(map(Translator(builder, leaf), expressions))
    program = Program("numbers", (), (), (), (), Block(), builder.block(outputs), 1.0)
    found, _ = evaluate(expand(program).tick, input=[value for value, _ in at])
    return None if any(math.isnan(value) for value, _ in at) else [float(f) for f in found]
