"""Slopes of instruction lists, against derivatives worked out by SymPy."""

import numpy as np
import pytest
import sympy as sp

from hapticlab.compiler.algebra.tangents import tangents
from hapticlab.compiler.ir.trace import Builder, atan, cos, exp, floor, log, select, sin, sqrt, tanh

a, b = sp.symbols("a b", real=True)
CASES = {
    "arithmetic": (lambda a, b: (a - 3.0 * b) * a / (b + a * a) - (-a), (a - 3 * b) * a / (b + a**2) + a),
    "functions": (
        lambda a, b: sin(a * b) + cos(a / b) * exp(-a) + log(a + b) - atan(b) * tanh(a) + sqrt(a),
        sp.sin(a * b) + sp.cos(a / b) * sp.exp(-a) + sp.log(a + b) - sp.atan(b) * sp.tanh(a) + sp.sqrt(a),
    ),
    "cases": (lambda a, b: select(a < b, a * a, b * a) + abs(a - b) + floor(a) * b,
              sp.Piecewise((a**2, a < b), (a * b, True)) + sp.Abs(a - b) + sp.floor(a) * b),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_slopes_are_the_derivatives(name):
    write, expr = CASES[name]
    builder = Builder()
    result = write(builder.leaf("input", 0, "f64"), builder.leaf("state", 0, "f64"))
    at = np.random.default_rng(3).uniform(0.3, 2.7, (2, 9))
    given, directions = {("input", 0): at[0], ("state", 0): at[1]}, [("input", 0), ("state", 0)]
    values, slopes = tangents(builder.instructions, [result.id], given, directions, 9)
    whole = expr.subs(sp.floor(a), 0) if name != "cases" else expr
    assert values[0] == pytest.approx(np.array([float(whole.subs({a: p, b: q})) for p, q in at.T]), rel=1e-12)
    for k, variable in enumerate((a, b)):
        # a step function has slope zero
        d = expr.xreplace({sp.floor(a): sp.Symbol("held")}).diff(variable).xreplace({sp.Symbol("held"): sp.floor(a)})
        expected = [float(d.subs({a: p, b: q}).evalf()) for p, q in at.T]
        assert slopes[0, k] == pytest.approx(np.array(expected), rel=1e-11, abs=1e-13)


def test_what_does_not_move_has_no_slope():
    """A constant, a leaf that is no direction, and whole numbers."""
    builder = Builder()
    x, p = builder.leaf("input", 0, "f64"), builder.leaf("param", 0, "f64")
    count = builder.emit("itof", builder.leaf("state", 0, "i32"), type="f64")
    results = [builder.const(2.0), p * p, count * 2.0, x * count]
    leaves = {("input", 0): 3.0, ("param", 0): 4.0, ("state", 0): 5}
    values, slopes = tangents(builder.instructions, [r.id for r in results], leaves, [("input", 0)], 1)
    assert values[:, 0].tolist() == [2.0, 16.0, 10.0, 15.0]
    assert slopes[:, 0, 0].tolist() == [0.0, 0.0, 0.0, 5.0]
