"""Slopes of force laws against their derivatives."""

import math

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.errors import AnalysisError

A, w = hl.parameters("A w", units="N 1/m", values=(1.3, 900))


def test_a_sine_has_its_largest_slopes_at_its_zeros():
    low, high = hl.local_stiffness(hl.Scene(force=A * sp.sin(w * x(n))), -0.01, 0.01)
    assert (low, high) == (pytest.approx(-1.3 * 900, rel=1e-6), pytest.approx(1.3 * 900, rel=1e-6))


def test_a_hardening_spring():
    k, c = hl.parameters("k c", units="N/m N/m^3", values=(100, 5e6))
    hard = hl.Scene(force=k * x(n) + c * x(n) ** 3)
    assert hl.local_stiffness(hard, -0.004, 0.01)[1] == pytest.approx(100 + 3 * 5e6 * 1e-4, rel=1e-4)
    assert hl.local_stiffness(hard, -0.004, 0.01)[0] == pytest.approx(100, rel=1e-4)


@pytest.mark.parametrize("unilateral, least", [("gate", 0), ("clip", 0), (None, 250)])
def test_walls(unilateral, least):
    low, high = hl.local_stiffness(hl.wall(unilateral=unilateral)(k=250, x_o=0.003), -0.01, 0.01)
    assert low == pytest.approx(least, abs=1e-6) and high == pytest.approx(250, rel=1e-9)


@pytest.mark.parametrize(
    "scene, words",
    [
        (hl.Scene(force=hl.when(x(n) > 0, A)), "jumps near x = "),
        (hl.wall("ellis")(k=1), "x\\(n - 1\\)"),
        (hl.wall(), "k has no value"),
        (hl.Scene(force=A * sp.sin(hl.parameters("f", units="1/s", values=1) * t)), "holds t"),
    ],
)
def test_it_says_what_it_needs(scene, words):
    with pytest.raises(AnalysisError, match=words):
        hl.local_stiffness(scene, -0.01, 0.01)
    with pytest.raises(AnalysisError, match="low < high"):
        hl.local_stiffness(scene, 0.01, math.nan)
