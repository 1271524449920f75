"""Motions of the handle: derivatives against SymPy's, starts at rest, and what they are made for."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t
from hapticlab.analysis.accuracy.handle_motions import SPEED, TRAVEL, HandleMotion, handle_motions, minimum_jerk
from hapticlab.errors import AnalysisError

MOTIONS = {motion.name: motion for motion in handle_motions()}


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.always("push", "drift")
def test_derivatives_are_those_of_sympy(name):
    motion = MOTIONS[name]
    times = np.array([0.0371, 0.2113, 0.5571, 0.7317, 0.93]) * motion.duration
    found = motion.derivatives(times, 6)
    expr = motion.x
    for order in range(7):
        expected = np.broadcast_to(sp.lambdify(t, expr, "numpy")(times), times.shape)
        # a derivative of order k is made of terms of the size omega^k: nothing cancels in 1e-9 of the largest
        assert np.allclose(found[order], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max()), order
        expr = sp.diff(expr, t)


@pytest.mark.parametrize("name", MOTIONS)
def test_a_motion_starts_at_rest_at_zero_and_stays_within_the_travel(name):
    motion = MOTIONS[name]
    start = np.array(motion.at([0.0]))[:, 0]
    assert np.allclose(start, 0, atol=1e-15)
    x, v, _ = motion.at(np.linspace(0, motion.duration, 2001))
    assert 0.1 * TRAVEL < np.abs(x).max() < TRAVEL or np.abs(v).max() > 0.9 * SPEED
    assert np.abs(x).max() < TRAVEL


def test_a_motion_is_continuous_with_its_acceleration_where_its_cases_change():
    push = MOTIONS["push"]
    for instant in push.breaks:
        before, after = (np.array(push.at([instant + side])) for side in (-1e-9, 1e-9))
        assert np.allclose(before, after, rtol=0, atol=[[1e-9], [1e-7], [1e-4]])  # jerk 60 d/T^3 times 2 ns at most


def test_the_band_is_met_and_no_period_is_a_whole_number_of_samples():
    for name, f in (("slow sinusoid", np.sqrt(0.5)), ("quick sinusoid", 5 * np.sqrt(2))):
        motion = MOTIONS[name]
        times = np.linspace(0.3, motion.duration, 20001)
        x = motion.at(times)[0]
        crossings = np.flatnonzero(x[1:] * x[:-1] < 0)
        halves = np.diff(times[crossings])
        assert len(halves) == 0 or np.allclose(halves, 0.5 / f, atol=1e-4)
        for T in (2e-3, 1e-3, 5e-4):
            assert abs(1 / f / T - round(1 / f / T)) > 1e-3


def test_the_hand_is_drawn_by_its_seed():
    times = [0.2, 0.9]
    one, same, other = (handle_motions(seed=seed)[4].at(times)[0] for seed in (3, 3, 4))
    assert np.array_equal(one, same) and not np.allclose(one, other)


def test_minimum_jerk_goes_from_rest_to_rest():
    s = sp.Symbol("s")
    for order, ends in ((0, (0, 1)), (1, (0, 0)), (2, (0, 0))):
        expr = sp.diff(minimum_jerk(s), s, order)
        assert (expr.subs(s, 0), expr.subs(s, 1)) == ends


def test_a_motion_scales():
    twice = MOTIONS["push"].scaled(2)
    assert np.allclose(np.array(twice.at([0.1, 0.6])), 2 * np.array(MOTIONS["push"].at([0.1, 0.6])))
    assert twice.breaks == MOTIONS["push"].breaks


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: HandleMotion("one", hl.x(t), 1.0), "an expression of hl.t and numbers"),
        (lambda: HandleMotion("one", sp.Symbol("a") * t, 1.0), "an expression of hl.t and numbers"),
        (lambda: HandleMotion("one", t, 0.0), "duration > 0 s"),
        (lambda: handle_motions(band=(2, 1)), "0 < low < high"),
        (lambda: handle_motions(travel=0), "needs travel > 0"),
    ],
)
def test_what_is_no_motion_is_refused(made, said):
    with pytest.raises(AnalysisError, match=said):
        made()
