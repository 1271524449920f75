"""Driven motion, told apart from chatter: the same handle with the same wall, stable and unstable, known beforehand."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.records.driven_motion import by_loop, following
from hapticlab.base.telemetry import Telemetry

pytest.importorskip("llvmlite")  # some ten thousand ticks
T = 1e-3


def tremor(t):
    return 0.02 + 0.003 * np.sin(2 * np.pi * 9 * t)


def run(k, seconds=4.0, **hand):
    hand = hl.Hand(m=0.02, b=1.0, k=200.0, **hand)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=T, hand=hand)
    return paddle, paddle.run(hl.wall()(k=k, x_o=0.0), duration=seconds, progress=False)


def test_a_tremor_on_a_stable_wall_is_driven_and_was_taken_for_chatter():
    paddle, log = run(500, seconds=2.0, intent=tremor)
    assert hl.stability_limit(paddle).K > 2000  # so nothing oscillates by itself
    assert hl.chatter(log).state == "chatter"
    found = hl.chatter(log, driven=paddle.hand)
    assert found.state == "driven" and not found.locked
    s = 2j * np.pi * 9
    spring = 500 * (1 - np.exp(-s * T)) / (s * T)  # held
    expected = 0.003 * abs((200 + s) / (0.07 * s**2 + 1.3 * s + 200 + spring))
    assert found.driven == pytest.approx(expected, rel=1e-3)  # peak-to-peak of samples, 111 a cycle: cos(pi/111)
    assert "follow the excitation of the handle;" in str(found)


@pytest.mark.wide
def test_a_tremor_that_leaves_the_wall_and_comes_back_is_driven():
    paddle, log = run(500, intent=lambda t: tremor(t) - 0.02)
    assert hl.chatter(log, driven=paddle.hand).state == "driven"
    assert hl.chatter(log, driven=lambda t: np.sin(2 * np.pi * 9 * t)).state == "driven"  # size and unit do not matter


def test_chatter_beside_a_tremor_is_found_at_its_own_frequency():
    """Above the limit the wall oscillates at some 30 Hz beside the 9 Hz of the hand."""
    paddle, log = run(3000, seconds=2.0, intent=tremor)
    limit = hl.stability_limit(paddle)
    assert limit.K < 3000
    found = hl.chatter(log, driven=paddle.hand)
    assert found.state == "chatter" and found.driven > 1e-4
    assert found.frequency == pytest.approx(limit.frequency, rel=0.03)  # out of contact now and then, a bit slower
    assert "that follow the excitation" in str(found)


@pytest.mark.parametrize("k", [500, 2000])
@pytest.mark.always("2000")
def test_noise_of_the_hand_rings_a_lightly_damped_handle(k):
    """At 2000 N/m the resonance remembers for longer than any finite memory of the fit: a linear loop explains it."""
    paddle, log = run(k, intent=0.02, push_noise=0.5)
    shakes = paddle.inputs(len(log))[:, -1]
    assert hl.chatter(log).state in ("chatter", "growing")
    assert hl.chatter(log, driven=shakes).state == "driven"
    other = np.random.default_rng(5).standard_normal(len(log))  # another noise explains nothing
    assert hl.chatter(log, driven=other).state in ("chatter", "growing", "decaying")


@pytest.mark.wide
def test_a_vibration_that_the_scene_makes_is_driven_by_its_channel():
    import sympy as sp

    A, f = hl.parameters("A f", units="N 1/s", values=(0.5, 40.0))
    hum = A * sp.sin(2 * sp.pi * f * hl.t)
    wall = hl.wall()(x_o=0.0, k=500)
    scene = hl.Scene(wall.force + hum, watch={"hum": hum}, values=dict(wall.values))
    paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=T, hand=hl.Hand(m=0.02, b=1.0, k=200.0, intent=0.02))
    log = paddle.run(scene, duration=3.0, progress=False)
    assert hl.chatter(log).state == "chatter" and hl.chatter(log, driven="hum").state == "driven"
    assert hl.chatter(log).period == 25  # 40 Hz in samples of a millisecond


def test_a_linear_loop_is_found_exactly():
    """x made by a resonance whose memory is many times the record's eighth; the reference is its own recursion."""
    drive = np.random.default_rng(1).standard_normal(4000)
    radius, angle = 0.9985, 0.2
    x = np.zeros(4000)
    for n in range(2, 4000):
        x[n] = 2 * radius * np.cos(angle) * x[n - 1] - radius**2 * x[n - 2] + drive[n - 1]
    part = by_loop(x, drive)
    assert np.std(part - x[2000:]) < 0.02 * np.std(x)  # its transient of 670 samples began at another rest
    assert np.std(following(x, drive) - x[2000:]) < 0.02 * np.std(x)
    grows = 1.002 ** np.arange(4000) * np.sin(0.2 * np.arange(4000))
    assert by_loop(grows, drive) is None  # a loop that grows by itself is not driven


def test_what_does_not_drive_is_refused():
    _, log = run(500, seconds=0.5, intent=tremor)
    with pytest.raises(hl.errors.AnalysisError, match="does not move;"):
        hl.chatter(log, driven=hl.Hand(push=1.0))
    with pytest.raises(hl.errors.AnalysisError, match="one finite number per sample"):
        hl.chatter(log, driven=np.ones(3))
    with pytest.raises(hl.errors.AnalysisError, match="the drive is constant"):
        hl.chatter(log, driven=np.ones(len(log)))
    with pytest.raises(AttributeError, match="Watch it"):
        hl.chatter(log, driven="hum")


def test_a_handle_that_runs_away_is_not_at_rest():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)
    pushed = paddle.run(hl.wall(unilateral=None)(k=1.0, B=-2.0, x_o=0.0), duration=0.2, x=1e-4, progress=False)
    assert hl.chatter(pushed).state == "runaway" and "faster and faster" in str(hl.chatter(pushed))
    t = np.arange(1000) * T
    settles = 0.012 * (1 - np.exp(-3 * t))
    record = Telemetry(t=t, x=settles, v=0 * t, F=0 * t, T=T)
    assert hl.chatter(record).state == "none"  # on its way still, but slower and slower
