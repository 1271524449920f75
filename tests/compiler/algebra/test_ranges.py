"""Enclosures against random points, and what declared ranges decide."""

import itertools
import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.compiler.algebra.ranges import Ranges
from hapticlab.compiler.prune.excluded_modes import decide
from hapticlab.scene.notation.amount import amount
from hapticlab.scene.notation.parameters import Parameter

a, b, c = Parameter("a", "1", -0.7, 1.3), Parameter("b", "1", 0.2, 0.9), Parameter("c", "1", -3.0, -1.0)
EXPRESSIONS = (
    a * b - c, a**2, a**3, c**-2, 1 / b, sp.sqrt(b), b ** sp.Rational(3, 2), b**-0.5, sp.sin(3 * a), sp.cos(c), sp.sin(c + a),
    sp.exp(a) - sp.log(b), sp.tanh(c), sp.atan(a * c), sp.Abs(a), sp.Abs(c), sp.Max(a, b, c), sp.Min(a, b), sp.sign(a),
    sp.Heaviside(a), a * c * b, (a + c) ** 2, hl.when(a > b, a, c), hl.when(c > 0, 100, b), hl.when(b > 0, a, 50), b**a,
)  # fmt: skip


@pytest.mark.parametrize("expr", EXPRESSIONS, ids=str)
def test_every_value_lies_inside(expr):
    low, high = Ranges()(expr)
    points = [np.r_[p.low, np.random.default_rng(7).uniform(p.low, p.high, 5), p.high] for p in (a, b, c)]
    values = sp.lambdify((a, b, c), expr, "numpy")(*np.array(list(itertools.product(*points))).T) + np.zeros(7**3)
    assert low <= values.min() + 1e-15 and values.max() <= high + 1e-15
    assert high - low <= 3 * (values.max() - values.min()) + 1e-12  # an enclosure of everything would prove nothing


def test_what_is_not_declared_may_be_anything():
    z = hl.coordinate("z", unit="m")
    ranges = Ranges({"a": 0.5})
    assert ranges(z) == ranges(z.diff(hl.t)) == ranges(hl.x(hl.n)) == (-math.inf, math.inf)
    assert ranges(a) == (0.5, 0.5)
    assert ranges(1 / a - 2) == pytest.approx((0, 0), abs=1e-15)
    assert ranges(1 / (a - 0.5)) == (-math.inf, math.inf)
    assert ranges(z * 0 + sp.sqrt(z)) == (-math.inf, math.inf)


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        (b > 0, True), (b < 0, False), (b > 0.5, None), (b >= 0.2, True), (b > 0.2, None), (sp.Eq(b, c), False),
        (sp.Ne(b, c), True), ((b > 0) & (a > 2), False), ((b > 0) & (a > 0), None), ((b > 5) | (c < 0), True),
        (~(b > 0), False), (c <= -1, True), (c < -1, None),
    ],
)  # fmt: skip
def test_conditions(condition, holds):
    assert Ranges().decided(condition) is holds


def test_excluded_modes_go_and_open_ones_stay():
    z = hl.coordinate("z", unit="1")
    wall = hl.when(c > 0, a**2, hl.when(z > a, sp.Max(0, b) * z, 3))
    found = {}
    assert decide(wall + 1, Ranges(), found) == hl.when(z > a, b * z, 3) + 1
    assert {str(w): str(d.becomes) for w, d in found.items()} == {"c > 0": "False", "Max(0, b)": "b"}
    assert found[c > 0].why == "c in [-3, -1]"
    assert decide(wall, Ranges(), keep=(c > 0,)) == hl.when(c > 0, a**2, hl.when(z > a, b * z, 3))


def test_several_cases():
    three = sp.Piecewise((1, b < 0), (2, a > 0), (3, b > 0), (4, True))
    assert decide(three, Ranges()) == hl.when(a > 0, 2, 3)
    assert decide(sp.Abs(c) + sp.Abs(a) + sp.Min(a, c), Ranges()) == -c + sp.Abs(a) + c
    assert decide(sp.Min(b, a, 2), Ranges()) == sp.Min(a, b)


def test_an_amount_with_a_unit_is_its_number():
    k = hl.parameters("k", units="N/m", ranges=(100, 200))
    law = hl.contact.penalty(k=k + amount("50 N/m", "N/m", "k"))
    assert Ranges()(law.k) == pytest.approx((150, 250), abs=1e-9)
