"""Distributions beside those of scipy.stats."""

from scipy import stats

from hapticlab.base.statistics import chi_squared, normal, student


def test_distributions():
    assert abs(normal(1.3) - 0.9031995154143897) < 1e-15
    assert abs(float(student(0.95, 58)) - stats.t.ppf(0.975, 58)) < 1e-12
    assert abs(chi_squared(0.9) - stats.chi2.ppf(0.9, 1)) < 1e-12
