"""Encoding: limits, registers, moves that happen at once, and C headers that agree with the Python tables."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from encoded import is_sound
from random_programs import random_program

from hapticlab.compiler.boards.c_headers import generate
from hapticlab.compiler.engines.bytecode import OPCODES, RESULTS, _in_sequence, disassemble, encode, layout
from hapticlab.compiler.ir.operations import OPERATIONS
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
from hapticlab.compiler.ir.trace import Builder
from hapticlab.errors import ProgramError, ProgramLimitError

FIRMWARE = Path(__file__).parents[3] / "firmware"


def chain(length, type="f32", kept=False):
    """Add the input to itself again and again; ``kept`` makes an output of every sum."""
    b = Builder(type)
    x = total = b.leaf("input", 0, type)
    sums = []
    for _ in range(length):
        total = b.emit("div", total, x)
        sums.append(total)
    outputs = sums if kept else [total]
    names = tuple(Channel(f"y{k}", "1", type) for k in range(len(outputs)))
    return Program("chain", (Channel("x", "1", type),), (), (), names, Block(), b.block(outputs), 1e-3)


def test_every_operation_of_the_ir_but_cast_has_its_own_number():
    assert set(OPCODES) == set(OPERATIONS) - {"cast"}  # one real type: there is nothing to cast
    assert len(set(OPCODES.values())) == len(OPCODES)
    assert min(OPCODES.values()) > 0
    assert max(OPCODES.values()) < 256


def test_the_numbers_never_change():
    """A board in a drawer has these; a new operation is added at the end."""
    text = ",".join(f"{name}={number}" for name, number in sorted(OPCODES.items(), key=lambda item: item[1]))
    assert text.startswith(
        "neg=1,abs=2,add=3,sub=4,mul=5,div=6,sqrt=7,floor=8,lt=9,le=10,eq=11,and=12,or=13,not=14,select=15,"
        "sin=16,cos=17,exp=18,log=19,atan=20,tanh=21,exp2i=22,exponent=23,iadd=24,itof=25"
    )
    assert {number for number, _ in RESULTS.values()} == set(range(len(RESULTS)))


@pytest.mark.parametrize("name", ["opcodes.h", "elementary.h", "elementary.c"])
def test_the_generated_files_are_fresh(name):
    assert (FIRMWARE / "generated" / name).read_text() == generate()[name], "run python -m hapticlab.compiler.boards.c_headers"


def test_a_long_chain_needs_one_temporary():
    assert layout(encode(chain(300), word_bits=8)).size["registers"] == 2


def test_what_is_output_keeps_its_register():
    size = layout(encode(chain(50, kept=True))).size
    assert size["registers"] == 51


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("word_bits", [8, 16])
def test_random_programs_are_sound_when_read_independently(seed, word_bits):
    assert is_sound(encode(random_program(seed, ("f32",), 100, tuple(OPCODES)), word_bits=word_bits))


@pytest.mark.parametrize("size", range(1, 6))
@pytest.mark.always("[1-4]")
def test_moves_in_sequence_are_the_moves_at_once(size):
    spare, outside = 90, (50, 51)
    for sources in product([*range(size), *outside], repeat=size):
        values = {r: f"value of {r}" for r in [*range(size), *outside]}
        expected = {to: values[source] for to, source in enumerate(sources)}
        for to, source in _in_sequence(dict(enumerate(sources)), spare):
            values[to] = values[source]
        assert {to: values[to] for to in range(size)} == expected


def test_a_program_past_8_bit_registers_is_refused_by_how_much():
    p = chain(300, kept=True)
    with pytest.raises(ProgramLimitError, match="301 registers; an 8-bit word numbers 256, 45 too many: use fewer"):
        encode(p, word_bits=8)
    assert layout(encode(p)).size["registers"] == 301


def test_a_program_past_the_length_is_refused_by_how_much():
    with pytest.raises(ProgramLimitError, match=r"80001 tick_words; a program holds 65535, 14466 too many"):
        encode(chain(20_000))


def test_float64_and_odd_words_are_refused():
    with pytest.raises(ProgramError, match='takes dtype="float32" alone'):
        encode(chain(2, "f64"))
    with pytest.raises(ProgramError, match="word_bits = 12; needs 8 or 16"):
        encode(chain(2), word_bits=12)


def test_equal_constants_share_a_register_but_not_zeros_of_two_signs():
    x, values = Instruction("input", (), "f32"), (0.0, -0.0, float("nan"), 1.0)
    constants = [Instruction("const", (), "f32", value=v) for v in (*values, *values)]
    code = (x, *constants, *(Instruction("mul", (0, k + 1), "f32") for k in range(8)))
    names = tuple(Channel(f"y{k}") for k in range(8))
    p = Program("p", (Channel("x"),), (), (), names, Block(), Block(code, tuple(range(9, 17))), 1e-3)
    assert layout(encode(p)).size["constants"] == 4


def test_the_listing_names_every_instruction_constant_move_and_output():
    p = random_program(4, ("f32",), 60, tuple(OPCODES))
    text = disassemble(encode(p))
    size = layout(encode(p)).size
    computing = [i.op for block in (p.init, p.tick) for i in block.instructions if i.op in OPCODES]
    for op in set(computing):
        assert sum(line.split()[1] == op for line in text.splitlines() if line.startswith("  r")) == computing.count(op)
    assert text.count(" const ") == size["constants"]
    assert text.count(" next ") == size["init_moves"] + size["tick_moves"]
    assert text.count("  output ") == len(p.outputs)


def test_a_listing_of_something_else_is_refused():
    data = bytearray(encode(chain(2)))
    data[0] ^= 1
    with pytest.raises(ProgramError, match="not a program of this format"):
        disassemble(bytes(data))


def test_the_period_is_in_microseconds():
    assert layout(encode(chain(1))).period_us == 1000
    assert np.frombuffer(encode(chain(1)), "<u4", 1, 12)[0] == 1000
