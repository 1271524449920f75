"""Measure what every operation costs on every board, and write hapticlab/compiler/boards/costs.json.

    python tests/firmware/measure_costs.py            all boards
    python tests/firmware/measure_costs.py uno        one of them
    python tests/firmware/measure_costs.py step       only the rest of a step and a telemetry frame, in seconds

An operation's typical cost is the mean over operands as scenes have them. Its worst cost is the most that was found over
awkward operands (denormals, cancellation, every distance of exponents, huge angles, infinities, nan) and by a search that
keeps the dearest and flips their bits. A cost includes everything the machine does to dispatch the instruction.
"""

import json
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(Path(__file__).resolve().parent)]

from bare import Avr, Bench  # noqa: E402
from cortex import Cortex  # noqa: E402
from pico_bench import Rp2040  # noqa: E402
from pico_step import measure_pico_step  # noqa: E402
from whole_step import measure_step  # noqa: E402

from hapticlab.compiler.boards.cost import COSTS  # noqa: E402
from hapticlab.compiler.engines.bytecode import OPCODES  # noqa: E402
from hapticlab.compiler.ir.operations import OPERATIONS  # noqa: E402
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program  # noqa: E402

TYPE = {"R": "f32", "B": "bool", "I": "i32"}
MODELLED = "modelled, not measured: instructions under unicorn, cycles of the manuals, step and telemetry as on the Uno"
PROCESSORS = {
    "uno": (Avr, "measured in emulation"),
    "pico": (Rp2040, "measured in emulation"),
    "cortex-m4f": (lambda: Cortex("cortex-m4f"), MODELLED),
}
#: operands of each kind: typical, awkward, and of the search (children a generation, generations)
EFFORT = {"uno": (4000, 20_000, 3000, 60), "pico": (4000, 20_000, 3000, 40), "cortex-m4f": (300, 600, 100, 6)}


def interface(op):
    kinds, result = OPERATIONS[op].operands, OPERATIONS[op].result
    channels = tuple(Channel(f"a{k}", "1", TYPE[kind]) for k, kind in enumerate(kinds))
    return channels, TYPE[result]


def program_of(op):
    """Return a program of one instruction on its inputs. It gives out another input, so that no result stops it."""
    kinds, type = interface(op)
    inputs = (*kinds, Channel("zero"))
    code = [Instruction("input", (), c.type, index=k) for k, c in enumerate(inputs)]
    code.append(Instruction(op, tuple(range(len(kinds))), type))
    tick = Block(tuple(code), (len(kinds),))
    return Program(op, inputs, (), (), (Channel("y"),), Block(), tick, 1e-3)


def plain(outputs=(), states=(), moved=False):
    """Return a program that computes nothing: inputs come out, states stay or are moved."""
    types = tuple(dict.fromkeys((*outputs, *states, "f32")))
    inputs = tuple(Channel(f"x{t}", "1", t) for t in types)
    leaves = [Instruction("input", (), t, index=k) for k, t in enumerate(types)]
    held = [Instruction("state", (), t, index=k) for k, t in enumerate(states)]
    start = Block(tuple(leaves), (), tuple(types.index(t) for t in states))
    next_ = tuple(types.index(t) if moved else len(types) + k for k, t in enumerate(states))
    tick = Block((*leaves, *held), tuple(types.index(t) for t in outputs), next_)
    named = tuple(tuple(Channel(f"{n}{k}", "1", t) for k, t in enumerate(ts)) for n, ts in (("s", states), ("y", outputs)))
    return Program("plain", inputs, (), named[0], named[1], start, tick, 1e-3)


