"""Committed programs and the committed bits of their results, on every engine of this machine."""

import json
from pathlib import Path

import numpy as np
import pytest
from random_programs import assert_same_bits

from hapticlab.compiler.engines.bytecode import OPCODES, encode
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.vm import Vm
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program
from hapticlab.errors import EngineMissingError

GOLDEN = json.loads((Path(__file__).parents[1] / "vectors" / "golden.json").read_text())
NAMES = [g["name"] for g in GOLDEN]


def number(text, type):
    return text == "True" if type == "bool" else int(text) if type == "i32" else float(text)


def block_of(code, outputs, states):
    made = (Instruction(op, tuple(args), type, number(value, type), index) for op, args, type, value, index in code)
    return Block(tuple(made), tuple(outputs), tuple(states))


def program_of(g):
    kinds = ("inputs", "parameters", "states", "outputs")
    channels = [tuple(Channel(f"{kind}{k}", "1", type) for k, type in enumerate(g[kind])) for kind in kinds]
    values = tuple(float.fromhex(v) for v in g["values"])
    return Program(g["name"], *channels, block_of(*g["init"]), block_of(*g["tick"]), g["T"], values).verify()


def array(texts, *shape):
    return np.array([float.fromhex(t) for t in texts]).reshape(shape)


def machine(program, engine):
    if engine == "vm with 8-bit words":
        return lambda *given: Vm(program, word_bits=8).run(*given)
    try:
        ready = load(program, engine)
    except EngineMissingError as missing:
        pytest.skip(str(missing))
    return lambda ticks, inputs, values: ready.run(ticks, inputs, values)


WASM = pytest.param("wasm", marks=pytest.mark.machine_code)


@pytest.mark.parametrize("engine", ["interpreter", "vm", "vm with 8-bit words", "llvm", WASM])
@pytest.mark.parametrize("g", GOLDEN, ids=NAMES)
def test_every_engine_gives_the_committed_bits(g, engine):
    program = program_of(g)
    ticks = len(g["given"]) // len(g["inputs"])
    given = array(g["given"], ticks, -1)
    outputs, states = machine(program, engine)(ticks, given, np.array(program.values)[:, None])
    assert_same_bits(outputs, array(g["out"], ticks, len(g["outputs"]), 1))
    assert_same_bits(states, array(g["end"], len(g["states"]), 1))


@pytest.mark.parametrize("word_bits", [8, 16])
@pytest.mark.parametrize("g", GOLDEN, ids=NAMES)
def test_programs_encode_to_the_committed_bytes(g, word_bits):
    assert encode(program_of(g), word_bits=word_bits).hex() == g[f"bytes_{word_bits}"]


def test_the_golden_programs_use_every_operation_and_give_numbers_worth_comparing():
    used = {code[0] for g in GOLDEN for block in (g["init"], g["tick"]) for code in block[0]}
    assert set(OPCODES) <= used
    out = np.concatenate([array(g["out"], -1) for g in GOLDEN])
    assert (out != 0).mean() > 0.4
    assert np.unique(out).size > 250
