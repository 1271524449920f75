"""Lanes of one program against the sweep, which measures inside the program, and against paddles of another period."""

from dataclasses import replace

import numpy as np
import pytest

from hapticlab.analysis.sweeps.lane_runs import LaneRuns
from hapticlab.analysis.sweeps.sweep import sweep
from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import AnalysisError
from hapticlab.scene.laws.chapter_laws import wall

HAND = Hand(m=0.01, b=0.3, k=40.0, push=1.5)
FULL = SimulatedPaddle(
    m=0.05, b=0.1, T=1e-3, delay=1.3e-3, counts_per_metre=2e4, coulomb=0.05, force_max=8.0, noise=1e-5, seed=4, hand=HAND
)
SCENE = wall("backward_difference")(x_o=0.0, k=1.0)
K = np.array([60.0, 150.0, 420.0, 1300.0])


@pytest.mark.parametrize("paddle", [FULL, replace(FULL, noise=0.0, coulomb=0.0, delay=0.0, counts_per_metre=None)])
def test_lanes_measure_what_a_sweep_measures(paddle):
    stiffness = np.linspace(60, 3000, 200)  # so many that turns fall on the ends of the quarters
    runs = LaneRuns(SCENE, 0.403, workers=1)
    amplitude, last, fault = runs.chatter(paddle, {"k": stiffness, "B": np.full(200, 0.05)}, start=(0.001, 0.2))
    expected = sweep(SCENE, paddle, duration=0.403, progress=False, k=stiffness, B=0.05, x=0.001, v=0.2)
    # where bounces shrink slowly a map goes by theory, and a sweep, which knows none, says that it cannot tell
    slow = np.isnan(expected.values) & (last > 0)
    np.testing.assert_array_equal(amplitude, np.where(slow, 0.0, expected.values))
    assert last.max() > 0 and not fault.any()
    assert (last >= np.nan_to_num(amplitude)).all()


def test_lanes_of_many_structures():
    """Delays of none, a part, one and more periods, with friction and without: a program each, and all at their places."""
    pytest.importorskip("llvmlite")  # friction, over many lanes
    delay, coulomb = np.array([0.0, 0.4e-3, 1e-3, 1.4e-3]), np.array([0.0, 0.02, 0.0, 0.02])
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=HAND)
    amplitude, _, _ = LaneRuns(SCENE, 0.3).chatter(paddle, {"k": K[::-1], "delay": delay, "coulomb": coulomb})
    for at in range(4):
        one = replace(paddle, delay=delay[at], coulomb=coulomb[at])
        expected = sweep(SCENE, one, duration=0.3, progress=False, k=[K[3 - at]], v=0.1)
        np.testing.assert_array_equal(amplitude[at], expected.values[0])


@pytest.mark.parametrize("law", ["zoh", "half_sample"])
@pytest.mark.always("half_sample")
def test_another_period_by_similarity(law):
    """Masses by T squared, dampers by T: sample for sample the motion of a paddle of that period, in its own program."""
    pytest.importorskip("llvmlite")  # friction, over many lanes
    scene = wall(law)(x_o=0.0, k=1.0)
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, delay=0.6e-3, coulomb=0.01 * (law == "zoh"), hand=HAND)
    runs = LaneRuns(scene, 0.5)
    for T in (0.7e-3, 2.3e-3):
        columns = {"k": K, "B": np.full(4, 0.03), "T": np.full(4, T), "b": np.array([0.1, 0.2, 0.1, 0.2])}
        amplitude, last, _ = runs.chatter(paddle, columns)
        del columns["T"]
        own, own_last, _ = LaneRuns(scene, 0.5).chatter(replace(paddle, T=T), columns)
        assert (last > 1e-3).all()
        np.testing.assert_array_equal(np.isnan(amplitude), np.isnan(own))
        np.testing.assert_allclose(last, own_last, rtol=1e-5)  # the scene is float32, and B/T rounds otherwise


def test_a_force_that_is_not_finite_is_a_fault():
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=HAND)
    amplitude, _, fault = LaneRuns(SCENE, 0.2).chatter(paddle, {"k": np.array([100.0, 1e38])})
    assert fault.tolist() == [False, True] and not np.isnan(amplitude[0])


def test_machine_code_is_kept():
    runs, columns = LaneRuns(SCENE, 0.1), {"k": K}
    runs.chatter(SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=HAND), columns)
    kept = dict(runs._loaded)
    runs.chatter(SimulatedPaddle(m=0.2, b=0.3, T=1e-3, hand=replace(HAND, b=1.0)), columns)
    assert runs._loaded == kept


def test_too_short_a_run_and_a_hand_that_moves_are_refused():
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=HAND)
    with pytest.raises(AnalysisError, match="20 samples of T = 0.001 s; needs at least 32"):
        LaneRuns(SCENE, 0.02).chatter(paddle, {"k": K})
    moving = replace(paddle, hand=replace(HAND, intent=lambda t: 0.01 * np.sin(t)))
    with pytest.raises(AnalysisError, match="T is an axis, and the hand moves or there is noise,"):
        LaneRuns(SCENE, 0.2).chatter(moving, {"k": K, "T": np.full(4, 2e-3)})
