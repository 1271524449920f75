"""The trace against sums by hand; and the failure the chapter names: a human active for long pays for long chatter."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, x
from hapticlab.base.telemetry import Telemetry

T = 1e-3


def test_the_longest_drain_and_both_pairings():
    place = 1e-3 * np.array([0, 1, 2, 3, 2, 1, 2, 1, 0, -1.0])
    F = np.array([1, 1, 2, 2, 3, 1, -1, 4, 4, 0.0])
    log = Telemetry(t=np.arange(10) * T, x=place, v=0 * F, F=F, T=T)
    found = hl.passivity.trace(log)
    W = 1e-3 * np.array([0, 1, 2, 4, 2, -1, 0, 1, -3, -7])
    np.testing.assert_allclose(found.W, W, atol=1e-18)
    np.testing.assert_allclose(found.same_sample, 1e-3 * np.cumsum([0, 1, 2, 2, -3, -1, -1, -4, -4, 0]), atol=1e-18)
    assert found.drained == pytest.approx(11e-3) and found.active == (3 * T, 9 * T)
    assert not found.passive and "violated by 7 mJ at t = 0.009 s" in str(found)
    assert found.observed is None and found.dissipated is None


def test_what_a_damper_took_is_its_force_times_the_motion_it_was_held_over():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)
    scene = hl.laws.passivity_controller(hl.wall(), alpha_max=20)(k=500)
    log = paddle.run(scene, duration=0.1, x=-0.002, v=0.2, progress=False)
    found = hl.passivity.trace(log)
    spring = np.maximum(500 * log.x, 0)
    np.testing.assert_allclose(found.dissipated[1:], np.cumsum((log.F - spring)[:-1] * np.diff(log.x)), atol=1e-10)
    assert found.passive is False and found.W[-1] == pytest.approx(0, abs=1e-7)  # repaid after leaving
    assert "the controller's damper dissipated 0.158 mJ" in str(found)


@pytest.mark.parametrize("counts", [None, 25_000.0, 4000.0])
def test_an_encoder_hides_no_more_than_its_counts_times_the_changes_of_force(counts):
    """Summed by parts: the error of a sum of F times (count errors' changes) is a count times the force's total variation."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=T, counts_per_metre=counts, hand=hl.Hand(push=1.0))
    log = paddle.run(hl.laws.passivity_observer(hl.wall()(k=500, x_o=0.001)), duration=0.5, progress=False)
    found = hl.passivity.trace(log)
    bound = (1 / counts if counts else 0) * (abs(np.diff(log.F)).sum() + abs(log.F).max())
    assert abs(found.error).max() <= bound + 1e-8  # J, of float32
    assert abs(found.error).max() > (0.01 * bound if counts else 0)
    assert "the observer was wrong by" in str(found)


def honey_before_a_wall():
    """Honey for the hand to stir in, and a wall five times as stiff as b can pay for; the wall's energy."""
    k, B, x_h = hl.parameters("k B_honey x_h", units="N/m N*s/m m", values=(1000, 1, -0.005))
    inside = sp.Max(x(n), 0)
    return hl.Scene(k * inside + hl.when(x(n) < x_h, B * (x(n) - x(n - 1)) / hl.T)), k * inside**2 / 2


def chatter_after(stirring, duration=1.6, credit=None):
    """Return how long the wall chatters by more than 2 mm after the hand has stirred so long and then leans on it [s]."""

    def intent(s):
        return np.where(s < stirring, -0.02 + 0.01 * np.sin(4 * np.pi * s), 0.006)

    hand = hl.Hand(m=0.02, b=0.2, k=200, intent=intent)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hand)
    scene, _ = honey_before_a_wall()
    log = paddle.run(
        hl.laws.passivity_controller(scene, alpha_max=20, credit=credit or hl.laws.Credit()),
        duration=stirring + duration,
        x=-0.02,
        progress=False,
    )
    late = log.t > stirring + 0.1
    peaks = abs(log.x[late] - np.median(log.x[-200:])) > 2e-3
    return float(log.t[late][peaks][-1] - stirring) if peaks.any() else 0.0, log


def test_a_human_who_stirs_for_long_makes_the_wall_chatter_for_long():
    (short, log), (long, _) = chatter_after(0.5), chatter_after(2.0)
    assert short > 0.5 and long > short + 0.25  # s, of chatter that Eq. (23.9) allows: W >= 0 but for one period's leak
    W = hl.energy(log).W
    assert W.min() > -1e-3 and hl.passivity.trace(log).drained > 0.03


@pytest.mark.parametrize("cure, most", [(hl.laws.Credit(credit_max=1e-3), 0.2), (hl.laws.Credit(forget=0.05), 0.5)])
def test_with_a_cure_the_past_does_not_matter(cure, most):
    (short, _), (long, _) = chatter_after(0.5, credit=cure), chatter_after(2.0, credit=cure)
    assert short == pytest.approx(long, abs=0.01) and long < most


def test_the_picture():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)
    log = paddle.run(hl.laws.passivity_observer(hl.wall()(k=500)), duration=0.05, x=-0.002, v=0.2, progress=False)
    (axes,) = hl.passivity.trace(log).plot().axes
    assert axes.get_ylabel() == "energy [mJ]" and axes.get_xlabel() == "time t [s]"
    assert [text.get_text() for text in axes.get_legend().get_texts()][2] == "the observer's"
