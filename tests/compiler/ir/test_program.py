"""A program that verifies can neither loop nor read out of bounds; every kind of damage is named."""

from dataclasses import replace

import pytest
from random_programs import random_program

import hapticlab as hl
from hapticlab.compiler.ir.operations import OPERATIONS
from hapticlab.compiler.ir.program import LEAVES, TYPES, Block, Channel, Instruction, Program
from hapticlab.errors import ProgramError

X = Instruction("input", (), "f32", index=0)
K = Instruction("param", (), "f32", index=0)
TWO = Instruction("const", (), "f32", value=2.0)


def program(*code, outputs=None, states=(), init=Block(), channels=()):  # noqa: B008
    """Return x [m], k [N/m] -> F [N] with this tick after the leaves x, k, 2."""
    code = (X, K, TWO, *code)
    outputs = (len(code) - 1,) if outputs is None else outputs
    return Program(
        "p", (Channel("x", "m"),), (Channel("k", "N/m"),), channels, (Channel("F", "N"),),
        init, Block(code, outputs, states), 1e-3, (150.0,),
    )  # fmt: skip


def op(name, *args, type="f32", **more):
    return Instruction(name, args, type, **more)


@pytest.mark.parametrize(
    "code, complaint",
    [
        ([op("mul", 0, 4), op("add", 0, 1)], "operand 4 is not an earlier result"),
        ([op("mul", 0, 3)], "operand 3 is not an earlier result"),
        ([op("mul", 0, -1)], "operand -1 is not an earlier result"),
        ([op("mul", 0, 1.0)], "operand 1.0 is not an earlier result"),
        ([op("mul", 0)], "needs 2 operands, has 1"),
        ([op("neg", 0, 1)], "needs 1 operands, has 2"),
        ([op("pow", 0, 1)], "no such operation"),
        ([op("add", 0, 1, type="f16")], "'f16' is not a type"),
        ([op("add", 0, 1, type="f64")], "gives f64 from f32, f32"),
        ([op("add", 0, 1, type="bool")], "gives bool from f32, f32"),
        ([op("lt", 0, 1)], "gives f32 from f32, f32"),
        ([op("select", 0, 1, 2)], "takes BRR, was given f32, f32, f32"),
        ([op("not", 0, type="bool")], "takes B, was given f32"),
        ([op("cast", 0)], "casts a type to itself"),
        ([op("cast", 0, type="f64"), op("add", 0, 3)], "gives f32 from f32, f64"),
        ([op("input", index=1)], "there is no input 1 here"),
        ([op("param", index=-1)], "there is no param -1 here"),
        ([op("state", index=0)], "there is no state 0 here"),
        ([op("input", index=0, type="f64")], "input 0 is not f64"),
        ([op("const", value="2")], "its value is not a number"),
        ([op("const", value=None)], "its value is not a number"),
        ([op("const", value=2j)], "its value is not a number"),
        ([op("const", value=0.1)], "0.1 is not a f32; its nearest is 0.10000000149011612"),
        ([op("const", value=1e300)], "1e+300 is not a f32; its nearest is inf"),
        ([op("const", value=1e-50)], "1e-50 is not a f32; its nearest is 0.0"),
        ([op("const", value=2**24 + 1)], "16777217 is not a f32; its nearest is 16777216.0"),
        (
            [op("const", value=2**53 + 1, type="f64")],
            "9007199254740993 is not a f64; its nearest is 9007199254740992.0",
        ),
        ([op("const", value=2**2000)], f"{str(2**2000)[:40]} is not a f32; its nearest is inf"),
        ([op("const", value=1.5, type="i32")], "1.5 is not an int32"),
        ([op("const", value=2**40, type="i32")], "1099511627776 is not an int32"),
        ([op("const", value=2**31, type="i32")], "2147483648 is not an int32"),
        ([op("const", value=float("nan"), type="i32")], "nan is not an int32"),
        ([op("const", value=True, type="i32")], "True is not an int32"),
        ([op("const", value=2, type="bool")], "2 is not True or False"),
        ([op("const", value=0.0, type="bool")], "0.0 is not True or False"),
        ([op("const", type=[])], "[] is not a type"),
        ([Instruction("neg", None, "f32")], "its operands are None; needs a tuple of positions"),
        ([Instruction("neg", [0], "f32")], "its operands are [0]; needs a tuple of positions"),
        ([Instruction([], (0,), "f32")], "its operation is not a name"),
    ],
)
def test_a_damaged_instruction_is_named(code, complaint):
    with pytest.raises(ProgramError) as caught:
        program(*code).verify()
    assert str(caught.value).startswith("p, tick, instruction ") and str(caught.value).endswith(complaint)


