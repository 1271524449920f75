"""Any program that verifies, given any finite numbers, ends in finite numbers or in a fault with a name, on every engine.

Programs are drawn from all operations and types, constants from all bit patterns; what is drawn wrongly is refused in words.
"""

import struct
from dataclasses import replace

import numpy as np
import pytest
from host_driver import Host, fault_name, state_name
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_programs import assert_same_bits

import hapticlab as hl
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.ir.operations import OPERATIONS
from hapticlab.compiler.ir.program import LEAVES, Block, Channel, Instruction, Program
from hapticlab.compiler.ir.trace import Builder
from hapticlab.errors import ProgramError

TICKS = 12
FINITE = {"f32": st.floats(width=32, allow_nan=False, allow_infinity=False),
          "f64": st.floats(allow_nan=False, allow_infinity=False),
          "bool": st.integers(0, 1), "i32": st.integers(-(2**31), 2**31 - 1)}  # fmt: skip
ANY = FINITE | {"f32": st.floats(width=32), "f64": st.floats(), "bool": st.booleans()}
EVERY_DRAW = settings(derandomize=True, deadline=None, suppress_health_check=list(HealthCheck), max_examples=25)
MANY_DRAWS = settings(EVERY_DRAW, max_examples=1500)


@st.composite
def blocks(draw, leaves, states, outputs, reals):
    """Return a block of up to 25 operations on what is there, the types of its results as asked."""
    code = [Instruction(op, (), c.type, index=i) for op, channels in leaves.items() for i, c in enumerate(channels)]
    code += [Instruction("const", (), type, value=draw(ANY[type])) for type in (*reals, "bool", "i32") for _ in range(2)]
    operations = [op for op in OPERATIONS if op != "cast" or len(reals) > 1]
    for op in draw(st.lists(st.sampled_from(operations), max_size=25)):
        kinds, result = OPERATIONS[op].operands, OPERATIONS[op].result
        real = draw(st.sampled_from(reals))
        of = {"R": real, "B": "bool", "I": "i32"}
        args = tuple(draw(st.sampled_from([k for k, i in enumerate(code) if i.type == of[kind]][-9:])) for kind in kinds)
        type = next(r for r in reals if r != real) if op == "cast" else of[result]
        code.append(Instruction(op, args, type))
    last = {type: [k for k, i in enumerate(code) if i.type == type][-4:] for type in (*reals, "bool", "i32")}
    return Block(tuple(code), *(tuple(draw(st.sampled_from(last[t])) for t in types) for types in (outputs, states)))


@st.composite
def programs(draw, reals=("f32",), sees="xv"):
    """Return a program of x and v, one parameter, and a force: what a scene may become."""
    real = reals[0]
    states = draw(st.lists(st.sampled_from((*reals, "bool", "i32")), max_size=4))
    outputs = (real, *draw(st.lists(st.sampled_from(reals), max_size=2)))
    inputs = (Channel("x", "m", real), Channel("v", "m/s", real))[: len(sees)]
    parameter = (Channel("p", "1", real),)
    kept = tuple(Channel(f"s{k}", "1", type) for k, type in enumerate(states))
    shown = tuple(Channel(name, "N", type) for name, type in zip(("F", "y1", "y2"), outputs, strict=False))
    leaves = {"input": inputs, "param": parameter}
    init = draw(blocks(leaves, states, (), reals))
    tick = draw(blocks({**leaves, "state": kept}, states, outputs, reals))
    value = draw(FINITE[real])
    return Program("any", inputs, parameter, kept, shown, init, tick, 1e-3, (value,)).verify()


def rows(reals):
    return st.lists(st.tuples(FINITE[reals[0]], FINITE[reals[0]]), min_size=TICKS, max_size=TICKS).map(np.array)


def traced(program):
    """Return the program as the compiler would have written it: 0 / x is 0 there, whatever x."""

    def again(block, **leaves):
        builder = Builder(program.outputs[0].type)
        here = {op: [builder.leaf(op, k, c.type) for k, c in enumerate(channels)] for op, channels in leaves.items()}
        return builder.block(*builder.inline(block, **here))

    given = {"input": program.inputs, "param": program.parameters}
    return replace(program, init=again(program.init, **given), tick=again(program.tick, **given, state=program.states)).verify()


def starts_with_numbers(program, row):
    """Tell whether init makes finite states of the first sample: they are what a tick that changes nothing keeps."""
    states = tuple(Instruction("state", (), c.type, index=k) for k, c in enumerate(program.states))
    zeros = tuple(Instruction("const", (), c.type, value=0.0) for c in program.outputs)
    still = Block((*states, *zeros), tuple(range(len(states), len(states) + len(zeros))), tuple(range(len(states))))
    return np.isfinite(load(replace(program, tick=still), "interpreter").run(1, row[None, :]).states).all()


def first_fault(program, handle):
    """Return the first tick whose outputs or states are not all numbers, by the reference engine; None if none is."""
    if not starts_with_numbers(program, handle[0]):
        return 0
    loaded, states = load(program, "interpreter"), None
    for tick, row in enumerate(handle):
        run = loaded.run(1, row[None, :], states=states)
        states = run.states
        if not (np.isfinite(run.outputs).all() and np.isfinite(states).all()):
            return tick
    return None


def ends_alike_on_every_engine(program, handle):
    reference = load(program, "interpreter").run(TICKS, handle)
    found = load(program, "auto").run(TICKS, handle)
    for one, other in zip(reference, found, strict=True):
        assert_same_bits(one, other)
    if program.types in ((), ("f32",)):
        stop = first_fault(program, handle)
        ticks = TICKS if stop is None else stop
        machine = load(program, "vm").run(TICKS, handle).outputs
        assert_same_bits(machine[:ticks], reference.outputs[:ticks])
        assert np.isnan(machine[ticks:]).all()  # from a fault on nothing is a number