def typical(op, rng, count):
    """Return operands as scenes have them: of magnitudes 0.01 to 100, of any sign where the operation takes both."""
    inputs, _ = interface(op)
    columns = []
    for c in inputs:
        if c.type == "f32":
            column = rng.normal(size=count) * 10.0 ** rng.integers(-2, 3, count)
        else:
            column = rng.integers(0, 2 if c.type == "bool" else 100_000, count).astype(float)
        columns.append(column)
    rows = np.stack(columns, axis=1)
    if op in ("sqrt", "log", "exponent"):
        rows = np.abs(rows)
    if op in ("sin", "cos"):
        rows = rng.uniform(-0.7, 0.7, rows.shape)  # [rad], within an eighth of a turn
    if op == "exp2i":
        rows = np.round(rng.normal(size=rows.shape) * 10)
    return np.column_stack([rows.astype(np.float32), np.zeros(count)])


def far(count, rng):
    """Return angles beyond an eighth of a turn, up to a turn [rad]."""
    angles = rng.uniform(np.pi / 4, 2 * np.pi, count) * rng.choice([-1, 1], count)
    return np.column_stack([angles.astype(np.float32), np.zeros(count)])


MANTISSAS = (0, 1, 2, 0x400000, 0x7FFFFF, 0x7FFFFE, 0x555555, 0x2AAAAA, 0x3FFFFF, 0x7FF000, 0x000FFF, 0x3504F3, 0x490FDB)


def awkward_bits(rng, count):
    """Return bit patterns of floats: any exponent, denormals, infinities and nan, mantissas that carry or cancel."""
    exponent = np.where(rng.random(count) < 0.3, rng.integers(0, 3, count) * 127, rng.integers(0, 256, count))
    near = rng.random(count) < 0.4
    exponent = np.where(near, rng.integers(115, 140, count), exponent)
    mantissa = np.where(rng.random(count) < 0.5, rng.choice(MANTISSAS, count), rng.integers(0, 1 << 23, count))
    mantissa = np.where(rng.random(count) < 0.2, 1 << rng.integers(0, 23, count), mantissa)
    return (rng.integers(0, 2, count) << 31 | exponent << 23 | mantissa).astype(np.uint32)


def awkward(op, rng, count):
    """Return operands as bits; the second of a pair is often within a few bits of the first, where they cancel."""
    inputs, _ = interface(op)
    columns = []
    for k, c in enumerate(inputs):
        if c.type == "f32":
            bits = awkward_bits(rng, count)
            if k:
                twin = columns[0] ^ (rng.integers(0, 2, count) << 31 | 1 << rng.integers(0, 24, count)).astype(np.uint32)
                bits = np.where(rng.random(count) < 0.3, twin, bits)
        else:
            bits = rng.integers(0, 2 if c.type == "bool" else 1 << 32, count)
        columns.append(bits.astype(np.uint32))
    return np.stack(columns, axis=1)


def as_values(op, bits):
    """Return register bits as the numbers that Bench.run takes; they come back as the same bits."""
    columns = []
    for k, c in enumerate(interface(op)[0]):
        column = np.ascontiguousarray(bits[:, k])
        columns.append(column.view(np.float32) if c.type == "f32" else column.view(np.int32))
    with np.errstate(invalid="ignore"):
        return np.stack([*(c.astype(float) for c in columns), np.zeros(len(bits))], axis=1)


def mutated(bits, rng, op):
    """Return eight children of every row: up to three bits flipped."""
    children = np.repeat(bits, 8, axis=0)
    rows = np.arange(len(children))
    for _ in range(3):
        flip = (1 << rng.integers(0, 32, len(children))).astype(np.uint32)
        column = rng.integers(0, bits.shape[1], len(children))
        children[rows, column] ^= np.where(rng.random(len(children)) < 0.6, flip, 0).astype(np.uint32)
    for k, c in enumerate(interface(op)[0]):
        if c.type == "bool":
            children[:, k] &= 1
    return children


