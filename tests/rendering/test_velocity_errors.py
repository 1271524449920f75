"""The comparison of estimators against lags and noise gains of their impulse responses."""

import numpy as np
import pytest
from scipy.signal import lfilter

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.errors import AnalysisError
from hapticlab.rendering.velocity_errors import velocity_errors

T, NOISE = 1e-3, 4e-6
LINEAR = [hl.velocity.backward(), hl.velocity.filtered(tau=3e-3), hl.velocity.kalman(acceleration=2, noise=NOISE)]
IMPULSE = np.eye(1, 4000)[0]


@pytest.fixture(scope="module")
def log():
    """A slow, smooth motion with noise on its positions."""
    hand = hl.Hand(k=600, b=5, intent=lambda t: 0.008 * (1 - np.cos(5 * t)))
    return hl.SimulatedPaddle(m=0.05, b=0.1, T=T, noise=NOISE, seed=3, hand=hand).run(hl.wall()(k=0), duration=4.0)


@pytest.fixture(scope="module")
def found(log):
    return velocity_errors(log, LINEAR[1:])


@pytest.mark.parametrize("estimate", LINEAR, ids=lambda e: e.name)
def test_lag_and_noise_are_those_of_the_impulse_response(found, estimate):
    """h is the answer to one position: its first moment is the lag of a ramp, its energy the gain of white noise."""
    row, h = found[estimate.name], lfilter(*estimate.transfer(T), IMPULSE)
    ramps = np.cumsum(h)  # the answer to a step of position; its sum times T is 1
    lag = T * (np.sum(np.arange(len(h)) * ramps) / np.sum(ramps) + 0.5)
    # 4000 samples know a root mean square to 2 %, and the least squares of the lag to noise/acceleration/63
    assert row.noise == pytest.approx(NOISE * np.sqrt(np.sum(h**2)), rel=0.05)
    assert row.lag == pytest.approx(lag, abs=3 * row.noise / 0.14 / np.sqrt(4000) + 0.02 * lag)
    assert row.rms == pytest.approx(np.hypot(row.noise, row.lag * 0.14), rel=0.05)


def test_the_load_is_that_of_a_damper_with_this_velocity(found):
    for row, estimate in zip(found.rows, LINEAR, strict=True):
        taken = cost(hl.compile(hl.laws.virtual_damper(velocity=estimate)(B=1), T=T))
        assert (row.cycles, row.fits) == (taken.typical, taken.fits)


def test_it_prints_a_table_and_draws_both_sides(found, log):
    lines = str(found).splitlines()
    assert len(lines) == 4 and "uno, T = 1 ms" in lines[0] and lines[2].startswith("filtered difference")
    traces, trade = found.plot(0.1, 0.2).axes
    assert [line.get_label() for line in traces.lines][-1] == "true"
    assert len(trade.lines) == 3 and "lag [ms]" in trade.get_xlabel()
    assert velocity_errors(log, LINEAR[1]).rows[1].name == "filtered difference"  # one alone


def test_what_cannot_be_compared_is_refused(log):
    exact = hl.SimulatedPaddle(m=0.05, b=0.1, T=T).run(hl.wall()(k=0), duration=0.01)
    with pytest.raises(AnalysisError, match="no true velocity; run a simulated paddle with an encoder"):
        velocity_errors(exact)
    with pytest.raises(AnalysisError, match=r"give estimates such as hl.velocity.filtered\(tau='4 ms'\)"):
        velocity_errors(log, ["filter"])