@EVERY_DRAW
@given(st.data())
def test_every_engine_ends_with_the_same_bits(data):
    reals = data.draw(st.sampled_from([("f32",), ("f64",), ("f32", "f64")]))
    ends_alike_on_every_engine(data.draw(programs(reals)), data.draw(rows(reals)))


@pytest.mark.slow
@MANY_DRAWS
@given(st.data())
def test_every_engine_ends_with_the_same_bits_many_times(data):
    test_every_engine_ends_with_the_same_bits.hypothesis.inner_test(data)


def is_felt_or_named(program, push):
    """On a simulated paddle: the fault is in the tick of the reference engine, and no force comes from there on."""
    program = traced(program)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, force_max=10.0, hand=hl.Hand(push=push, k=50, b=2))
    log = paddle.run(program, duration=TICKS * 1e-3, progress=False)
    seen = np.column_stack([log.x, log.v])[:, : len(program.inputs)]
    stop = first_fault(program, seen)
    assert np.isfinite(log.x).all() and np.isfinite(log.F).all() and np.abs(log.F).max() <= 10.0
    if stop is None:
        assert log.fault is None
    else:
        assert log.fault.startswith(f"tick {stop} ") and "was not finite; the motor is off" in log.fault
        assert not log.F[stop:].any()


@pytest.mark.wide
@EVERY_DRAW
@given(programs(), st.floats(-20, 20))
def test_a_simulated_paddle_feels_finite_forces_or_names_the_fault(program, push):
    is_felt_or_named(program, push)


@pytest.mark.slow
@MANY_DRAWS
@given(programs(), st.floats(-20, 20))
def test_a_simulated_paddle_feels_finite_forces_or_names_the_fault_many_times(program, push):
    is_felt_or_named(program, push)


def is_driven_or_off(program, counts):
    """On a board: the force is that of the reference engine, limited, until its fault; then the motor is off."""
    host = Host(speed_max=1e6, force_max=8.0, force_continuous=8.0).ready(program, _0=program.values[0])
    assert host.start() == "OK"
    duties = [host.tick(count, beat=True) for count in counts]
    sent = np.array([struct.unpack_from("<fff", f.payload, 5) for f in host.samples]).reshape(-1, 3)
    x = np.array(counts, np.float32)[:, None] * np.float32(1e-5)
    stop = first_fault(program, x)
    ran = TICKS if stop is None else stop
    F = np.clip(load(program, "interpreter").run(TICKS, x).outputs[:ran, 0, 0], -8.0, 8.0)
    np.testing.assert_array_equal(sent[:ran, 0], x[:ran, 0])
    np.testing.assert_array_equal(sent[:ran, 2], F)
    np.testing.assert_allclose(duties[:ran], -F / 8.0, atol=2e-4)  # a step of the PWM
    assert not any(duties[ran:])
    if stop is None:
        assert state_name(host.state()["state"]) == "RUN"
    else:
        assert fault_name(host.state()["fault"]) == "NOT_FINITE" and host.start() != "OK"


@EVERY_DRAW
@given(programs(sees="x"), st.lists(st.integers(-4000, 4000), min_size=TICKS, max_size=TICKS))
def test_a_board_drives_finite_forces_or_stops_with_its_fault(program, counts):
    is_driven_or_off(program, counts)


# what is drawn wrongly is refused in words


@st.composite
def damaged(draw):
    """Return a program in which one instruction is anything at all."""
    program = draw(programs(("f32", "f64")))
    code = list(program.tick.instructions)
    anything = st.one_of(st.integers(-3, 60), st.just(10**30), st.none(), st.text(max_size=3), st.floats())
    op = draw(st.one_of(st.sampled_from([*OPERATIONS, *LEAVES]), st.text(max_size=4)))
    args = tuple(draw(st.lists(anything, max_size=4)))
    type = draw(st.sampled_from(["f32", "f64", "bool", "i32", "f16", ""]))
    value, index = draw(anything), draw(anything)
    code[draw(st.integers(0, len(code) - 1))] = Instruction(op, args, type, value, index)
    return replace(program, tick=replace(program.tick, instructions=tuple(code)))


@settings(EVERY_DRAW, max_examples=8)
@given(damaged(), rows(("f32",)))
def test_a_damaged_program_is_refused_in_words_or_runs_as_any_other(program, handle):
    try:
        program.verify()
    except ProgramError:
        return
    ends_alike_on_every_engine(program, handle)


@pytest.mark.wide
@settings(EVERY_DRAW, max_examples=30)
@given(damaged(), rows(("f32",)))
def test_a_damaged_program_is_refused_in_words_or_runs_as_any_other_many_times(program, handle):
    test_a_damaged_program_is_refused_in_words_or_runs_as_any_other.hypothesis.inner_test(program, handle)


# any finite numbers at the boundary of an engine


@pytest.mark.wide
@EVERY_DRAW
@given(programs(), st.lists(st.floats(), min_size=2 * TICKS, max_size=2 * TICKS), st.floats())
def test_any_float64_at_all_is_taken_or_refused_alike(program, numbers, value):
    """Also nan, infinities, and what float32 has not: each engine takes it as float32 does."""
    handle = np.array(numbers).reshape(TICKS, 2)
    results = []
    for engine in ("interpreter", "auto"):
        with np.errstate(all="ignore"):
            try:
                results.append(load(program, engine).run(TICKS, handle, parameters=[value]).outputs)
            except ProgramError as problem:
                results.append(str(problem))
    if isinstance(results[0], str):
        assert results[0] == results[1] and "p" in results[0]
    else:
        assert_same_bits(*results)
