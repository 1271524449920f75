"""Reaches are the quintic of least jerk; tremor keeps to its band."""

import numpy as np
import pytest

from hapticlab.device.hand.hand import Hand
from hapticlab.device.hand.intents import MinimumJerk, Tremor
from hapticlab.errors import PaddleError

REACH = MinimumJerk(start=0.01, end=-0.03, duration=0.4, begin=0.2)


def test_a_reach_is_the_quintic_that_starts_and_ends_at_rest():
    # six conditions fix a quintic: position, velocity, acceleration at both ends; solved here in its own basis
    ends = np.array([[s**p for p in range(6)] for s in (0.0, 1.0)])
    rates = np.array([[p * s ** max(p - 1, 0) for p in range(6)] for s in (0.0, 1.0)])
    bends = np.array([[p * (p - 1) * s ** max(p - 2, 0) for p in range(6)] for s in (0.0, 1.0)])
    quintic = np.linalg.solve(np.vstack([ends, rates, bends]), [0.01, -0.03, 0, 0, 0, 0])
    t = np.linspace(0.2, 0.6, 101)
    s = (t - 0.2) / 0.4
    rate = np.polynomial.polynomial.polyder(quintic)
    found = REACH.at(t)
    for part, expected in zip(found, (quintic, rate / 0.4, np.polynomial.polynomial.polyder(rate) / 0.16), strict=True):
        assert np.allclose(part, np.polynomial.polynomial.polyval(s, expected), atol=1e-12)


def test_a_reach_rests_before_and_after_and_peaks_as_told():
    assert REACH([0.0, 0.2]).tolist() == [0.01, 0.01]
    assert abs(REACH(5.0) + 0.03) < 1e-17
    t = np.linspace(0.2, 0.6, 200_001)
    _, v, a = REACH.at(t)
    assert abs(v).max() == pytest.approx(1.875 * 0.04 / 0.4, rel=1e-9)
    assert abs(a).max() == pytest.approx(10 / np.sqrt(3) * 0.04 / 0.16, rel=1e-9)


def test_tremor_keeps_to_its_band_and_its_size():
    t = np.arange(0, 40, 2e-3)
    x = Tremor(rms=2e-4, low=6.0, high=9.0, seed=5)(t)
    power = abs(np.fft.rfft(x * np.hanning(len(x)))) ** 2
    f = np.fft.rfftfreq(len(x), 2e-3)
    assert power[(f > 5.8) & (f < 9.2)].sum() > 0.9999 * power.sum()
    long = Tremor(rms=2e-4, low=6.0, high=9.0, seed=5)(np.arange(0, 1000, 0.05))
    assert np.std(long) == pytest.approx(2e-4, rel=0.01)  # neighbours 0.075 Hz apart beat 75 times in 1000 s
    assert np.array_equal(x, Tremor(rms=2e-4, low=6.0, high=9.0, seed=5)(t))
    assert not np.allclose(x, Tremor(rms=2e-4, low=6.0, high=9.0, seed=6)(t))


def test_paths_add_up_and_move_a_hand():
    both = REACH + Tremor(rms=1e-4)
    t = np.arange(5) * 0.1
    assert np.array_equal(both(t), REACH(t) + Tremor(rms=1e-4)(t))
    assert np.array_equal(Hand(k=100, intent=both).samples(4, 0.1), both(t))


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: MinimumJerk(end=0.1, duration=0.0), r"duration = 0 s; a reach needs duration > 0"),
        (lambda: MinimumJerk(end=float("nan"), duration=1.0), r"end = nan m; a reach needs a finite end"),
        (lambda: Tremor(rms=-1e-3), r"rms = -0.001 m; a tremor needs rms >= 0"),
        (lambda: Tremor(rms=1e-3, low=12.0, high=8.0), r"high = 8 Hz; a band of tremor needs high > 12"),
        (lambda: Tremor(rms=1e-3, lines=0), r"lines = 0"),
    ],
)
def test_impossible_paths_are_refused(make, said):
    with pytest.raises(PaddleError, match=said):
        make()
