"""What the printed C does otherwise than the trace says: arms of a select, comparisons by bits, remainders of 4."""

import operator
import re

import numpy as np
import pytest
from random_programs import HARD

from hapticlab.compiler.boards import c_headers
from hapticlab.compiler.ir.operations import ELEMENTARY
from hapticlab.compiler.ir.program import Instruction
from hapticlab.compiler.ir.trace import Builder, floor

OPERATION = {"lt": operator.lt, "le": operator.le, "eq": operator.eq}
CONSTANTS = [0.0, -0.0, 1.0, 1.5, 3.0, -104.0, -1.0, 89.0, 8192.0, 1e-40]


def floats():
    """Return float32 of every kind, the neighbours of the constants among them."""
    with np.errstate(over="ignore"):
        values = np.array([*HARD, *CONSTANTS, *np.random.default_rng(3).normal(size=200) * 100], np.float32)
    bits = values.view(np.uint32)
    return np.concatenate([values, (bits + np.uint32(1)).view(np.float32), (bits - np.uint32(1)).view(np.float32)])


@pytest.mark.parametrize("op", OPERATION)
@pytest.mark.parametrize("side", [0, 1])
def test_a_comparison_by_bits_is_the_comparison(op, side):
    values, done = floats(), 0
    for constant in CONSTANTS:
        code = [Instruction("input", (), "f32"), Instruction("const", (), "f32", value=float(np.float32(constant)))]
        i = Instruction(op, (1, 0) if side == 0 else (0, 1), "bool")
        found = c_headers._bits_within(i, code)
        if found is None:
            continue
        other, low, high = found
        assert other == 0
        c = np.float32(constant)
        expected = OPERATION[op](c, values) if side == 0 else OPERATION[op](values, c)
        bits = values.view(np.uint32)
        within = (bits & 0x7FFFFFFF) == 0 if low > high else (bits - np.uint32(low)) <= np.uint32(high - low)
        np.testing.assert_array_equal(within, expected, err_msg=f"{op} {constant}")
        done += 1
    assert done >= (3 if op != "le" else 0)


def test_of_an_absolute_value_at_most_a_limit_is_one_range_too():
    code = [Instruction("input", (), "f32"), Instruction("abs", (0,), "f32")]
    code.append(Instruction("const", (), "f32", value=8192.0))
    other, low, high = c_headers._bits_within(Instruction("le", (1, 2), "bool"), code)
    values = np.abs(floats())
    within = (values.view(np.uint32) >= low) & (values.view(np.uint32) <= high)
    np.testing.assert_array_equal(within, values <= np.float32(8192))
    assert other == 1


def test_only_the_arm_that_is_taken_is_computed():
    """Of sine's two polynomials each stands in an arm of its own, deeper than the reduction of the angle."""
    source = c_headers._function("sin")
    depth = {m[2]: len(m[1]) // 4 for m in re.finditer(r"^( +)const float (t\d+) =", source, re.M)}
    lines = source.splitlines()
    of_sine = next(line for line in lines if "0x1.9ac9b" in line)
    of_cosine = next(line for line in lines if "0x1.9bd89c" in line)
    reduction = next(line for line in lines if "hl_mod4f" in line)
    deep = [len(line) - len(line.lstrip()) for line in (of_sine, of_cosine)]
    assert deep[0] == deep[1] > len(reduction) - len(reduction.lstrip())
    between = "\n".join(lines[min(map(lines.index, (of_sine, of_cosine))) : max(map(lines.index, (of_sine, of_cosine)))])
    assert "} else {" in between
    assert max(depth.values()) >= 4


def test_every_value_is_declared_before_and_in_reach_of_its_uses():
    """A scope closes what it declared: each name is used only while its block is open."""
    for name in ELEMENTARY:
        open_scopes = [set()]
        for line in c_headers._function(name).splitlines()[1:]:
            text = line.strip()
            if text.startswith("}"):
                open_scopes.pop()
            declared = re.match(r"(?:const )?(?:float|int) (t\d+)", text)
            used = set(re.findall(r"\bt\d+\b", text)) - ({declared[1]} if declared else set())
            assert used <= set().union(*open_scopes), f"{name}: {text}"
            if declared:
                open_scopes[-1].add(declared[1])
            if text.endswith("{"):
                open_scopes.append(set())


def test_a_remainder_of_4_is_found_only_where_it_is_one():
    builder = Builder("f32")
    x = builder.leaf("input", 0, "f32")
    k = floor(x)
    right, wrong = k - floor(k * 0.25) * 4.0, k - floor(k * 0.5) * 4.0
    code = builder.block([right, wrong]).instructions
    found = [n for n in range(len(code)) if c_headers._remainder_of_4(code, n) is not None]
    assert len(found) == 1 and code[found[0]].op == "sub"
