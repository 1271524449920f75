"""Likelihood of Gaussian and counted positions, against scipy's distributions and differences."""

import numpy as np
import pytest
from scipy.stats import norm

from hapticlab.identification.sensor import information, log_likelihood, run_weights, spread

REST = np.array([[0.0], [3e-6], [-7e-6], [2e-5], [-4e-5]])
COUNTED = np.array([True])


@pytest.mark.parametrize(("sigma", "quantum"), [(1e-5, 1.28e-5), (3e-6, 1.28e-5), (1e-5, 2e-6)])
def test_a_count_is_as_likely_as_scipy_says(sigma, quantum):
    expected = np.log(norm.cdf((REST + quantum / 2) / sigma) - norm.cdf((REST - quantum / 2) / sigma))
    np.testing.assert_allclose(log_likelihood(REST, np.array([sigma]), quantum, COUNTED), expected, rtol=1e-9)


@pytest.mark.parametrize("counted", [True, False])
def test_score_and_information_are_the_slopes_of_the_likelihood(counted):
    sigma, quantum, flag, h = np.array([5e-6]), 1.28e-5, np.array([counted]), 1e-9
    at = [log_likelihood(REST + k * h, sigma, quantum, flag) for k in (-1, 0, 1)]
    score, info = information(REST, sigma, quantum, flag)
    # the residual falls as the position grows; second differences keep six digits
    np.testing.assert_allclose(score, -(at[2] - at[0]) / (2 * h), rtol=1e-6, atol=1e-3)
    np.testing.assert_allclose(info, -(at[2] - 2 * at[1] + at[0]) / h**2, rtol=2e-4)


def test_a_count_far_off_still_pulls():
    score, info = information(np.array([[1e-2]]), np.array([1e-6]), 1e-5, COUNTED)
    assert score[0, 0] == pytest.approx(1e10) and info[0, 0] == pytest.approx(1e12)


def test_the_mean_information_of_a_count_is_fishers():
    """The slope of each count's probability by the position, squared, over that probability, summed over the counts."""
    sigma, quantum, position = 4e-6, 1.28e-5, 5e-6
    counts = np.arange(-2, 3)  # from -7.6 to 8.4 sigma
    low = counts * quantum - position
    chance = norm.cdf((low + quantum) / sigma) - norm.cdf(low / sigma)
    observed = information((low + quantum / 2)[:, None], np.array([sigma]), quantum, COUNTED)[1][:, 0]
    slope = (norm.pdf(low / sigma) - norm.pdf((low + quantum) / sigma)) / sigma
    assert np.sum(chance * observed) == pytest.approx(np.sum(slope**2 / chance), rel=1e-9)


@pytest.mark.parametrize("part", [0.3, 0.8, 3.0])
def test_spread_finds_the_noise_under_the_counts(part):
    draws, quantum = np.random.default_rng(5), 1e-5
    places = draws.uniform(0, 1e-2, (20000, 1))
    sensed = (np.floor((places + part * quantum * draws.standard_normal(places.shape)) / quantum) + 0.5) * quantum
    # its standard error is sigma/sqrt(2 N), some more for counting, and the search's grid
    assert spread(sensed - places, quantum)[0] == pytest.approx(part * quantum, rel=0.03)


def test_a_run_of_one_count_tells_as_much_as_one_sample():
    y = np.array([[0.0, 1.0], [0.0, 2.0], [1.0, 3.0], [1.0, 3.0], [1.0, 4.0]])
    expected = [[1 / 2, 1], [1 / 2, 1], [1 / 3, 1 / 2], [1 / 3, 1 / 2], [1 / 3, 1]]
    np.testing.assert_allclose(run_weights(y, 1.0), expected)
    np.testing.assert_array_equal(run_weights(y, 0.0), np.ones_like(y))