def measure(bench, op, base, effort, seed=0):
    """Return the typical and the worst cycles of an operation."""
    rng = np.random.default_rng(seed)
    usual, hard, keep, generations = effort
    taken = bench.run(typical(op, rng, usual).astype(float), init=False)[2].astype(int) - base
    mean = float(taken.mean())
    bits = awkward(op, rng, hard)
    cycles = bench.run(as_values(op, bits), init=False)[2].astype(int) - base
    worst = max(int(cycles.max()), int(taken.max()))
    if cycles.min() == cycles.max():
        return round(mean), worst
    for _ in range(generations):
        best = np.argsort(cycles, kind="stable")[-keep // 8 :]
        bits, cycles = bits[best], cycles[best]
        children = mutated(bits, rng, op)
        found = bench.run(as_values(op, children), init=False)[2].astype(int) - base
        bits, cycles = np.concatenate([bits, children]), np.concatenate([cycles, found])
        worst = max(worst, int(cycles.max()))
    return round(mean), worst


def one_tick(program, cpu):
    return int(Bench(program, cpu).run(np.zeros((2, len(program.inputs))))[2][-1])


def one_init(program, cpu):
    bench = Bench(program, cpu)
    bench.run(np.zeros((1, len(program.inputs))))
    return int(bench.init_cycles)


def overheads(cpu):
    """Return what a tick costs that computes nothing, and what every output, state and move adds."""
    found = {"tick": one_tick(plain(), cpu), "init": one_init(plain(), cpu)}
    for type in ("f32", "bool", "i32"):
        outputs = [one_tick(plain(outputs=(type,) * n), cpu) for n in (0, 1, 4)]
        states = [one_tick(plain(states=(type,) * n), cpu) for n in (0, 1, 4)]
        found[f"output {type}"] = max(outputs[1] - outputs[0], -(-(outputs[2] - outputs[1]) // 3))
        found[f"state {type}"] = max(states[1] - states[0], -(-(states[2] - states[1]) // 3))
    moves = [one_tick(plain(states=("f32",) * n, moved=True), cpu) - one_tick(plain(states=("f32",) * n), cpu) for n in (1, 4)]
    found["move"] = max(moves[0], -(-moves[1] // 4))
    return found


def measured(board):
    """Return a board's table."""
    make, source = PROCESSORS[board]
    cpu = make()
    table = {"source": source, **{"overheads": overheads(cpu)}, "operations": {}}
    for op in OPCODES:
        program = program_of(op)
        base = table["overheads"]["tick"] + table["overheads"]["output f32"]
        bench = Bench(program, cpu)
        row = list(measure(bench, op, base, EFFORT[board]))
        if op in ("sin", "cos"):
            beyond = bench.run(far(EFFORT[board][0], np.random.default_rng(1)).astype(float), init=False)[2]
            row.append(round(float(beyond.mean()) - base))
        table["operations"][op] = row
        print(board, op, *table["operations"][op], flush=True)
    return table


def main(boards):
    tables = json.loads(COSTS.read_text()) if COSTS.exists() else {}
    for board in PROCESSORS:
        if not boards or board in boards:
            tables[board] = {**tables.get(board, {}), **measured(board)}
    if not boards or "step" in boards:
        step, of_pico = measure_step(), measure_pico_step()
        for name, board in tables.items():
            board.update(of_pico if name == "pico" else step)
    COSTS.write_text(as_text(tables))


def as_text(tables):
    """Return the tables as JSON with one line an entry."""
    boards = []
    for name, table in tables.items():
        rows = []
        for key, value in table.items():
            text = json.dumps(value)
            if isinstance(value, dict):
                text = "{\n" + ",\n".join(f"   {json.dumps(k)}: {json.dumps(v)}" for k, v in value.items()) + "\n  }"
            rows.append(f"  {json.dumps(key)}: {text}")
        boards.append(f" {json.dumps(name)}: {{\n" + ",\n".join(rows) + "\n }")
    return "{\n" + ",\n".join(boards) + "\n}\n"


if __name__ == "__main__":
    main(sys.argv[1:])
