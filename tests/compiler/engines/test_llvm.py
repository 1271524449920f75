"""Machine code gives the interpreter's bits: scalar, over lanes, in groups and continued."""

import gc
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import numpy as np
import pytest
from random_programs import PRIMITIVE, assert_same_bits, random_program, random_rows

from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.ir.operations import OPERATIONS
from hapticlab.compiler.ir.program import Block, Channel, Program
from hapticlab.compiler.ir.trace import Builder, cos, exp, floor, select, sin, sqrt

pytest.importorskip("llvmlite")
REALS = {"f32": ("f32",), "f64": ("f64",), "mixed": ("f32", "f64")}


def drive(program, seed, ticks, lanes):
    """Return seeded inputs (ticks, inputs) and parameters (parameters, lanes)."""
    rng = np.random.default_rng(seed)
    return random_rows(rng, program.inputs, ticks).T.copy(), random_rows(rng, program.parameters, lanes)


def one_block(real, names, body):
    """Return a program without inputs or states whose output is ``body`` of its parameters."""
    b = Builder(real)
    result = body(*(b.leaf("param", k, real) for k in range(len(names))))
    channels = tuple(Channel(n, "1", real) for n in names)
    nan = (float("nan"),) * len(names)
    return Program("one", (), channels, (), (Channel("y", "1", real),), Block(), b.block([result]), 1e-3, nan)


@pytest.mark.parametrize("reals", REALS)
@pytest.mark.parametrize("seed", range(30))
@pytest.mark.always("3-f32", "3-f64", "27-mixed")
def test_a_random_program_gives_the_interpreters_bits_in_every_shape(seed, reals):
    operations = tuple(OPERATIONS) if seed % 3 == 0 else PRIMITIVE
    program = random_program(seed, REALS[reals], operations=operations)
    lanes = (2, 15, 16, 17, 33)[seed % 5]
    inputs, parameters = drive(program, seed, 12, lanes)
    fast, slow = load(program, "llvm"), load(program, "interpreter")
    together, reference = fast.run(12, inputs, parameters), slow.run(12, inputs, parameters)
    assert_same_bits(together.outputs, reference.outputs)
    assert_same_bits(together.states, reference.states)
    for lane in (0, lanes // 2, lanes - 1):
        alone = fast.run(12, inputs, parameters[:, lane])
        assert_same_bits(alone.outputs[..., 0], reference.outputs[..., lane])
        assert_same_bits(alone.states[:, 0], reference.states[:, lane])


@pytest.mark.parametrize("lanes", [1, 3, 20])
def test_groups_keep_their_last_tick_and_a_run_continues_where_it_ended(lanes):
    program = random_program(3)
    inputs, parameters = drive(program, 3, 17, lanes)
    engine = load(program, "llvm")
    whole = engine.run(17, inputs, parameters)
    assert_same_bits(engine.run(17, inputs, parameters, every=5).outputs, whole.outputs[4::5])
    assert engine.run(4, inputs[:4], parameters, every=5).outputs.shape == (0, len(program.outputs), lanes)
    first = engine.run(7, inputs[:7], parameters)
    rest = engine.run(10, inputs[7:], parameters, states=first.states)
    assert_same_bits(rest.outputs, whole.outputs[7:])
    assert_same_bits(rest.states, whole.states)


@pytest.mark.parametrize("real, a, c", [("f64", 1 + 2.0**-30, -1.0 - 2.0**-29), ("f32", 1 + 2.0**-13, -1.0 - 2.0**-12)])
@pytest.mark.parametrize("lanes", [1, 16])
def test_a_product_is_rounded_before_it_is_added(real, a, c, lanes):
    program = one_block(real, "abc", lambda a, b, c: a * b + c)
    contracted = float(Fraction(a) * Fraction(a) + Fraction(c))
    assert contracted == 2.0 ** (-60 if real == "f64" else -26)  # what one rounding would leave
    result = load(program, "llvm").run(1, parameters=np.array([[a], [a], [c]]) * np.ones(lanes)).outputs
    assert (result == 0.0).all()


@pytest.mark.parametrize("lanes", [1, 16])
@pytest.mark.parametrize("real, tiny", [("f64", 2.0**-1022), ("f32", 2.0**-126)])
def test_denormals_are_kept(real, tiny, lanes):
    program = one_block(real, "ab", lambda a, b: a * b - a * 0.25)
    result = load(program, "llvm").run(1, parameters=np.array([[tiny], [0.5]]) * np.ones(lanes)).outputs
    assert (result == tiny * 0.25).all()


@pytest.mark.parametrize("lanes", [1, 17])
def test_infinities_nan_and_signed_zeros_follow_ieee(lanes):
    cases = [
        (lambda a, b: a / b, (1.0, -0.0), -np.inf),
        (lambda a, b: a - b, (np.inf, np.inf), np.nan),
        (lambda a, b: select(a < b, a, b), (-0.0, 0.0), 0.0),  # not less, so the second
        (lambda a, b: sqrt(a) + b, (-0.0, -0.0), -0.0),
        (lambda a, b: floor(a) * b, (-0.5, 1.0), -1.0),
        (lambda a, b: sqrt(a) * b, (-1.0, 0.0), np.nan),
    ]
    for body, (a, b), expected in cases:
        result = load(one_block("f64", "ab", body), "llvm").run(1, parameters=np.array([[a], [b]]) * np.ones(lanes))
        assert_same_bits(result.outputs, np.full((1, 1, lanes), expected))


@pytest.mark.parametrize("real, bias", [("f32", 127), ("f64", 1023)])
@pytest.mark.parametrize("lanes", [1, 16])
def test_powers_of_two_come_from_the_exponent_field_within_the_normal_range(real, bias, lanes):
    def run(op, value):
        program = one_block(real, "a", lambda a: a.builder.emit(op, a))
        return load(program, "llvm").run(1, parameters=np.full((1, lanes), value)).outputs

    for k in (-bias - 5, 1 - bias, -3, 0, 7, bias, bias + 5):
        power = 2.0 ** min(max(k, 1 - bias), bias)
        assert (run("exp2i", k) == power).all()
        assert (run("exponent", power * 1.5) == np.log2(power)).all()
    assert (run("exp2i", np.inf) == 2.0**bias).all() and (run("exp2i", -np.inf) == 2.0 ** (1 - bias)).all()


def test_a_program_may_have_no_inputs_parameters_or_states():
    b = Builder("f64")
    program = Program("bare", (), (), (), (Channel("y", "1", "f64"),), Block(), b.block([b.const(2.5)]), 1e-3)
    for engine in ("llvm", "interpreter"):
        result = load(program, engine).run(3)
        assert result.outputs.tolist() == [[[2.5]]] * 3 and result.states.shape == (0, 1)
        assert load(program, engine).run(2, parameters=np.empty((0, 20))).outputs.shape == (2, 1, 20)


@pytest.mark.parametrize("size", [20, 300, 900])
@pytest.mark.always("20", "300")
def test_the_number_of_lanes_stepped_together_changes_no_bit(size):
    program = random_program(size, reals=("f64",), size=size)
    inputs, parameters = drive(program, size, 5, 70)
    together = load(program, "llvm").run(5, inputs, parameters)
    reference = load(program, "interpreter").run(5, inputs, parameters)
    assert_same_bits(together.outputs, reference.outputs)
    assert_same_bits(together.states, reference.states)


@pytest.mark.wide
def test_many_engines_and_threads_share_nothing():
    program = random_program(11)
    inputs, parameters = drive(program, 11, 50, 40)
    engines = [load(program, "llvm") for _ in range(3)]
    reference = load(program, "interpreter").run(50, inputs, parameters)
    del engines[1]
    gc.collect()
    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(lambda k: engines[k % 2].run(50, inputs, parameters), range(16)))
    for result in results:
        assert_same_bits(result.outputs, reference.outputs)
        assert_same_bits(result.states, reference.states)


