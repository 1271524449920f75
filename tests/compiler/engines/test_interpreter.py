"""The reference engine against arithmetic done by hand with Python's own floats and the math module."""

import math
import struct

import numpy as np
import pytest

from hapticlab.compiler.engines.interpreter import Interpreter, evaluate
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
from hapticlab.compiler.ir.trace import NUMPY_TYPE, Builder, floor, select

pytestmark = pytest.mark.interpreter


def apply(op, type, *operands, result=None):
    """Evaluate one instruction on numbers of a type."""
    code = [Instruction("input", (), type, index=k) for k in range(len(operands))]
    code.append(Instruction(op, tuple(range(len(operands))), result or type))
    leaves = [np.array([v], NUMPY_TYPE[type]) for v in operands]
    with np.errstate(all="ignore"):
        return evaluate(Block(tuple(code), outputs=(len(operands),)), input=leaves)[0][0][0]


def decay(type="f64"):
    """s' = s/2 + k x, output s; init s = 8 x."""
    b = Builder(type)
    init = b.block(states=[b.leaf("input", 0, type) * 8.0])
    b = Builder(type)
    x, k, s = (b.leaf(op, 0, type) for op in ("input", "param", "state"))
    tick = b.block([s], [s * 0.5 + k * x])
    names = ((Channel(n, "1", type),) for n in ("x", "k", "s", "F"))
    return Program("decay", *names, init, tick, 1e-3, (3.0,))


def test_states_start_from_init_and_feed_back():
    inputs = np.array([1.0, 2.0, -1.0, 0.5])
    outputs, states = Interpreter(decay()).run(4, inputs[:, None], np.array([[3.0]]))
    s, expected = 8.0, []
    for x in inputs:
        expected.append(s)
        s = s / 2 + 3 * x
    assert outputs[:, 0, 0].tolist() == expected == [8.0, 7.0, 9.5, 1.75]
    assert states.tolist() == [[s]]


def test_every_keeps_the_last_tick_of_each_whole_group():
    inputs = np.arange(7.0)[:, None]
    engine = Interpreter(decay())
    whole, _ = engine.run(7, inputs, np.array([[3.0]]))
    grouped, _ = engine.run(7, inputs, np.array([[3.0]]), every=3)
    assert grouped.tolist() == whole[[2, 5]].tolist()


def test_a_run_continues_where_another_ended():
    inputs = np.sin(np.arange(9.0))[:, None]
    engine, k = Interpreter(decay("f32")), np.array([[0.1, 0.7]])
    whole, end = engine.run(9, inputs, k)
    first, states = engine.run(4, inputs[:4], k)
    rest, last = engine.run(5, inputs[4:], k, states=states)
    assert np.concatenate([first, rest]).tolist() == whole.tolist()
    assert last.tolist() == end.tolist()


def test_lanes_are_independent():
    inputs = np.cos(np.arange(5.0))[:, None]
    engine, k = Interpreter(decay("f32")), np.array([[0.1, -2.0, 1e20]])
    together, _ = engine.run(5, inputs, k)
    for lane in range(3):
        alone, _ = engine.run(5, inputs, k[:, lane : lane + 1])
        assert together[..., lane].tolist() == alone[..., 0].tolist()


def test_float32_rounds_every_result():
    b = Builder("f32")
    x = b.leaf("input", 0, "f32")
    p = Program("p", (Channel("x"),), (), (), (Channel("F"),), Block(), b.block([x * x + 1.0]), 1e-3)
    to_single = lambda v: struct.unpack("f", struct.pack("f", v))[0]  # noqa: E731
    outputs, _ = Interpreter(p).run(1, np.array([[0.1]]), np.empty((0, 1)))
    assert outputs[0, 0, 0] == to_single(to_single(to_single(0.1) ** 2) + 1.0) != 0.1**2 + 1.0


@pytest.mark.parametrize("type, least, most", [("f32", -126, 127), ("f64", -1022, 1023)])
def test_exp2i_is_a_power_of_two_held_within_the_normal_exponents(type, least, most):
    for k in (least, least + 1, -1, 0, 1, most - 1, most):
        assert apply("exp2i", type, float(k)) == math.ldexp(1.0, k)
    assert apply("exp2i", type, -1e30) == apply("exp2i", type, -np.inf) == math.ldexp(1.0, least)
    assert apply("exp2i", type, 1e30) == apply("exp2i", type, np.inf) == math.ldexp(1.0, most)
    assert apply("exp2i", type, np.nan) == 1.0


@pytest.mark.parametrize("type", ["f32", "f64"])
def test_exponent_is_that_of_frexp(type):
    for value in (1.0, 1.999, 2.0, 0.75, 3e-30, 7e30):
        assert apply("exponent", type, value) == math.frexp(value)[1] - 1


def test_floor_and_comparisons_keep_ieee_edges():
    assert [str(apply("floor", "f32", v)) for v in (-0.0, -0.5, 2.5, -2.5)] == ["-0.0", "-1.0", "2.0", "-3.0"]
    assert not apply("lt", "f32", np.nan, 1.0, result="bool")
    assert not apply("eq", "f32", np.nan, np.nan, result="bool")
    assert apply("eq", "f32", 0.0, -0.0, result="bool")
    assert apply("div", "f32", 1.0, -0.0) == -np.inf


def test_int32_counts_wrap_around():
    assert apply("iadd", "i32", 2**31 - 1, 1) == -(2**31)
    assert apply("itof", "i32", 2**24 + 1, result="f32") == 2.0**24  # to the nearest, ties to even


def test_an_unselected_arm_does_not_reach_the_output():
    b = Builder("f64")
    x = b.leaf("input", 0, "f64")
    tick = b.block([select(0.0 < x, 1.0 / x, floor(x))])
    p = Program("p", (Channel("x", "1", "f64"),), (), (), (Channel("F", "1", "f64"),), Block(), tick, 1e-3)
    outputs, _ = Interpreter(p).run(2, np.array([[0.0], [4.0]]), np.empty((0, 1)))
    assert outputs[:, 0, 0].tolist() == [0.0, 0.25]


def test_a_nan_constant_is_a_constant_like_any_other():
    b = Builder("f32")
    nan, x = b.const(float("nan")), b.leaf("input", 0, "f32")
    assert nan.id == b.const(float("nan")).id != b.const(float("inf")).id
    assert b.const(0.0).id != b.const(-0.0).id
    assert math.isnan((nan + 1.0).constant)
    assert (select(nan < 1.0, x, nan)).id == nan.id  # the comparison folds to false
    assert (x + nan).constant is None
