"""Slopes of force laws against their derivatives."""

import math

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.errors import AnalysisError

A, w = hl.parameters("A w", units="N 1/m", values=(1.3, 900))


def test_a_sine_has_its_largest_slopes_at_its_zeros():
    low, high = hl.stability.local_stiffness(hl.Scene(force=A * sp.sin(w * x(n))), -0.01, 0.01)
    assert (low, high) == (pytest.approx(-1.3 * 900, rel=1e-6), pytest.approx(1.3 * 900, rel=1e-6))


def test_a_hardening_spring():
    k, c = hl.parameters("k c", units="N/m N/m^3", values=(100, 5e6))
    hard = hl.Scene(force=k * x(n) + c * x(n) ** 3)
    assert hl.stability.local_stiffness(hard, -0.004, 0.01)[1] == pytest.approx(100 + 3 * 5e6 * 1e-4, rel=1e-4)
    assert hl.stability.local_stiffness(hard, -0.004, 0.01)[0] == pytest.approx(100, rel=1e-4)


@pytest.mark.parametrize("unilateral, least", [("gate", 0), ("clip", 0), (None, 250)])
def test_walls(unilateral, least):
    low, high = hl.stability.local_stiffness(hl.wall(unilateral=unilateral)(k=250, x_o=0.003), -0.01, 0.01)
    assert low == pytest.approx(least, abs=1e-6) and high == pytest.approx(250, rel=1e-9)


@pytest.mark.parametrize("jump", [2e-2, -2e-2, 1e-2, -1e-2, 1e-3, -1e-3, 2e-5])
@pytest.mark.parametrize("where", [0.0, 0.0123456789, -0.0999999])
def test_a_small_jump_beside_a_steep_place_is_found(where, jump):
    """The secant over it, 5 um long, is less than the slope of the rest: 20 mN count for 4000 N/m, 1 mN for 200 N/m."""
    k, place = hl.parameters("k place", units="N/m m", values=(3000, where))
    size = hl.parameters("size", units="N", values=jump, ranges=(-1, 1))
    with pytest.raises(AnalysisError, match="jumps near x = ") as told:
        hl.stability.local_stiffness(hl.Scene(force=k * x(n) + hl.when(x(n) > place, size, 0)), -0.1, 0.1)
    assert float(str(told.value).split("x = ")[1].split(" m")[0]) == pytest.approx(where, abs=1e-5)


@pytest.mark.parametrize("low, high", [(-0.1, 0.1), (0.0, 0.1), (-0.1, 0.0), (-1e-7, 0.1), (0.05, 0.0501)])
def test_kinks_and_bends_are_no_jumps(low, high):
    k, w, kink = hl.parameters("k w kink", units="N/m 1/m m", values=(3000, 5000, 0.0123))
    place = x(n) - kink
    force = k * sp.Max(x(n), 0) + k * sp.Abs(place) + k * sp.sin(w * place) / w + k * sp.tanh(w * place) / w
    k_min, k_max = hl.stability.local_stiffness(hl.Scene(force=force), low, high)
    assert -6000 - 1e-3 <= k_min < k_max <= 12000 + 1e-3


@pytest.mark.parametrize("power", [0.5, 0.8])
def test_an_infinite_slope_is_no_stiffness(power):
    force = A * sp.Piecewise(((w * x(n)) ** power, x(n) > 0), (0, True))
    with pytest.raises(AnalysisError, match="so steep there that it cannot be distinguished"):
        hl.stability.local_stiffness(hl.Scene(force=force), -0.1, 0.1)


def test_a_force_without_a_value_is_named():
    with pytest.raises(AnalysisError, match="no finite value at x = 0 m"):
        hl.stability.local_stiffness(hl.Scene(force=A * w * x(n) / sp.sqrt(sp.Abs(w * x(n)))), -0.1, 0.1)


@pytest.mark.parametrize(
    "scene, words",
    [
        (hl.Scene(force=hl.when(x(n) > 0, A)), "jumps near x = "),
        (hl.wall("ellis")(k=1), "x\\(n - 1\\)"),
        (hl.wall(), "k has no value"),
        (hl.Scene(force=A * sp.sin(hl.parameters("f", units="1/s", values=1) * t)), "contains t"),
    ],
)
def test_it_says_what_it_needs(scene, words):
    with pytest.raises(AnalysisError, match=words):
        hl.stability.local_stiffness(scene, -0.01, 0.01)
    with pytest.raises(AnalysisError, match="x_low < x_high"):
        hl.stability.local_stiffness(scene, 0.01, math.nan)
