"""The frequency of a recorded oscillation, against oscillations that are known."""

import numpy as np
import pytest
from scipy.signal import periodogram

import hapticlab as hl
from hapticlab.base.telemetry import Telemetry
from hapticlab.errors import AnalysisError


@pytest.mark.parametrize("hertz", [1.3, 7.0, 34.5])
def test_a_sinusoid_about_any_mean_has_its_frequency(hertz):
    t = np.arange(0, 3, 1e-3)
    x = 0.02 + 0.01 * np.sin(2 * np.pi * hertz * t + 0.4)
    found = hl.records.frequency(Telemetry(t=t, x=x, v=0 * t, F=3 * x, T=1e-3), "F")
    assert found == pytest.approx(hertz, rel=3e-3)


def test_a_handle_on_a_spring_swings_at_its_natural_frequency():
    log = hl.SimulatedPaddle(m=0.05, b=0, T=1e-3, hand=hl.Hand(k=80)).run(hl.wall()(k=0), duration=2.0, x=0.01)
    assert hl.records.frequency(log) == pytest.approx(np.sqrt(80 / 0.05) / (2 * np.pi), rel=1e-3)


def test_what_holds_no_two_cycles_is_rejected():
    t = np.arange(0, 0.1, 1e-3)
    log = Telemetry(t=t, x=t, v=0 * t, F=0 * t, T=1e-3)
    with pytest.raises(AnalysisError, match=r"1 upward crossing\(s\) of its mean and a frequency needs two"):
        hl.records.frequency(log)
    with pytest.raises(AnalysisError, match="theta was not recorded; this log has t, x, v, F"):
        hl.records.frequency(log, "theta")


def test_only_what_comes_after_begin_is_used():
    t = 7.0 + np.arange(0, 3, 1e-3)
    x = np.where(t < 8, 0.5, 0.01 * np.sin(2 * np.pi * 4 * t))
    log = Telemetry(t=t, x=x, v=0 * t, F=0 * t, T=1e-3)
    assert hl.records.frequency(log, begin=1.0) == pytest.approx(4.0, rel=1e-6)
    with pytest.raises(AnalysisError, match="a frequency needs two"):
        hl.records.frequency(log)


def record(x, T=1e-3):
    t = T * np.arange(len(x))
    return Telemetry(t=t, x=x, v=0 * t, F=0 * t, T=T)


def noise(size, seed=7):
    return np.random.default_rng(seed).standard_normal(size)


@pytest.mark.parametrize("hertz", [3.0, 11.7, 60.0])
def test_noise_about_the_mean_adds_no_cycles(hertz):
    t = 1e-3 * np.arange(4000)
    x = 0.01 * np.sin(2 * np.pi * hertz * t) + 5e-4 * noise(4000)
    found = hl.records.frequency(record(x))
    of_bins, power = periodogram(x, fs=1e3)
    assert found == pytest.approx(hertz, rel=5e-3)
    assert found == pytest.approx(of_bins[power.argmax()], abs=1 / 4.0)


@pytest.mark.parametrize("samples", [2, 4, 7])
def test_a_square_wave_of_few_samples_has_its_frequency(samples):
    assert hl.records.frequency(record(np.resize([1.0] * samples + [-1.0] * samples, 600))) == pytest.approx(500 / samples)


@pytest.mark.parametrize("swing", [0.0, 1e-6, 1e-5, 2.5e-5])
@pytest.mark.parametrize("hertz", [3.0, 30.0])
def test_noise_has_no_frequency(hertz, swing):
    x = swing * np.sin(2 * np.pi * hertz * 1e-3 * np.arange(2000)) + 1e-5 * noise(2000)
    with pytest.raises(AnalysisError, match="a frequency needs cycles that are about equally long"):
        hl.records.frequency(record(x))


@pytest.mark.parametrize("hertz", [5.0, 199.0, 331.0, 350.0, 401.0, 450.0, 499.0])
def test_fewer_than_three_samples_per_cycle_are_refused(hertz):
    log = record(np.sin(2 * np.pi * hertz * 1e-3 * np.arange(2000) + 0.3))
    if hertz < 1e3 / 3:
        assert hl.records.frequency(log) == pytest.approx(hertz, rel=2e-3)
    else:
        with pytest.raises(AnalysisError, match="fewer than three samples per cycle|about equally long|a frequency needs two"):
            hl.records.frequency(log)


def test_what_is_not_finite_is_refused_where_it_is_used():
    x = np.sin(2 * np.pi * 5 * 1e-3 * np.arange(2000))
    x[77] = np.nan
    with pytest.raises(AnalysisError, match=r"x = nan at t = 0\.077 s; a frequency needs finite values"):
        hl.records.frequency(record(x))
    assert hl.records.frequency(record(x), begin="100 ms") == pytest.approx(5.0, rel=1e-3)
    with pytest.raises(AnalysisError, match="begin = 'late'; frequency needs a finite begin"):
        hl.records.frequency(record(x), begin="late")
