"""What only one arm of a select needs is skipped, and no bit tells."""

import numpy as np
import pytest
from random_programs import PRIMITIVE, assert_same_bits, random_program, random_rows

from hapticlab.compiler.engines import skipped_arms
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.llvm_emit import emit
from hapticlab.compiler.engines.skipped_arms import Arm, Demand, in_lazy_order
from hapticlab.compiler.ir.operations import OPERATIONS
from hapticlab.compiler.ir.program import Block, Channel, Program
from hapticlab.compiler.ir.trace import Builder, select, sqrt

MANY_SELECTS = (*PRIMITIVE, *["select"] * 6)
LOGIC = {"not": lambda a: not next(a), "and": all, "or": any}


def long(a, by=3.0, steps=30):
    """Return work enough to be skipped."""
    for _ in range(steps):
        a = a * by + 1.0
    return a


def program_of(body, inputs=2):
    """Return a program with one output, ``body`` of its inputs."""
    b = Builder("f64")
    result = body(*(b.leaf("input", k, "f64") for k in range(inputs)))
    channels = tuple(Channel(f"x{k}", "1", "f64") for k in range(inputs))
    return Program("one", channels, (), (), (Channel("y", "1", "f64"),), Block(), b.block([result]), 1e-3).verify()


def arranged(program):
    return Demand(program.tick).arranged(range(len(program.tick.instructions)))


def arms(items):
    """Return every arm, at any depth."""
    return [a for item in items if isinstance(item, Arm) for a in (item, *arms(item.items))]


def assert_computable(instructions, items, known=()):
    """Every operand comes first; an arm's condition is known wherever it is asked for."""
    known = set(known)
    for item in items:
        if isinstance(item, Arm):
            assert item.condition in known
            known |= assert_computable(instructions, item.items, known)
        else:
            assert known.issuperset(instructions[item].args)
            known.add(item)
    return known


def needed_lazily(block, values):
    """Return the positions that lazy evaluation computes, given the value of every result."""
    needed, stack = set(), [*block.outputs, *block.states]
    while stack:
        k = stack.pop()
        if k not in needed:
            needed.add(k)
            i = block.instructions[k]
            operands = in_lazy_order(block.instructions, i)
            if i.op == "select":
                operands = i.args[0], i.args[1 if values[i.args[0]] else 2]
            elif i.op in ("and", "or") and values[operands[0]] == (i.op == "or"):
                operands = operands[:1]
            stack += operands
    return needed


def computed(items, values):
    """Return the positions that are computed, arms that are not chosen left out."""
    done = set()
    for item in items:
        if not isinstance(item, Arm):
            done.add(item)
        elif bool(values[item.condition]) == item.chosen:
            done |= computed(item.items, values)
    return done


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.always("?", "24", "27")
def test_what_lazy_evaluation_needs_is_computed_in_an_order_that_can_be(monkeypatch, seed):
    monkeypatch.setattr(skipped_arms, "WORTH", 1)
    program = random_program(seed, ("f64",), 250, MANY_SELECTS)
    items, code, rng = arranged(program), program.tick.instructions, np.random.default_rng(seed)
    everything = assert_computable(code, items)
    most = 0
    for _ in range(20):  # any truth of the conditions, whether numbers could make it or not
        values = list(rng.random(len(code)) < 0.5)
        for k, i in enumerate(code):
            if i.op in LOGIC:
                values[k] = LOGIC[i.op](values[a] for a in i.args)
        done = computed(items, values)
        assert done >= needed_lazily(program.tick, values)
        most = max(most, len(everything) - len(done))
    assert most > 0 or not arms(items)


