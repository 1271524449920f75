"""Tracing records what plain arithmetic computes; each simplification is the same number, exceptions named."""

import math

import numpy as np
import pytest
from random_programs import HARD, PRIMITIVE, assert_same_bits, random_program, random_rows

from hapticlab.compiler.engines.interpreter import evaluate
from hapticlab.compiler.ir import trace
from hapticlab.compiler.ir.program import Instruction
from hapticlab.compiler.ir.trace import NUMPY_TYPE, Builder, cast, clip, equal, maximum, minimum, select
from hapticlab.errors import ProgramError

ONE = {"f32": 2.0**-23, "f64": 2.0**-52}


def traced(body, real="f64", count=1):
    """Return the block of ``body`` applied to ``count`` inputs."""
    b = Builder(real)
    return b.block([body(*(b.leaf("input", k, real) for k in range(count)))])


def run(block, *values, real="f64"):
    with np.errstate(all="ignore"):
        return evaluate(block, input=[np.array(v, NUMPY_TYPE[real]) for v in values])[0][0]


def operations(block):
    return [i.op for i in block.instructions if i.op not in ("const", "input")]


# body, what it leaves, and the values it is not exact for (None: exact for all)
EXACT = [
    (lambda x: x - 0.0, []),
    (lambda x: x * 1.0, []),
    (lambda x: x * -1.0, ["neg"]),
    (lambda x: -(-x), []),  # noqa: B002
    (lambda x: x / 4.0, ["mul"]),
    (lambda x: x / -(2.0**99), ["mul"]),
    (lambda x: x / 2.0**-99, ["mul"]),
    (lambda x: x / 3.0, ["div"]),
    (lambda x: x / 2.0**-130, ["div"]),  # its reciprocal overflows float32
    (lambda x: 2.5 - (-x), ["add"]),
    (lambda x: 2.5 + (-x), ["sub"]),
    (lambda x: (-x) + 2.5, ["sub"]),
    (lambda x: (-x) * (-x), ["mul"]),
    (lambda x: select(x < 1.0, x, x), []),
]


@pytest.mark.parametrize("real", ["f32", "f64"])
@pytest.mark.parametrize("body, left", EXACT)
def test_an_exact_simplification_gives_the_bits_of_plain_arithmetic(body, left, real):
    block = traced(body, real)
    assert operations(block) == left
    with np.errstate(all="ignore"):
        x = np.array(HARD, NUMPY_TYPE[real])
        assert_same_bits(run(block, x, real=real), body(x))


@pytest.mark.parametrize(
    "body, left, here, there",
    [
        (lambda x: x + 0.0, [], -0.0, -0.0),  # IEEE: +0
        (lambda x: 0.0 - x, ["neg"], 0.0, -0.0),  # IEEE: +0
        (lambda x: x * 0.0, [], math.nan, 0.0),  # IEEE: nan; a structural zero is no term at all
        (lambda x: 0.0 / x, [], 0.0, 0.0),  # IEEE: nan
    ],
)
def test_the_documented_exceptions_are_signed_zeros_and_structural_zeros(body, left, here, there):
    block = traced(body)
    assert operations(block) == left
    assert_same_bits(np.float64(run(block, here)), np.float64(there))
    finite = np.array([v for v in HARD if math.isfinite(v) and v != 0])
    assert_same_bits(np.abs(np.broadcast_to(run(block, finite), finite.shape)), np.abs(body(finite)))


def test_conditions_simplify():
    b = Builder()
    c = b.leaf("input", 0, "f64") < 1.0
    true, false = b.const(True), b.const(False)
    assert (c & true).id == (c & c).id == (c | false).id == (~~c).id == c.id
    assert (c & false).constant is False and (true | c).constant is True
    assert select(true, 2.0, 3.0).constant == 2.0 and select(false, 2.0, 3.0).constant == 3.0


