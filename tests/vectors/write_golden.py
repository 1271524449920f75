"""Write golden.json: programs, what goes in, and the bits that come out of the interpreter.

Run it only to add programs or after a change of format: ``python tests/vectors/write_golden.py``. The committed bits
are what every engine, and every board, is held to.
"""

import json
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), str(HERE.parent / "compiler")]

from random_programs import kept_finite, random_program, random_rows  # noqa: E402

from hapticlab.compiler.engines.bytecode import OPCODES, encode  # noqa: E402
from hapticlab.compiler.engines.engine import load  # noqa: E402
from hapticlab.compiler.ir.operations import OPERATIONS  # noqa: E402
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program  # noqa: E402
from hapticlab.compiler.ir.trace import Builder, cos, exp, maximum, select, sin, tanh  # noqa: E402

TICKS = 8


def wall():
    """Eq. (23.1) with a low-passed velocity for damping and a count of samples in the wall."""
    b = Builder("f32")
    init = b.block(states=[b.leaf("input", 0, "f32"), b.const(0.0, "f32"), b.const(0, "i32")])
    b = Builder("f32")
    x = b.leaf("input", 0, "f32")
    k, x_o, B = (b.leaf("param", n, "f32") for n in range(3))
    last, velocity, count = b.leaf("state", 0, "f32"), b.leaf("state", 1, "f32"), b.leaf("state", 2, "i32")
    v = velocity * 0.9 + (x - last) * 100.0
    touching = x_o <= x
    force = select(touching, maximum(k * (x - x_o) + B * v, 0.0), 0.0)
    count = b.emit("iadd", count, b.const(1, "i32"))
    names = Channel("x", "m"), Channel("v", "m/s"), Channel("samples", "1", "i32")
    parameters = Channel("k", "N/m"), Channel("x_o", "m"), Channel("B", "N*s/m")
    outputs = Channel("F", "N"), Channel("touching", "1", "bool"), Channel("samples", "1", "i32")
    tick = b.block([force, touching, count], [x, v, count])
    return Program("wall", (Channel("x", "m"),), parameters, names, outputs, init, tick, 1e-3, (150.0, 0.01, 2.0))


def rotating_states():
    """Three states that change places every tick, and functions of each."""
    b = Builder("f32")
    x = b.leaf("input", 0, "f32")
    init = b.block(states=[x, x * 2.0, x * 3.0])
    b = Builder("f32")
    s = [b.leaf("state", n, "f32") for n in range(3)]
    names = tuple(Channel(n) for n in "abc")
    tick = b.block([sin(s[0]) * cos(s[0]), exp(-abs(s[1])), tanh(s[2])], [s[1], s[2], s[0]])
    return Program("rotating", (Channel("x"),), (), names, tuple(Channel(n) for n in "FGH"), init, tick, 1e-3)


def operations():
    """Every operation once on the inputs, each an output."""
    inputs = Channel("a"), Channel("b"), Channel("c", "1", "bool"), Channel("d", "1", "i32")
    code = [Instruction("input", (), c.type, index=k) for k, c in enumerate(inputs)]
    kinds = {"R": (0, 1), "B": (2, 2), "I": (3, 3)}
    for op in OPCODES:
        operands, result = OPERATIONS[op].operands, OPERATIONS[op].result
        reals = iter(kinds["R"])
        args = tuple(next(reals) if kind == "R" else kinds[kind][0] for kind in operands)
        code.append(Instruction(op, args, {"R": "f32", "B": "bool", "I": "i32"}[result]))
    outputs = tuple(Channel(f"y{k}", "1", i.type) for k, i in enumerate(code[4:]))
    tick = Block(tuple(code), tuple(range(4, len(code))), ())
    return kept_finite(Program("operations", inputs, (), (), outputs, Block(), tick, 1e-3))


def given(program, seed):
    """Return the inputs of a run."""
    rng = np.random.default_rng(seed)
    if program.name in ("wall", "rotating"):
        return np.linspace(0.003, 0.02 if program.name == "wall" else 2.0, TICKS)[:, None]
    rows = random_rows(rng, program.inputs, 4 * TICKS if program.name == "operations" else TICKS).T.copy()
    return rows if program.name != "operations" else np.where(np.abs(rows) > 3e38, 40.0, rows)


def hexed(array):
    return [float(v).hex() for v in np.ravel(array)]


def golden(program, seed):
    """Return a program, its bytes, what it is given and what it must give, as JSON has it."""
    inputs = given(program, seed)
    run = load(program, "interpreter").run(len(inputs), inputs)
    assert np.isfinite(run.outputs).all() and np.isfinite(run.states).all()
    blocks = {
        name: [[[i.op, i.args, i.type, repr(i.value), i.index] for i in b.instructions], b.outputs, b.states]
        for name, b in (("init", program.init), ("tick", program.tick))
    }
    channels = {n: [c.type for c in getattr(program, n)] for n in ("inputs", "parameters", "states", "outputs")}
    coded = {f"bytes_{bits}": encode(program, word_bits=bits).hex() for bits in (8, 16)}
    numbers = {"given": inputs, "values": program.values, "out": run.outputs, "end": run.states}
    numbers = {name: hexed(array) for name, array in numbers.items()}
    return {"name": program.name, "T": program.T, **channels, **blocks, **coded, **numbers}


def main():
    programs = [wall(), rotating_states(), operations()]
    programs += [kept_finite(random_program(seed, ("f32",), 60, tuple(OPCODES))) for seed in range(100, 106)]
    text = json.dumps([golden(p.verify(), seed) for seed, p in enumerate(programs)], indent=None, separators=(",", ":"))
    (HERE / "golden.json").write_text(text.replace('{"name"', '\n{"name"') + "\n")


if __name__ == "__main__":
    main()
