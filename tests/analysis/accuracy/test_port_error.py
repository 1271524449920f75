"""Errors at the port: of forces whose error is known, and the floor of an encoder against closed forms."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.analysis.accuracy.handle_motions import HandleMotion
from hapticlab.analysis.accuracy.port_error import ForceError, compared, counted, force_error, sensor_floor
from hapticlab.analysis.accuracy.reference import reference
from hapticlab.errors import AnalysisError

OMEGA, A, K = 9.3, 0.02, 300.0
SINE = HandleMotion("sine", A * sp.sin(OMEGA * t), 0.8)
SPRING = hl.Scene(force=hl.parameters("k", units="N/m", values=K) * x(n))
TRUE = reference(SPRING, SINE)


def coupled(hl=hl):
    z = hl.coordinate("z", unit="m")
    m, k, b = hl.parameters("m k b", units="kg N/m N*s/m", values=(0.05, 500, 1.0))
    F = hl.laws.virtual_coupler(z, K=k, b=b)
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)])


def test_a_force_that_is_right_at_the_samples_is_wrong_between_them():
    T = 1e-3
    error = force_error(hl.compile(SPRING, T=T, dtype="float64"), TRUE)
    assert error.max < 1e-14 and error.rms < 1e-14
    assert error.hold == pytest.approx(K * A * OMEGA * T, rel=1e-3)  # at the end of a period F has moved by F' T at most
    # mean over a period of (F' u)^2, u = 0..T, and over a sine of F'^2
    assert error.hold_rms == pytest.approx(K * A * OMEGA * T / np.sqrt(3) / np.sqrt(2), rel=0.05)
    assert error.peak == pytest.approx(K * A, rel=1e-6)


def test_an_error_at_the_samples_is_found_in_size_and_in_the_mean():
    F = TRUE.F[::8] + 0.03 * (-1.0) ** np.arange(len(TRUE.F[::8]))
    error = force_error(F, TRUE, 1e-3)
    assert error.max == pytest.approx(0.03, rel=1e-12) and error.rms == pytest.approx(0.03, rel=1e-12)
    assert error.relative == pytest.approx(0.03 / (K * A), rel=1e-6)
    assert 0.03 < error.hold < 0.03 + K * A * OMEGA * 1e-3


def test_a_delay_moves_the_held_force():
    F, T = TRUE.F[::8], 1e-3
    # felt from T/2 on: right in the middle of its period were F linear, wrong by F' (T/2 + T) at the end of it
    assert compared(F, TRUE, T, delay=T / 2).hold == pytest.approx(K * A * OMEGA * (0.5 + 1) * T, rel=1e-3)


def test_what_blows_up_says_when():
    F = np.where(np.arange(801) < 300, TRUE.F[::8], np.nan)
    error = force_error(F, TRUE, 1e-3)
    assert error.unstable_at == pytest.approx(0.3) and error.max == np.inf
    assert "unstable at t = 0.3 s" in str(error)
    grows = TRUE.F[::8] + 1e-3 * 2.0 ** np.minimum(np.arange(801), 900)
    assert 0 < compared(grows, TRUE, 1e-3).unstable_at < 0.05


def test_a_chaotic_reference_is_compared_up_to_its_horizon():
    from dataclasses import replace

    until = replace(TRUE, horizon=0.4)
    F = np.where(np.arange(801) * 1e-3 <= 0.4, TRUE.F[::8], 1e3)
    assert compared(F, until, 1e-3).max == 0.0


def test_an_error_below_the_doubt_of_the_reference_is_uncertified():
    from dataclasses import replace

    doubtful = replace(TRUE, agreement=1e-3)
    assert not compared(TRUE.F[::8] + 5e-3, doubtful, 1e-3).certified
    assert compared(TRUE.F[::8] + 2e-2, doubtful, 1e-3).certified


def test_zero_order_hold_costs_rk4_ten_percent_of_the_force_and_half_a_period_of_lag():
    scene, T = coupled(), 1e-3
    truth = reference(scene, HandleMotion("sine", 0.01 * sp.sin(2 * sp.pi * 3.17 * t) * (1 - sp.exp(-((t / 0.05) ** 2))), 0.8))
    held, parabola = (force_error(hl.compile(scene, T=T, dtype="float64", hold=hold), truth) for hold in ("zoh", "soh"))
    assert 0.05 < held.relative < 0.15 and parabola.relative < 0.02
    finer = force_error(hl.compile(scene, T=T / 2, dtype="float64", hold="zoh"), truth)
    assert finer.max == pytest.approx(held.max / 2, rel=0.1)  # the hold's order, one, whatever the method's


@pytest.mark.parametrize(("rounding", "most"), [("floor", 1.0), ("nearest", 0.5)])
def test_the_sensor_floor_of_a_spring_is_a_count(rounding, most):
    floor = sensor_floor(SPRING, TRUE, 2e4, 1e-3, rounding=rounding)
    count = 1 / 2e4
    assert 0.97 * most * K * count < floor.max <= most * K * count * (1 + 1e-9)
    # an error spread evenly over a count: its mean square is 1/3 or 1/12 of a count squared
    assert floor.rms == pytest.approx(K * count * (np.sqrt(1 / 3) if rounding == "floor" else np.sqrt(1 / 12)), rel=0.05)


def test_the_sensor_floor_of_a_damper_is_a_count_a_period():
    B, c, T = 1.7, 2e4, 1e-3
    damper = hl.laws.virtual_damper()(B=B)
    floor = sensor_floor(damper, reference(damper, SINE), c, T)
    # the difference of two floors is off by less than a count either way
    assert 0.8 * B / (c * T) < floor.max < B / (c * T)


def test_no_method_gets_below_the_sensor_floor():
    scene, T = coupled(), 1e-3
    motion = HandleMotion("sine", 0.01 * sp.sin(2 * sp.pi * 3.17 * t) * (1 - sp.exp(-((t / 0.05) ** 2))), 0.8)
    truth = reference(scene, motion)
    floors = [sensor_floor(scene, truth, 1e5, T, method=m).max for m in ("semi_implicit_euler", "rk4", "taylor")]
    assert max(floors) < 1.1 * min(floors)
    assert 0.005 < floors[0] < 0.05  # K q + b q/T = 15 mN of a count of 10 um


def test_counts_are_floors_or_the_nearest():
    assert counted(np.array([0.0149, -0.0001, 0.0151]), 100).tolist() == [0.01, -0.01, 0.01]
    assert counted(np.array([0.0149, -0.0001, 0.0151]), 100, "nearest").tolist() == [0.01, 0.0, 0.02]


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: force_error(TRUE.F, TRUE), "does not contain its period."),
        (lambda: force_error(TRUE.F, TRUE, 3e-4), "a step that divides T,"),
        (lambda: sensor_floor(SPRING, TRUE, 0.0, 1e-3), "number > 0 of counts"),
    ],
)
def test_what_cannot_be_compared_is_refused(made, said):
    with pytest.raises(AnalysisError, match=said):
        made()


def test_a_part_of_no_force_is_nothing_or_without_bound():
    assert ForceError(0.0, 0.0, 0.0, 0.0, 0.0).relative == 0.0
    assert ForceError(0.1, 0.1, 0.1, 0.1, 0.0).relative == np.inf