@pytest.mark.parametrize("real", ["f32", "f64"])
def test_constants_fold_in_the_precision_of_the_program(real):
    b = Builder(real)
    third = b.const(1.0) / b.const(3.0)
    assert third.constant == NUMPY_TYPE[real](1) / NUMPY_TYPE[real](3)
    assert (b.const(1.0) + ONE[real] / 2).constant == 1.0 and (b.const(1.0) + ONE[real]).constant > 1.0
    assert (b.const(0.0) / b.const(0.0)).constant != 0.0  # nan, folded without a warning
    assert math.copysign(1, (b.const(-0.0) * b.const(2.0)).constant) == -1
    assert b.const(0.0).id != b.const(-0.0).id and b.const(math.nan).id == b.const(math.nan).id


def test_equal_values_are_numbered_once_and_unneeded_ones_dropped():
    def body(x, y):
        _unused = trace.sqrt(x)
        return (x + y) * (y + x) + (x - y)

    assert operations(traced(body, count=2)) == ["add", "mul", "sub", "add"]


@pytest.mark.parametrize(
    "body",
    [
        lambda x, y: clip(x, -0.5, y),
        lambda x, y: minimum(x, y) - maximum(y, x),
        lambda x, y: select(equal(x, y) | (x >= 2 * y), abs(x), 1 / y),
        lambda x, y: select(~(x > y) & (y <= 3.0), trace.floor(x), trace.sqrt(abs(y)) * 7 - x),
    ],
)
def test_one_text_computes_on_numbers_arrays_and_traced_values(body):
    x, y = np.random.default_rng(5).normal(size=(2, 50)).round(1)
    block = traced(body, count=2)
    with np.errstate(all="ignore"):
        on_arrays = body(x, y)
        one_by_one = [body(a, b) for a, b in zip(x, y, strict=True)]
    assert_same_bits(run(block, x, y), on_arrays)
    assert_same_bits(one_by_one, on_arrays)


@pytest.mark.parametrize("seed", range(5))
def test_inlining_a_block_changes_no_result(seed):
    program = random_program(seed, reals=("f64",), operations=[op for op in PRIMITIVE if op not in ("mul", "div", "add", "sub")])
    b = Builder()
    here = {
        kind: [b.leaf(kind, k, c.type) for k, c in enumerate(channels)]
        for kind, channels in (("input", program.inputs), ("param", program.parameters), ("state", program.states))
    }
    outputs, states = b.inline(program.tick, **here)
    copy = b.block(outputs, states)
    assert len(copy) <= len(program.tick)
    rng = np.random.default_rng(seed)
    rows = {
        kind: [row.astype(NUMPY_TYPE[c.type]) for row, c in zip(random_rows(rng, channels, 9), channels, strict=True)]
        for kind, channels in (("input", program.inputs), ("param", program.parameters), ("state", program.states))
    }
    with np.errstate(all="ignore"):
        for mine, theirs in zip(evaluate(copy, **rows), evaluate(program.tick, **rows), strict=True):
            for a, b in zip(mine, theirs, strict=True):
                assert_same_bits(np.broadcast_to(a, 9), np.broadcast_to(b, 9))


def test_inlining_replaces_leaves_and_casts_them():
    inner = traced(lambda x: x * 3.0, real="f32")
    b = Builder("f64")
    (result,), _ = b.inline(inner, input=[b.leaf("input", 0, "f64") + 1.0])
    block = b.block([cast(result, "f64")])
    assert operations(block) == ["add", "cast", "mul", "cast"]
    assert run(block, 0.1) == np.float64(np.float32(0.1 + 1.0) * np.float32(3.0))


def test_what_cannot_be_traced_is_refused_in_words():
    b = Builder()
    x, y = b.leaf("input", 0, "f64"), b.leaf("input", 1, "f32")
    with pytest.raises(ProgramError, match=r"write select\(condition, a, b\) instead of if"):
        bool(x < 1)
    with pytest.raises(ProgramError, match="add of f64, f32: cast one of them first"):
        x + y


def test_a_numpy_number_on_the_left_is_traced_too():
    block = traced(lambda x: np.float64(2.5) - x)
    assert operations(block) == ["sub"] and run(block, 1.0) == 1.5
    assert Instruction("const", (), "f64", value=2.5) in block.instructions
