"""Seeded random programs of every operation and type, and the comparison of results bit for bit."""

from dataclasses import replace

import numpy as np

from hapticlab.compiler.ir.operations import ELEMENTARY, OPERATIONS
from hapticlab.compiler.ir.program import Block, Channel, Instruction, Program

#: what breaks arithmetic that is not IEEE: signed zeros, denormals, halves, the ends of the range, infinities and nan
HARD = (
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    1.5,
    -2.5,
    3e-39,
    -1e-45,
    5e-324,
    2e-308,
    1e38,
    3e300,
    1e-20,
    np.inf,
    -np.inf,
    np.nan,
)
PRIMITIVE = tuple(op for op in OPERATIONS if op not in ELEMENTARY)


def random_program(seed, reals=("f32", "f64"), size=80, operations=PRIMITIVE):
    """Return a verified program with inputs, parameters, states and outputs of every type among ``reals``, bool and i32."""
    rng = np.random.default_rng(seed)
    types = (*reals, "bool", "i32", *reals)
    channels = {kind: tuple(Channel(f"{kind}{k}", "1", type) for k, type in enumerate(types)) for kind in ("x", "p", "s", "y")}
    leaves = {"input": channels["x"], "param": channels["p"]}
    init = _random_block(rng, leaves, size // 4, reals, operations, states=types)
    tick = _random_block(rng, {**leaves, "state": channels["s"]}, size, reals, operations, states=types, outputs=types)
    values = random_rows(rng, channels["p"], 1)[:, 0]
    name = f"random{seed}"
    return Program(name, channels["x"], channels["p"], channels["s"], channels["y"], init, tick, 1e-3, tuple(values)).verify()


def kept_finite(program):
    """Return the program with 0 in place of every float32 output and next state past 1e30, infinite or nan."""

    def kept(block):
        code = list(block.instructions)

        def add(*instruction, **value):
            code.append(Instruction(*instruction, **value))
            return len(code) - 1

        def guard(k):
            if code[k].type != "f32":
                return k
            most, zero = (add("const", (), "f32", value=float(np.float32(v))) for v in (1e30, 0.0))
            return add("select", (add("le", (add("abs", (k,), "f32"), most), "bool"), k, zero), "f32")

        outputs, states = (tuple(guard(k) for k in ids) for ids in (block.outputs, block.states))
        return Block(tuple(code), outputs, states)

    return replace(program, init=kept(program.init), tick=kept(program.tick)).verify()


def random_rows(rng, channels, columns):
    """Return (channels, columns) finite numbers, each in its channel's type; a quarter of the reals are hard cases."""
    rows = rng.normal(size=(len(channels), columns)) * 10.0 ** rng.integers(-3, 4, (len(channels), columns))
    hard = rng.choice([v for v in HARD if np.isfinite(v)], rows.shape)
    rows = np.where(rng.random(rows.shape) < 0.25, hard, rows)
    for row, channel in zip(rows, channels, strict=True):
        if channel.type in ("bool", "i32"):
            row[:] = rng.integers(0, 2 if channel.type == "bool" else 1000, columns)
    return rows


def assert_same_bits(a, b):
    """Equal, with nan where the other has nan and the same sign of zero; the payload of a nan is not part of the contract."""
    a, b = (np.ascontiguousarray(v, float) for v in (a, b))
    assert a.shape == b.shape
    differs = (a.view(np.int64) != b.view(np.int64)) & ~(np.isnan(a) & np.isnan(b))
    assert not differs.any(), f"{differs.sum()} of {a.size} differ, first {a[differs][0]!r} and {b[differs][0]!r}"


def _random_block(rng, leaves, size, reals, operations, states, outputs=()):
    code = [Instruction(op, (), c.type, index=k) for op, channels in leaves.items() for k, c in enumerate(channels)]
    code += [_constant(rng, type) for type in (*reals, "bool", "i32") for _ in range(3)]
    while len(code) < size + len(leaves):
        code.append(_random_instruction(rng, code, reals, str(rng.choice(operations))))
        if code[-1] is None:
            code.pop()
    last = {type: [k for k, i in enumerate(code) if i.type == type] for type in (*reals, "bool", "i32")}
    pick = lambda type: int(rng.choice(last[type][-8:]))  # noqa: E731  late results need most of the earlier ones
    return Block(tuple(code), tuple(pick(t) for t in outputs), tuple(pick(t) for t in states))


def _constant(rng, type):
    if type == "bool":
        return Instruction("const", (), type, value=bool(rng.integers(2)))
    if type == "i32":
        return Instruction("const", (), type, value=int(rng.integers(-1000, 1000)))
    value = rng.choice(HARD) if rng.random() < 0.3 else rng.normal()
    with np.errstate(over="ignore"):
        return Instruction("const", (), type, value=float(np.float32(value) if type == "f32" else value))


def _random_instruction(rng, code, reals, op):
    kinds, result = OPERATIONS[op].operands, OPERATIONS[op].result
    real = str(rng.choice(reals))
    if op == "cast" and len(reals) == 1:
        return None
    wanted = [{"R": real, "B": "bool", "I": "i32"}[kind] for kind in kinds]
    args = tuple(int(rng.choice([k for k, i in enumerate(code) if i.type == type])) for type in wanted)
    type = {"R": real, "B": "bool", "I": "i32"}[result]
    if op == "cast":
        type = next(t for t in reals if t != real)
    return Instruction(op, args, type)
