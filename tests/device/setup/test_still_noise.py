"""The noise behind counts: against noise that was put in, at rest anywhere between two counts."""

import numpy as np
import pytest
from workbench import Scripted, paddle

from hapticlab.device.setup.sensor_readings import measure_noise
from hapticlab.device.setup.still_noise import LEAST_SAMPLES, still_noise
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import PaddleError


@pytest.mark.parametrize("sigma", [0.2, 0.5, 1.0, 2.7])
@pytest.mark.always("0.2")
def test_known_noise_is_found_wherever_the_handle_rests(sigma):
    """Within 20 % of it below half a count and 6 % above, where the counts' own deviation is up to 150 % wrong."""
    rng, found, own, held = np.random.default_rng(3), [], [], 0
    for place in np.linspace(0, 1, 16, endpoint=False):
        counts = np.floor(place + sigma * rng.standard_normal(1500))
        one = still_noise(counts)
        found.append(one.value / sigma)
        own.append(counts.std() / sigma)
        held += one.low <= sigma <= one.high
    assert np.abs(np.array(found) - 1).max() < (0.35 if sigma < 0.5 else 0.09)
    assert np.abs(np.array(found) - 1).mean() < (0.15 if sigma < 0.5 else 0.035)
    assert held >= 13  # of 16, with confidence 95 %
    if sigma < 1:
        assert np.abs(np.array(own) - 1).max() > 0.1


def test_a_reading_that_never_changes_tells_a_bound_only():
    still = still_noise(np.full(1000, 71.0))
    assert still.value == still.low == 0.0 and 0.1 < still.high < 0.3
    shifted = still_noise(np.r_[np.full(990, -5.0), np.full(10, -4.0)])
    assert shifted.low == 0.0 < shifted.value < 0.3


def test_calibration_finds_the_noise_of_a_board_at_rest():
    """5 um of noise behind counts of 12.9 um: the counts' own deviation is another, by where the handle rests."""
    board = paddle(mechanics=SimulatedPaddle(m=0.03, b=0.1, T=1e-3, noise=5e-6, seed=2), store=None)
    found, words = measure_noise(board, Scripted(board, {"Let the handle rest": ""}))
    assert found == pytest.approx(5e-6, rel=0.15) and "um rms, between" in words[0]
    wild = paddle(mechanics=SimulatedPaddle(m=0.03, b=0.1, T=1e-3, noise=4e-5), store=None)
    with pytest.raises(PaddleError, match="at rest the reading wanders by .* counts; needs 6 at most"):
        measure_noise(wild, Scripted(wild, {"Let the handle rest": ""}))


def test_what_tells_nothing_is_refused():
    with pytest.raises(PaddleError, match=f"noise: {LEAST_SAMPLES - 1} samples; needs {LEAST_SAMPLES} or more"):
        still_noise(np.zeros(LEAST_SAMPLES - 1))
    with pytest.raises(PaddleError, match="counts are not whole numbers"):
        still_noise(np.full(200, 1e-5))