@pytest.mark.wide
def test_engines_in_a_cycle_are_collected_code_first():
    for seed in range(4):  # a context freed before its code crashed at once
        program = random_program(seed)
        inputs, parameters = drive(program, seed, 3, 1)
        held = [load(program, "llvm")]
        held[0].run(3, inputs, parameters)
        held.append(held)
        del held
        assert gc.collect() > 0


@pytest.mark.parametrize("real", ["f32", "f64"])
@pytest.mark.parametrize("count", [1, 2, 5, 9, 17])
@pytest.mark.always("2-*")
def test_functions_side_by_side_give_the_bits_of_one_alone(real, count):
    """Vectors of 1, 2, 8 and 8 + 1 or 16 + 1 lanes; a sine of a sine waits for it; one angle is asked for twice."""

    def chained(*angles):
        inner = [sin(a) * 3.0 for a in angles]
        return sum((cos(a) + sin(b) + exp(b) for a, b in zip(angles, inner, strict=True)), cos(inner[0]))

    program = one_block(real, [f"a{k}" for k in range(count)], chained)
    rows = np.random.default_rng(count).uniform(-40, 40, (20, count))
    rows[0], rows[1, 0] = 0.0, np.inf
    fast, slow = load(program, "llvm"), load(program, "interpreter")
    for row in rows:
        assert_same_bits(fast.run(1, parameters=row).outputs, slow.run(1, parameters=row).outputs)
