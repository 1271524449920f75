"""The frequency of a recorded oscillation, against oscillations that are known."""

import numpy as np
import pytest

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
