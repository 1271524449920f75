"""The builder of derivatives against the plain one: the same numbers, in fewer operations."""

import math
from fractions import Fraction

import numpy as np
import pytest

from hapticlab.compiler.algebra.derivative_builder import Algebra
from hapticlab.compiler.ir.operations import OPERATIONS
from hapticlab.compiler.ir.program import LEAVES
from hapticlab.compiler.ir.trace import Builder, cos, sin

RULES = (
    lambda a, b, c: a + b, lambda a, b, c: a - b, lambda a, b, c: a * b, lambda a, b, c: -a, lambda a, b, c: c * a,
    lambda a, b, c: a + c, lambda a, b, c: a * a - c * b, lambda a, b, c: c * (c * b),
)  # fmt: skip


def random_expressions(leaves, seed, number):
    """Return random sums of products, with constants, signs and shared factors, of values or of exact numbers."""
    random, found = np.random.default_rng(seed), [*leaves]
    for _ in range(40):
        a, b = random.integers(len(found), size=2)
        c = number(float(random.choice([-3, -1, -0.5, -0.25, 0.25, 0.5, 1, 2, 3])))
        found.append(RULES[random.integers(len(RULES))](found[a], found[b], c))
    return found[-6:]


def numbers(block, at):
    """Return the outputs of a block in plain NumPy."""
    done = []
    for i in block.instructions:
        known = i.value if i.op == "const" else at[i.index] if i.op == "input" else None
        done.append(OPERATIONS[i.op].compute(*(done[a] for a in i.args)) if known is None else known)
    return [float(done[k]) for k in block.outputs]


@pytest.mark.parametrize("seed", range(40))
def test_the_numbers_of_random_expressions(seed):
    at = [Fraction(int(k)) for k in np.random.default_rng(seed).integers(-3, 4, size=4)]
    exact = random_expressions(at, seed, Fraction)
    builder = Algebra("f64")
    values = random_expressions([builder.leaf("input", k, "f64") for k in range(4)], seed, float)
    # 40 operations of integers and quarters; where a product is long it rounds
    assert numbers(builder.block(values), [*map(float, at)]) == pytest.approx([*map(float, exact)], rel=1e-13, abs=1e-13)


def count(make, builder):
    leaves = [builder.leaf("input", k, "f64") for k in range(4)]
    return [i.op for i in builder.block([make(*leaves)]).instructions if i.op not in LEAVES]


@pytest.mark.parametrize(
    "make, ops",
    [
        (lambda a, b, c, d: 0.5 * a * (2.0 * b), ["mul"]),
        (lambda a, b, c, d: -a * -b, ["mul"]),
        (lambda a, b, c, d: a * d + b * d + c * d, ["add", "add", "mul"]),
        (lambda a, b, c, d: a * d - 3.0 * (d * a), ["mul", "mul"]),
        (lambda a, b, c, d: a * b - b * a, []),
        (lambda a, b, c, d: -a - b, ["add", "neg"]),
        (lambda a, b, c, d: -2.0 * a + 3.0 * b, ["mul", "mul", "sub"]),
        (lambda a, b, c, d: 2.0 * a - 2.0 * b, ["sub", "mul"]),
        (lambda a, b, c, d: (a + 1.0) - 1.0, ["add", "sub"]),
        (lambda a, b, c, d: a * sin(d) * (sin(d) * b) + cos(d) * (b * (a * cos(d))), ["mul"]),
        (lambda a, b, c, d: sin(d) * sin(d) + cos(d) * cos(d), []),
        (lambda a, b, c, d: -0.5 * (a * cos(d) * cos(d)) - 0.5 * (sin(d) * (a * sin(d))), ["mul"]),
        (lambda a, b, c, d: a * sin(d) * sin(d) + a * cos(c) * cos(c), ["sin", "mul", "mul", "cos", "mul", "mul", "add"]),
    ],
)
def test_what_is_left_of(make, ops):
    assert sorted(count(make, Algebra("f64"))) == sorted(ops)
    assert len(count(make, Builder("f64"))) >= len(ops)


def test_other_operations_pass():
    builder = Algebra("f64")
    a, b = (builder.leaf("input", k, "f64") for k in range(2))
    block = builder.block([abs(a / b) + math.pi])
    assert numbers(block, [-3.0, 2.0]) == [1.5 + math.pi]
