"""What a hand notices of two scenes: beside closed forms of springs, ripples and counts."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.analysis.programs.felt_difference import felt_difference
from hapticlab.analysis.programs.thresholds import Thresholds
from hapticlab.errors import AnalysisError

T = 1e-3
TIME = np.arange(3000) * T
HANDLE = hl.Device(m=0.05, b=0.3, T=T, hand=hl.Hand(m=0.02, b=1.0, k=200))
k, A, p = hl.parameters("k A p", units="N/m N m", values=(500, 0.02, 1e-3))
GROOVES, SMOOTH = hl.Scene(force=k * x(n) + A * sp.sin(2 * sp.pi * x(n) / p)), hl.Scene(force=k * x(n))


def stroke(frequency, reach=0.01):
    return reach * np.sin(2 * np.pi * frequency * TIME)


@pytest.mark.parametrize(("K", "limited_by"), [(500.0, "weber"), (20.0, "force")])
def test_two_springs_are_as_far_apart_as_weber_says(K, limited_by):
    """The hand feels the spring together with the handle's own mass and damper; it needs a least force at any rate."""
    chosen = Thresholds(weber=0.1, force=0.05)
    found = felt_difference(SMOOTH(k=K), SMOOTH(k=0.8 * K), stroke(5.0), HANDLE, thresholds=chosen)
    w, X = 2 * np.pi * 5.0, 0.01 / np.sqrt(2)
    fraction, whole = 0.2 * K * X, X * np.hypot(K - 0.05 * w**2, 0.3 * w)
    assert (0.1 * whole > 0.05) == (limited_by == "weber")
    assert found.force[5:10] == pytest.approx(fraction / max(0.05, 0.1 * whole), rel=5e-3)  # windows of one stroke
    assert found.noticed == (K == 500.0)


@pytest.mark.parametrize("speed", [0.03, 0.08, 0.15])
def test_a_ripple_shakes_handle_and_hand_as_a_mass_on_a_spring(speed):
    found = felt_difference(GROOVES, SMOOTH, speed * TIME, HANDLE)
    f = speed / 1e-3
    w = 2 * np.pi * f
    moved = 0.02 / abs(200 - 0.07 * w**2 + 1j * 1.3 * w)
    least = 0.1e-6 * (200 / f) ** 2  # f < 200 Hz
    assert found.vibration[5:10] == pytest.approx(moved / least, rel=0.02)
    assert found.own_vibration.max() == 0.0  # no encoder
    assert found.noticed and found.force.max() < 1  # far below what is felt as a force


def test_counts_hide_what_is_weaker():
    """At a constant speed the counts are a sawtooth, whose harmonics have the amplitudes K q/(pi j)."""
    q, speed = 2e-4, 5e-3  # 25 counts a second
    coarse = hl.Device(m=0.05, b=0.3, T=T, counts_per_metre=1 / q, hand=HANDLE.hand)
    found = felt_difference(GROOVES(A=0.0), SMOOTH, speed * TIME, coarse)
    f = 25.0 * np.arange(1, 20)
    squares = (500 * q / (np.pi * np.arange(1, 20)) / Thresholds().shaking_force(f, m=0.07, b=1.3, k=200)) ** 2
    assert found.own_vibration[5:10] == pytest.approx(np.sqrt(squares.sum()), rel=0.1)
    assert found.same_bits and not found.noticed and not found.hidden
    weak = felt_difference(GROOVES, SMOOTH, 16 * speed * TIME, coarse)
    assert weak.hidden and not weak.noticed and "hidden by the encoder" in str(weak)
    assert felt_difference(GROOVES, SMOOTH, 16 * speed * TIME, HANDLE).noticed


