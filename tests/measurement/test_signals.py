"""Periodic test signals against their own spectra."""

import numpy as np
import pytest

from hapticlab.errors import AnalysisError
from hapticlab.measurement.signals import chirp, crest_factor, lines_of, multisine

LINES = np.arange(1, 120, 2)


@pytest.mark.parametrize("phases", ["schroeder", "random", "low_crest"])
def test_a_multisine_has_its_lines_alone_and_all_alike(phases):
    signal = multisine(1000, LINES, phases=phases, seed=3)
    power = abs(np.fft.rfft(signal))
    assert abs(signal).max() == pytest.approx(1.0)
    assert power[LINES] == pytest.approx(power[1], rel=1e-12)
    assert np.delete(power, LINES).max() < 1e-10 * power[1]


def test_low_crest_is_lower_than_schroeder_and_random():
    """A single sine has sqrt 2; random phases of 60 lines have 2.5 to 4, a peak is as improbable as it is high."""
    lowered = [crest_factor(multisine(1000, LINES, phases="low_crest", seed=s)) for s in range(10)]
    random = [crest_factor(multisine(1000, LINES, phases="random", seed=s)) for s in range(10)]
    assert max(lowered) < 1.75 and crest_factor(multisine(1000, LINES)) < 1.9 < min(random)
    assert crest_factor(multisine(1000, [7])) == pytest.approx(np.sqrt(2), rel=1e-3)


def test_seeds_give_other_phases_and_the_same_again():
    one, again, other = (multisine(256, [3, 5, 9], phases="low_crest", seed=s) for s in (1, 1, 2))
    assert np.array_equal(one, again) and abs(one - other).max() > 0.1


def test_a_chirp_closes_on_itself_and_has_power_in_its_band():
    signal = chirp(2000, np.arange(4, 201))
    power = abs(np.fft.rfft(signal)) ** 2
    assert power[4:201].sum() > 0.97 * power.sum()
    assert power[8:190].min() > 0.2 * power[8:190].mean()  # no hole in the band
    assert crest_factor(signal) == pytest.approx(np.sqrt(2), rel=0.02)


def test_lines_are_odd_and_nearest():
    samples, lines = lines_of([3.0, 3.4, 10.2, 101.9], 1e-3, 1.0)
    assert samples == 1000 and lines.tolist() == [3, 11, 101]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: multisine(100, [60]), "below half of the 100 samples"),
        (lambda: multisine(100, [3], phases="flat"), "needs 'schroeder', 'random' or 'low_crest'"),
        (lambda: lines_of([600.0], 1e-3, 1.0), "half the sampling rate, 500 Hz"),
        (lambda: lines_of([5.0], 1e-3, 2e-3), "needs at least 8"),
    ],
)
def test_refusals_say_what_is_needed(call, words):
    with pytest.raises(AnalysisError, match=words):
        call()
