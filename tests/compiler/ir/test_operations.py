"""The records of operations against each other: each field says the same thing."""

import numpy as np
import pytest

from hapticlab.compiler.events.taylor_series import Series
from hapticlab.compiler.ir.operations import OPERATIONS
from hapticlab.compiler.ir.trace import Builder

#: operands where every operation is smooth, and (rates of the operands)
AT, RATE, STEP = (0.7, 1.9), (1.0, -0.6), 1e-6


@pytest.mark.parametrize("o", OPERATIONS.values(), ids=OPERATIONS)
def test_a_record_is_whole(o):
    assert o.llvm or o.definition, "machine code"
    assert o.c or o.definition or o.converts or "I" in o.operands, "C of reals and conditions, for elementary functions"
    assert len(o.derivative) in (0, len(o.operands))
    assert bool(o.derivative) >= bool(o.series), "what has a series has a derivative"
    assert not o.commutes or len(set(o.operands)) == 1 < len(o.operands)


def test_opcodes_count_from_one():
    assert [o.opcode for o in OPERATIONS.values() if o.opcode] == list(range(1, len(OPERATIONS)))  # a cast has none


@pytest.mark.parametrize("o", [o for o in OPERATIONS.values() if o.derivative], ids=lambda o: o.name)
def test_the_derivative_is_the_slope_of_what_is_computed(o):
    conditions = [np.bool_(True)] * o.operands.count("B")
    at, rates = (list(map(np.float64, part[: o.operands.count("R")])) for part in (AT, RATE))
    ahead, behind = (o.compute(*conditions, *(a + side * d for a, d in zip(at, rates, strict=True))) for side in (STEP, -STEP))
    rules = o.derivative[len(conditions) :]
    r = o.compute(*conditions, *at)
    slope = sum(rule(d, r, *conditions, *at) for rule, d in zip(rules, rates, strict=True))
    assert slope == pytest.approx((ahead - behind) / (2 * STEP), rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("o", [o for o in OPERATIONS.values() if o.series], ids=lambda o: o.name)
def test_the_first_coefficient_is_the_derivative(o):
    builder = Builder("f64")
    leaves = [builder.leaf("input", k, "bool" if kind == "B" else "f64") for k, kind in enumerate(o.operands)]
    result = builder.emit(o.name, *leaves)
    reals = [leaf for leaf in leaves if leaf.type == "f64"]
    rows = {leaf.id: [np.bool_(True), 0.0] for leaf in leaves if leaf.type == "bool"}
    rows |= {leaf.id: [np.float64(a), d] for leaf, a, d in zip(reals, AT, RATE, strict=False)}
    value, first = Series(builder.instructions, dict(rows)).of(result, 1)
    operands = [rows[leaf.id][0] for leaf in leaves]
    assert value == o.compute(*operands)
    rates = [rows[leaf.id][1] for leaf in leaves]
    slope = sum(rule(d, value, *operands) for rule, d in zip(o.derivative, rates, strict=True) if rule)
    assert first == pytest.approx(slope, rel=1e-15)
