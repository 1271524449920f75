"""Machines with a state: their transitions, their loops and their cycles, against closed forms and plain Python."""

import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x

k, d, x_on, x_off = hl.parameters("k d x_on x_off", units="N/m m m m", values=(150, 3e-3, 8e-3, 6e-3))
s, q = hl.signal("s", unit="1"), hl.signal("q", unit="1")
DOWN = sp.Eq(s(n), hl.when(x(n) > x_on, 1, hl.when(x(n) < x_off, 0, s(n - 1))))
TOGGLES = sp.Eq(q(n), hl.when(s(n) > s(n - 1), 1 - q(n - 1), q(n - 1)))


def force(scene, path):
    return hl.records.evaluate(hl.compile(scene, T=1e-3, dtype="float64"), x=path).F


@pytest.mark.parametrize("sense", [1, -1])
def test_the_area_of_a_click_is_two_jumps_apart(sense):
    path = np.r_[np.linspace(0, 0.012, 6001), np.linspace(0.012, 0, 6001)]
    F = force(hl.Scene(k * (x(n) - d * s(n)), [DOWN])(d=sense * 3e-3), path)
    lost, leak = np.sum(F[:-1] * np.diff(path)), 150 * np.sum(np.diff(path) ** 2) / 2
    late = 2 * 150 * 3e-3 * 0.012 / 6000  # each of the two jumps comes up to a step too late
    assert lost + leak == pytest.approx(sense * 150 * 3e-3 * 2e-3, abs=1.001 * late)


def test_the_order_of_the_equations_does_not_matter():
    path, told, state, presses = np.random.default_rng(1).uniform(0.004, 0.010, 400), [], 0, 0
    for place in path:
        before, state = state, 1 if place > 8e-3 else 0 if place < 6e-3 else state
        presses += state > before
        told.append(150 * (place - 3e-3 * (presses % 2)))
    for eom in ([DOWN, TOGGLES], [TOGGLES, DOWN]):
        np.testing.assert_allclose(force(hl.Scene(k * (x(n) - d * q(n)), eom), path), told, rtol=1e-12)
    assert presses > 20


def test_a_reset_that_is_asked_for_first_wins():
    catch = sp.Eq(s(n), hl.when(x(n) < x_on, 0, hl.when(x(n) > x_off, 1, s(n - 1))))  # both hold in between
    assert (force(hl.Scene(k * x_on * s(n), [catch]), [0.007, 0.009, 0.007]) > 0).tolist() == [False, True, False]


def test_a_relay_has_the_cycle_of_its_band():
    theta, on = hl.coordinate("theta", unit="K", initial=20), hl.signal("on", unit="1")
    tau, hot, low, high = hl.parameters("tau hot low high", units="s K K K", values=(0.5, 50, 19, 21))
    relay = sp.Eq(on(n), hl.when(theta < low, 1, hl.when(theta > high, 0, on(n - 1))))
    scene = hl.Scene(k * x_on * on(n), [relay, sp.Eq(tau * theta.diff(t), hot * on(n) - theta)])
    log = hl.records.evaluate(hl.compile(scene, T=1e-4), x=np.zeros(10_000))
    period = np.diff(np.flatnonzero(np.diff(log.F) > 0)).mean() * 1e-4
    assert 0 < period - 0.5 * math.log((50 - 19) / (50 - 21) * 21 / 19) < 5e-4  # each switch is late by less than a sample


def test_two_states_that_need_each_other_at_once_are_refused():
    circle = [sp.Eq(s(n), hl.when(q(n) > 0, 1, 0)), sp.Eq(q(n), hl.when(s(n) > 0, 0, 1))]
    with pytest.raises(hl.errors.SceneError, match=r"a sample cannot depend on itself; use .\(n-1\) on one side"):
        hl.compile(hl.Scene(k * x(n) * s(n), circle), T=1e-3)