def test_words_compare_vibration_and_encoder_in_one_window():
    """Noticed in the first window, hidden in the second, where both are larger."""
    found = felt_difference(GROOVES, SMOOTH, stroke(1.0), HANDLE)
    moved = replace(found, force=np.zeros(2), vibration=np.array([1.2, 1.9]), own_vibration=np.array([0.5, 2.7]))
    assert moved.noticed and "1.2 of the vibration threshold (the encoder alone: 0.5)" in str(moved)
    still = replace(moved, own_vibration=np.array([1.3, 2.7]))
    assert still.hidden and "1.9 of the vibration threshold (the encoder alone: 2.7)" in str(still)


def test_a_state_without_a_path_to_the_force_goes_without_a_bit():
    y, z = hl.coordinate("y", unit="m"), hl.coordinate("z", unit="m")
    m, K = hl.parameters("m K", units="kg N/m", values=(0.1, 200))
    F = K * (x(t) - z)
    mass, tail = sp.Eq(m * z.diff(t, 2), F), sp.Eq(m * y.diff(t, 2), K * (z - y))
    shown = hl.Scene(force=F, eom=[mass, tail], watch=[y])
    alone = hl.Scene(force=F, eom=[mass])
    found = felt_difference(shown, alone, stroke(2.0), HANDLE, method="semi_implicit_euler")
    assert found.same_bits and found.ratio == 0.0 and not found.noticed
    assert found.cycles[0] > 1.3 * found.cycles[1] and "the same bits" in str(found)
    assert found.full == pytest.approx(hl.records.evaluate(found.cost[1].program, x=stroke(2.0)).F)


def test_a_record_is_replayed_as_its_encoder_showed_it():
    hand = hl.Hand("pinch", intent=lambda t: 0.01 * np.sin(12 * t))
    paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=T, counts_per_metre=1e4, rounding="nearest", hand=hand)
    log = paddle.run(GROOVES, duration=1.0)
    found, told = (felt_difference(GROOVES, SMOOTH, motion, paddle) for motion in (log, log.x_true))
    assert told.full == pytest.approx(found.full, abs=1e-5)  # a program's positions are of float32
    assert told.vibration == pytest.approx(found.vibration, rel=1e-3) and found.own_vibration.max() > 0.5
    period_unknown = hl.Device(m=0.05, b=0.3, counts_per_metre=1e4, hand=hand)  # the record has its own
    assert np.array_equal(felt_difference(GROOVES, SMOOTH, log, period_unknown).full, found.full)
    real = hl.records.Telemetry(t=log.t, x=log.x, v=log.v, F=log.F, T=T)  # of a board, which knows its counts alone
    counted = felt_difference(GROOVES, SMOOTH, real, paddle)
    assert np.array_equal(counted.full, found.full)
    assert counted.own[50:-50] == pytest.approx(found.own[50:-50], abs=0.05)


def test_what_is_lacking_is_said():
    with pytest.raises(AnalysisError, match="needs two scenes"):
        felt_difference(GROOVES, None, stroke(1.0), HANDLE)
    with pytest.raises(AnalysisError, match="needs at least one window of 0.2 s"):
        felt_difference(GROOVES, SMOOTH, stroke(1.0)[:100], HANDLE)
    with pytest.raises(AnalysisError, match="one finite position"):
        felt_difference(GROOVES, SMOOTH, "fast", HANDLE)
    with pytest.raises(AnalysisError, match=r"needs thresholds, such as hl\.people\.Thresholds"):
        felt_difference(GROOVES, SMOOTH, stroke(1.0), HANDLE, thresholds=0.07)
    with pytest.raises(AnalysisError, match="weber"):
        Thresholds(weber=7)
    assert Thresholds(force="20 mN").force == 0.02


def test_the_picture_has_both_thresholds():
    figure = felt_difference(GROOVES, SMOOTH, stroke(2.0), HANDLE).plot()
    upper, lower = figure.axes
    assert [line.get_label() for line in upper.lines] == ["full scene", "smaller scene"]
    assert [line.get_label() for line in lower.lines] == ["as a force", "as a vibration", "the encoder's own"]
