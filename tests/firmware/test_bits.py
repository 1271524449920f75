"""Bits of the cross-compiled machine on the Uno and on Cortex-M, against NumPy's float32."""

import bare
import cortex
import numpy as np
import pico_emulator
import pytest
from bare import Avr, Bench
from cortex import Cortex
from measure_costs import awkward_bits
from pico_bench import Rp2040
from test_golden import GOLDEN, NAMES, array, program_of

from hapticlab.compiler.engines.interpreter import Interpreter
from hapticlab.compiler.ir.operations import OPERATIONS
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program

#: name -> why it is not here, and what makes it
BOARDS = {
    "uno": (bare.missing, Avr),
    "pico": (pico_emulator.missing, Rp2040),
    "cortex-m4f": (cortex.missing, lambda: Cortex("cortex-m4f", counting=False)),
}
NUMPY = {
    "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide, "sqrt": np.sqrt, "floor": np.floor,
    "neg": np.negative, "abs": np.abs, "lt": np.less, "le": np.less_equal, "eq": np.equal,
}  # fmt: skip
ELEMENTARY = ("sin", "cos", "exp", "log", "atan", "tanh", "exp2i", "exponent")
SMALLEST_NORMAL = np.finfo(np.float32).smallest_normal


@pytest.fixture(scope="module", params=BOARDS)
def processor(request):
    missing, make = BOARDS[request.param]
    reason = missing()
    if reason:
        pytest.skip(reason)
    return make()


def all_at_once(operations):
    """Return a program whose outputs are the operations on two inputs."""
    inputs = Channel("a"), Channel("b")
    code = [Instruction("input", (), "f32", index=k) for k in range(2)]
    for op in operations:
        kinds, result = OPERATIONS[op].operands, OPERATIONS[op].result
        code.append(Instruction(op, tuple(range(len(kinds))), {"R": "f32", "B": "bool"}[result]))
    outputs = tuple(Channel(op, "1", i.type) for op, i in zip(operations, code[2:], strict=True))
    return Program("all", inputs, (), (), outputs, Block(), Block(tuple(code), tuple(range(2, len(code)))), 1e-3)


def operands(count, seed):
    """Return pairs of float32: any bits; twins that cancel; and numbers of a scene, angles among them."""
    rng = np.random.default_rng(seed)
    a, b = awkward_bits(rng, count), awkward_bits(rng, count)
    twin = rng.random(count) < 0.25
    b = np.where(twin, a ^ (1 << rng.integers(0, 24, count)).astype(np.uint32) ^ np.uint32(1 << 31), b)
    any_bits = np.stack([a, b], axis=1).astype(np.uint32).view(np.float32)
    usual = (rng.normal(size=(count, 2)) * 10.0 ** rng.integers(-3, 3, (count, 2))).astype(np.float32)
    return np.where(rng.random((count, 1)) < 0.5, any_bits, usual)


def bits(a):
    """Return float32 bits, every nan the same."""
    a = np.asarray(a).astype(np.float32)
    return np.where(np.isnan(a), np.uint32(0x7FC00000), a.view(np.uint32))


def check(processor, count, seed):
    pairs = operands(count, seed)
    assert (np.abs(pairs[:, 0]) < SMALLEST_NORMAL).mean() > 0.02, "denormals belong to it"
    for group in (tuple(NUMPY), ELEMENTARY):
        program = all_at_once(group)
        with np.errstate(all="ignore"):
            found = Bench(program, processor).run(pairs.astype(float), init=False)[0]
            expected = _expected(group, pairs)
        for k, op in enumerate(group):
            same = bits(found[:, k]) == bits(expected[k])
            wrong = np.flatnonzero(~same)
            assert not wrong.size, f"{op}: {wrong.size} of {count}, first {pairs[wrong[0]]!r}: {found[wrong[0], k]!r}"


def _expected(group, pairs):
    if group is not ELEMENTARY:
        return [f(*pairs.T) if f.nin == 2 else f(pairs[:, 0]) for f in (NUMPY[op] for op in group)]
    code = [Instruction("param", (), "f32"), *(Instruction(op, (0,), "f32") for op in group)]
    outputs, last = tuple(Channel(op) for op in group), tuple(range(1, len(code)))
    program = Program("all", (), (Channel("a"),), (), outputs, Block(), Block(tuple(code), last), 1e-3, (0.0,))
    return Interpreter(program).run(1, np.empty((1, 0)), pairs[:, 0].astype(float)[None])[0][0]  # a lane an operand


def test_every_operation_gives_the_same_bits(processor):
    check(processor, 4000 if isinstance(processor, Avr) else 400, seed=1)


@pytest.mark.slow
def test_every_operation_gives_the_same_bits_over_100_000_operand_sets(processor):
    check(processor, 100_000, seed=2)


@pytest.mark.parametrize("g", GOLDEN, ids=NAMES)
def test_golden_programs_give_the_committed_bits(g, processor):
    program = program_of(g)
    ticks = len(g["given"]) // len(g["inputs"])
    outputs, states, _ = Bench(program, processor).run(array(g["given"], ticks, -1))
    for found, channels, expected in (
        (outputs.T, program.outputs, array(g["out"], ticks, -1).T), (states, program.states, array(g["end"], -1)),
    ):  # fmt: skip
        for row, channel, right in zip(found, channels, expected, strict=True):
            if channel.type == "f32":
                np.testing.assert_array_equal(bits(row), bits(right), err_msg=channel.name)
            else:
                np.testing.assert_array_equal(row, right, err_msg=channel.name)


@pytest.mark.skipif(bool(bare.missing()), reason=str(bare.missing()))
@pytest.mark.parametrize("op", ["add", "sub", "mul", "div"])
def test_the_arithmetic_of_the_uno_is_right_where_exponents_and_roundings_meet(op):
    """Every pair of powers of two with mantissas that tie, carry or cancel: firmware/boards/uno/float.S has a way for each."""
    mantissas = np.array([0, 1, 2, 0x400000, 0x7FFFFE, 0x7FFFFF], np.uint32)
    exponents = np.array([0, 1, 2, 23, 64, 100, 126, 127, 128, 129, 150, 152, 253, 254, 255], np.uint32)
    numbers = (exponents[:, None] << 23 | mantissas).ravel()
    a, b = (grid.ravel() for grid in np.meshgrid(numbers, numbers))
    rng = np.random.default_rng(4)
    exponent, apart = rng.integers(0, 256, (2, 6000))
    smaller = np.maximum(exponent - apart % 28, 0)
    pairs = np.stack(
        [np.r_[a, exponent << 23 | rng.choice(mantissas, 6000)], np.r_[b, smaller << 23 | rng.choice(mantissas, 6000)]]
    )
    pairs = (pairs | rng.integers(0, 2, pairs.shape) << 31).astype(np.uint32)
    with np.errstate(all="ignore"):
        expected = NUMPY[op](*pairs.view(np.float32))
    rows = np.ascontiguousarray(pairs[::-1].T, "<u4").view(np.uint8)  # b is in r18 to r21, a behind it
    found = Avr().rows(f"__{op}sf3", (), 18, rows, 22, 4)[0].view(np.float32)[:, 0]
    wrong = np.flatnonzero(bits(found) != bits(expected))
    assert not wrong.size, f"{wrong.size} of {len(rows)}, first {pairs.view(np.float32)[:, wrong[0]]}: {found[wrong[0]]!r}"