@pytest.mark.machine_code
@pytest.mark.parametrize("seed", range(16))
@pytest.mark.parametrize("reals", [("f64",), ("f32", "f64")])
@pytest.mark.always("reals0-8", "reals1-5")
def test_skipping_changes_no_bit_in_any_shape(monkeypatch, seed, reals):
    monkeypatch.setattr(skipped_arms, "WORTH", 1 + seed % 5)
    operations = (*OPERATIONS, *MANY_SELECTS) if seed % 4 == 0 else MANY_SELECTS
    program = random_program(seed, reals, 200, operations)
    rng, lanes = np.random.default_rng(seed), 17
    inputs, parameters = random_rows(rng, program.inputs, 12).T.copy(), random_rows(rng, program.parameters, lanes)
    fast, reference = load(program, "llvm"), load(program, "interpreter").run(12, inputs, parameters)
    together = fast.run(12, inputs, parameters)
    assert_same_bits(together.outputs, reference.outputs)
    assert_same_bits(together.states, reference.states)
    assert_same_bits(fast.run(12, inputs, parameters, every=5).outputs, reference.outputs[4::5])
    for lane in (0, lanes - 1):
        alone = fast.run(12, inputs, parameters[:, lane])
        assert_same_bits(alone.outputs[..., 0], reference.outputs[..., lane])
        assert_same_bits(alone.states[:, 0], reference.states[:, lane])


def test_what_several_selects_of_one_condition_need_is_one_arm():
    def body(x, y):
        slow = long(x)
        return select(x < y, slow, 0.0) + select(x < y, sqrt(slow), y) + select(y <= 2.0, x, y)

    program = program_of(body)
    (arm,) = arms(arranged(program))
    assert arm.chosen and len(arm.positions()) >= 61
    assert emit(program).count("br i1 %t") == 1


def test_arms_of_arms_are_skipped_within_them():
    program = program_of(lambda x, y: select(x < y, select(long(x) < 1.0, x, long(y, 2.0)), y))
    outer, inner = arms(arranged(program))
    assert inner in outer.items and not inner.chosen


def test_the_negation_of_a_condition_is_the_same_choice():
    def body(x, y):
        ahead, slow = x < y, long(x)
        return select(ahead, slow, 1.0) + select(~ahead, 2.0, slow * slow)

    (arm,) = arms(arranged(program_of(body)))
    assert arm.chosen


def test_conditions_are_asked_for_one_after_the_other():
    program = program_of(lambda x, y: select((x < y) & (long(x) < y) | (y < 0.0), x, y))
    assert len(arms(arranged(program))) == 1
    both = program_of(lambda x, y: select((x < y) & (y < 2.0), long(x), y) + select(x < y, long(x), 1.0))
    (arm,) = arms(arranged(both))  # both conditions imply the first
    assert both.tick.instructions[arm.condition].op == "lt"


def test_what_is_needed_anyway_and_what_is_little_is_not_skipped():
    for body in (
        lambda x, y: select(x < y, long(x), long(x) + 1.0),
        lambda x, y: select(x < y, long(x), y) + long(x),
        lambda x, y: select(x < y, long(x, steps=10), y),
    ):
        program = program_of(body)
        assert arranged(program) == list(range(len(program.tick.instructions)))
        assert "arm" not in emit(program) and "arm" not in emit(program, lanes=8)


@pytest.mark.machine_code
@pytest.mark.wide
def test_deep_nests_of_arms_compile():
    def body(x, y):
        value = y
        for depth in range(80):
            value = select(x < float(depth), y * depth, long(value, 1.0 + depth / 1e4))
        return value

    program = program_of(body)
    inputs = np.random.default_rng(0).uniform(0, 200, (20, 2))
    fast, slow = load(program, "llvm"), load(program, "interpreter")
    assert_same_bits(fast.run(20, inputs).outputs, slow.run(20, inputs).outputs)
    assert len(arms(arranged(program))) == skipped_arms.DEEPEST


@pytest.mark.machine_code
@pytest.mark.parametrize("needed", [(), (3,), (0, 15), tuple(range(16))])
def test_an_arm_that_any_lane_needs_is_computed_for_all(needed):
    b = Builder("f64")
    x, k = b.leaf("input", 0, "f64"), b.leaf("param", 0, "f64")
    y = select(k * x < 1.0, x, 1.0 / long(select(k < 3.0, x, long(k)), 0.5))
    real = Channel("k", "1", "f64")
    program = Program("lanes", (real,), (real,), (), (real,), Block(), b.block([y]), 1e-3, (1.0,)).verify()
    k = np.where(np.isin(np.arange(16), needed), 5.0, 0.1)[None]
    fast, slow = (load(program, engine).run(3, np.array([1.0, 2.0, 12.0]), k) for engine in ("llvm", "interpreter"))
    assert_same_bits(fast.outputs, slow.outputs)
