"""Scoring on models whose answers are known: straight lines by least squares, curves by scipy."""

import numpy as np
import pytest
from scipy.optimize import curve_fit
from scipy.stats import t as student_t

from hapticlab.identification.scoring import fit

TIMES = np.linspace(0, 1, 60)


def test_a_line_is_least_squares_with_its_covariance():
    y = 0.3 + 0.7 * TIMES + 0.01 * np.random.default_rng(2).standard_normal(60)
    found = fit(lambda p: p[0] + p[1] * TIMES[:, None, None], y[:, None], [np.zeros((2, 1, 1))], np.ones_like)
    columns = np.column_stack([np.ones(60), TIMES])
    expected, (squares,), *_ = np.linalg.lstsq(columns, y, rcond=None)
    np.testing.assert_allclose(found.values[:, 0], expected, rtol=1e-6)
    np.testing.assert_allclose(found.covariance[0], squares / 58 * np.linalg.inv(columns.T @ columns), rtol=1e-6)
    np.testing.assert_allclose(found.half_width()[:, 0], found.error[:, 0] * student_t.ppf(0.975, 58), rtol=1e-9)
    assert found.converged.all() and not found.counted.any() and not found.blind.any()


def test_a_curve_is_what_scipy_finds():
    draws = np.random.default_rng(3)
    y = np.stack([2 * np.exp(-TIMES * rate) + 0.02 * draws.standard_normal(60) for rate in (3.0, 5.0)], axis=1)
    found = fit(lambda p: p[0] * np.exp(-p[1] * TIMES[:, None, None]), y, [np.full((2, 1, 2), 1.0)], np.ones_like)
    for lane in range(2):
        expected, covariance = curve_fit(lambda t, a, r: a * np.exp(-r * t), TIMES, y[:, lane], (1, 1), xtol=1e-14, ftol=1e-14)
        # both stop within a hundredth of a standard error
        np.testing.assert_allclose(found.values[:, lane], expected, atol=0.01 * found.error[:, lane].min())
        np.testing.assert_allclose(found.covariance[lane], covariance, rtol=0.02)


def test_of_several_guesses_the_nearest_is_taken():
    y = np.sin(20 * TIMES)[:, None]
    guesses = np.array([[[5.0], [19.0], [60.0]]])
    assert abs(fit(lambda p: np.sin(p[0] * TIMES[:, None, None]), y, [guesses], np.ones_like).values[0, 0] - 20) < 1e-6


def test_what_moves_nothing_apart_is_named():
    y = 2 * TIMES[:, None] + 0.01 * np.random.default_rng(1).standard_normal((60, 1))
    found = fit(lambda p: p[0] * p[1] * TIMES[:, None, None], y, [np.ones((2, 1, 1))], np.ones_like)
    assert (np.abs(found.blind[0]) > 0.1).all()


def test_a_bound_holds_and_tells_by_how_much_it_would_be_passed():
    y = 0.3 - 0.1 * TIMES + 0.01 * np.random.default_rng(2).standard_normal(60)
    free, held = (
        fit(lambda p: p[0] + p[1] * TIMES[:, None, None], y[:, None], [np.ones((2, 1, 1))], np.ones_like, low=low)
        for low in (None, np.array([-np.inf, 0.0]))
    )
    np.testing.assert_allclose(held.values[:, 0], [y.mean(), 0.0], atol=1e-6)
    assert held.converged.all() and held.beyond[0, 0] == 0.0
    # in the standard errors of the bounded fit, whose noise takes in the slope
    assert held.beyond[1, 0] == pytest.approx(-free.values[1, 0] / held.error[1, 0], rel=1e-3)
    assert held.beyond[1, 0] > 4


def test_another_start_is_tried_until_noise_alone_is_left():
    y = np.sin(20 * TIMES)[:, None] + 0.01 * np.random.default_rng(1).standard_normal((60, 1))
    starts, tried = (np.array([[[rate]]]) for rate in (5.0, 19.0, 60.0)), []
    found = fit(lambda p: np.sin(p[0] * TIMES[:, None, None]), y, (tried.append(1) or one for one in starts), np.ones_like)
    assert abs(found.values[0, 0] - 20) < 4 * found.error[0, 0]
    assert len(tried) == 2


@pytest.mark.parametrize("slope", [2.0, 5.0])
@pytest.mark.always("5.0")
def test_intervals_of_counts_that_nothing_dithers_cover(slope):
    """Over 20 counts and over 50: 100 lines of random height and slope each."""
    draws = np.random.default_rng(4)
    true = np.stack([draws.uniform(0, 1, 100), slope * draws.uniform(9, 11, 100)])
    y = np.round(true[0] + true[1] * TIMES[:, None])
    found = fit(lambda p: p[0] + p[1] * TIMES[:, None, None], y, [true[:, None]], np.ones_like, quantum=1.0)
    covered = (np.abs(found.values - true) < found.half_width()).mean(axis=1)
    assert not found.counted.any()
    # three standard errors of 100 draws with 95 %
    assert np.all(np.abs(covered - 0.95) < 3 * (0.95 * 0.05 / 100) ** 0.5), covered
