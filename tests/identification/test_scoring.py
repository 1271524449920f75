"""Scoring on models whose answers are known: straight lines by least squares, curves by scipy."""

import numpy as np
from scipy.optimize import curve_fit
from scipy.stats import t as student_t

from hapticlab.identification.scoring import fit

TIMES = np.linspace(0, 1, 60)


def test_a_line_is_least_squares_with_its_covariance():
    y = 0.3 + 0.7 * TIMES + 0.01 * np.random.default_rng(2).standard_normal(60)
    found = fit(lambda p: p[0] + p[1] * TIMES[:, None, None], y[:, None], np.zeros((2, 1, 1)), np.ones((2, 1)))
    columns = np.column_stack([np.ones(60), TIMES])
    expected, (squares,), *_ = np.linalg.lstsq(columns, y, rcond=None)
    np.testing.assert_allclose(found.values[:, 0], expected, rtol=1e-6)
    np.testing.assert_allclose(found.covariance[0], squares / 58 * np.linalg.inv(columns.T @ columns), rtol=1e-6)
    np.testing.assert_allclose(found.half_width()[:, 0], found.error[:, 0] * student_t.ppf(0.975, 58), rtol=1e-9)
    assert found.converged.all() and not found.counted.any() and not found.blind.any()


def test_a_curve_is_what_scipy_finds():
    draws = np.random.default_rng(3)
    y = np.stack([2 * np.exp(-TIMES * rate) + 0.02 * draws.standard_normal(60) for rate in (3.0, 5.0)], axis=1)
    found = fit(lambda p: p[0] * np.exp(-p[1] * TIMES[:, None, None]), y, np.full((2, 1, 2), 1.0), np.ones((2, 2)))
    for lane in range(2):
        expected, covariance = curve_fit(lambda t, a, r: a * np.exp(-r * t), TIMES, y[:, lane], (1, 1), xtol=1e-14, ftol=1e-14)
        # both stop within a hundredth of a standard error
        np.testing.assert_allclose(found.values[:, lane], expected, atol=0.01 * found.error[:, lane].min())
        np.testing.assert_allclose(found.covariance[lane], covariance, rtol=0.02)


def test_of_several_guesses_the_nearest_is_taken():
    y = np.sin(20 * TIMES)[:, None]
    guesses = np.array([[[5.0], [19.0], [60.0]]])
    assert abs(fit(lambda p: np.sin(p[0] * TIMES[:, None, None]), y, guesses, np.ones((1, 1))).values[0, 0] - 20) < 1e-6


def test_what_moves_nothing_apart_is_named():
    y = 2 * TIMES[:, None] + 0.01 * np.random.default_rng(1).standard_normal((60, 1))
    found = fit(lambda p: p[0] * p[1] * TIMES[:, None, None], y, np.ones((2, 1, 1)), np.ones((2, 1)))
    assert (np.abs(found.blind[0]) > 0.1).all()