def test_results_must_exist_and_have_their_type():
    good = op("mul", 0, 1)
    z = (Channel("z", "m"),)
    begin = Block((X,), states=(0,))
    for broken, complaint in (
        (program(good, outputs=(9,)), "p, tick: output 0 is not a result of type f32"),
        (program(op("lt", 0, 1, type="bool")), "p, tick: output 0 is not a result of type f32"),
        (program(good, outputs=()), "p, tick: gives 0 outputs, needs 1"),
        (program(good, outputs=(3, 3)), "p, tick: gives 2 outputs, needs 1"),
        (program(good, states=(3,)), "p, tick: gives 1 states, needs 0"),
        (program(good, states=(3,), channels=z), "p, init: gives 0 states, needs 1"),
        (
            program(good, op("eq", 0, 1, type="bool"), outputs=(3,), states=(4,), init=begin, channels=z),
            "state 0 is not",
        ),
        (program(good, init=Block((X,), outputs=(0,))), "p, init: gives 1 outputs, needs 0"),
        (replace(program(good), values=()), "1 parameters but 0 values"),
    ):
        with pytest.raises(ProgramError, match=complaint):
            broken.verify()
    assert program(good, states=(3,), init=begin, channels=z).verify()


@pytest.mark.parametrize(
    "type, value",
    [
        *(("f32", v) for v in (0.5, -0.0, 3, 2**30, float("inf"), -float("inf"), float("nan"), 2.0**-149)),
        *(("f64", v) for v in (0.1, 1e300, 5e-324, float("nan"))),
        *(("i32", v) for v in (-(2**31), 2**31 - 1)),
        ("bool", True),
    ],
)
def test_a_constant_of_its_type_is_accepted(type, value):
    assert program(op("const", value=value, type=type), op("mul", 0, 1), outputs=(4,)).verify()


def test_the_interface_is_checked():
    good, z = program(op("mul", 0, 1)), Channel("z", "m")
    twice = replace(good, outputs=(Channel("F"), Channel("F")), tick=replace(good.tick, outputs=(3, 3)))
    for broken, complaint in (
        (replace(good, T=float("nan")), "p: T = nan s; a sampling period needs a finite T > 0"),
        (replace(good, T=-1), "p: T = -1 s"),
        (replace(good, T=0.0), "p: T = 0.0 s"),
        (replace(good, T=float("inf")), "p: T = inf s"),
        (replace(good, T="1"), "p: T = '1' s"),
        (replace(good, values=("a",)), "p: k = 'a'; needs a number"),
        (replace(good, values=(None,)), "p: k = None; needs a number"),
        (replace(good, values=(True,)), "p: k = True; needs a number"),
        (
            replace(good, inputs=(Channel("x", "m"), Channel("v", "m/s", "f16"))),
            "p: v is of type 'f16'; needs one of f32",
        ),
        (replace(good, parameters=(Channel("k", "N/m", None),)), "p: k is of type None"),
        (replace(good, states=(z,)), "p, init: gives 0 states, needs 1"),
        (replace(good, states=(z,), init=Block((X,), states=(0,))), "p, tick: gives 0 states, needs 1"),
        (twice, "p: 2 outputs have the name F; give each a name of its own"),
    ):
        with pytest.raises(ProgramError) as caught:
            broken.verify()
        assert str(caught.value).startswith(complaint)


def test_init_sees_no_states():
    z = (Channel("z", "m"),)
    begin = Block((op("state", index=0),), states=(0,))
    with pytest.raises(ProgramError, match="p, init, instruction 0 .* no state 0 here"):
        program(op("mul", 0, 1), states=(3,), init=begin, channels=z).verify()


@pytest.mark.parametrize("seed", range(3))
def test_every_operand_moved_past_its_instruction_is_refused(seed):
    good = random_program(seed, size=40)
    for name in ("init", "tick"):
        block = getattr(good, name)
        for position, i in enumerate(block.instructions):
            for k in range(len(i.args)):
                for bad in (position, position + 1, -1, 2**31):
                    args = (*i.args[:k], bad, *i.args[k + 1 :])
                    code = (*block.instructions[:position], replace(i, args=args), *block.instructions[position + 1 :])
                    with pytest.raises(ProgramError, match=f"{name}, instruction {position}"):
                        replace(good, **{name: replace(block, instructions=code)}).verify()


def test_the_tables_are_consistent():
    assert all(set(o.operands) <= set("RBI") and o.result in "RBI" for o in OPERATIONS.values())
    assert not set(LEAVES) & set(OPERATIONS) and set(TYPES) == {"f32", "f64", "bool", "i32"}


def test_the_listing_names_everything_and_counts_what_computes():
    p = program(op("mul", 0, 1), op("sub", 3, 2))
    text = str(p)
    assert len(p) == 2 and p.types == ("f32",)
    for line in (
        "program p: T = 0.001 s, 2 instructions per tick", "inputs     x [m] f32", "parameters k = 150 N/m",
        "%3    f32   mul      x  k", "%4    f32   sub      %3  2", "output F = %4",
    ):  # fmt: skip
        assert line in text
    assert "k = ? N/m" in str(replace(p, values=(float("nan"),)))


def test_programs_can_be_told_apart_and_looked_up():
    one, same, other = (hl.compile(hl.wall()(k=100), T=T) for T in (1e-3, 1e-3, 2e-3))
    assert one == same != other
    assert {one: "known"}[same] == "known"
