"""Statistics against SciPy, a published example, tables by hand and closed forms."""

import numpy as np
import pytest
from scipy import stats

from hapticlab.grading.concepts.item_statistics import difficulty, discrimination, effect_size, gain, interval, reliability

#: ten students and ten questions: K. L. Wuensch, East Carolina University, "The Kuder-Richardson 20",
#: core.ecu.edu/wuenschk/StatHelp/KR20.txt, which prints p, the sum of p q and the variance of the totals
WUENSCH = np.array([[int(digit) for digit in row] for row in (
    "1111110110", "1011011101", "1111011001", "0010001000", "0000010010", "1110111111", "1101110111", "1111111101", "0101111101",
    "1101101110",
)], dtype=float)  # fmt: skip


def test_a_published_example():
    assert difficulty(WUENSCH) == pytest.approx([0.7, 0.7, 0.6, 0.7, 0.6, 0.8, 0.7, 0.7, 0.5, 0.6])
    printed = 0.21 + 0.21 + 0.24 + 0.21 + 0.24 + 0.16 + 0.21 + 0.21 + 0.25 + 0.24
    assert reliability(WUENSCH) == pytest.approx(10 / 9 * (1 - printed / 5.84))


def random_scores(seed=1, students=60, questions=12):
    random = np.random.default_rng(seed)
    ability = random.normal(size=(students, 1))
    return (ability + random.normal(size=(students, questions)) > 0.2).astype(float)


def test_discrimination_is_the_correlation_of_scipy():
    scores = random_scores()
    expected = [stats.pointbiserialr(scores[:, k], np.delete(scores, k, axis=1).sum(axis=1))[0] for k in range(scores.shape[1])]
    assert discrimination(scores) == pytest.approx(expected, abs=1e-12)
    scores[:, 3] = 1
    assert np.isnan(discrimination(scores)[3]) and np.isfinite(np.delete(discrimination(scores), 3)).all()


def test_reliability_is_cronbachs_alpha_of_covariances():
    """A second derivation: from the mean variance and the mean covariance of questions."""
    scores = random_scores(2)
    covariance = np.cov(scores.T, ddof=0)
    count = len(covariance)
    mean_variance = np.trace(covariance) / count
    mean_covariance = (covariance.sum() - np.trace(covariance)) / (count * (count - 1))
    assert reliability(scores) == pytest.approx(count * mean_covariance / (mean_variance + (count - 1) * mean_covariance))
    same = np.repeat(scores[:, :1], 4, axis=1)
    assert reliability(same) == pytest.approx(1.0)
    assert np.isnan(reliability(np.ones((5, 4)))) and np.isnan(reliability(np.array([[1.0], [0.0]])))


def test_reliability_of_independent_questions_is_near_zero():
    scores = (np.random.default_rng(3).random((20_000, 10)) < 0.5).astype(float)
    assert abs(reliability(scores)) < 0.03


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [(0.4, 0.7, 0.5), (0.5, 0.5, 0.0), (0.5, 0.25, -0.5), (0.0, 1.0, 1.0), (0.28, 0.445, 0.165 / 0.72), (1.0, 1.0, np.nan)],
)
def test_gains_by_hand(before, after, expected):
    """Hake's definition: of the mean scores of a class; none where all was right before."""
    assert float(gain(before, after)) == pytest.approx(expected, nan_ok=True)


def test_the_effect_size_by_hand():
    """Totals 1, 2, 3 before and 3, 4, 5 after: a difference of 2, variances of 1."""
    before = np.array([[1, 0, 0, 0, 0], [1, 1, 0, 0, 0], [1, 1, 1, 0, 0]])
    after = np.array([[1, 1, 1, 0, 0], [1, 1, 1, 1, 0], [1, 1, 1, 1, 1]])
    assert effect_size(before, after) == pytest.approx(2.0)
    assert np.isnan(effect_size(before[:1], after[:1]))


def test_an_interval_is_that_of_scipys_bootstrap():
    before, after = random_scores(4), np.maximum(random_scores(4), random_scores(5))
    found = interval(gain, before, after, seed=2)

    def of_rows(rows):
        return float(gain(before[rows].mean(), after[rows].mean()))

    rows, random = (np.arange(len(before)),), np.random.default_rng(9)
    other = stats.bootstrap(rows, of_rows, vectorized=False, method="percentile", n_resamples=2000, random_state=random)
    assert found == pytest.approx((other.confidence_interval.low, other.confidence_interval.high), abs=0.02)
    assert found == interval(gain, before, after, seed=2)


def test_the_interval_of_many_students_is_the_normal_one():
    scores = np.r_[np.ones(240), np.zeros(160)][:, None]
    low, high = interval(lambda mean: mean, scores, seed=1)
    assert (high - low) / 2 == pytest.approx(1.96 * np.sqrt(0.6 * 0.4 / 400), rel=0.08)
    assert (high + low) / 2 == pytest.approx(0.6, abs=0.005)


def test_an_interval_contains_the_truth_as_often_as_it_says():
    random, inside = np.random.default_rng(6), 0
    for k in range(60):
        low, high = interval(lambda mean: mean, (random.random((40, 1)) < 0.6).astype(float), seed=k)
        inside += low <= 0.6 <= high
    assert 51 <= inside <= 60  # of 60 at 95 %: 57 expected, and percentile intervals of 40 are a little narrow


def test_few_students_have_no_interval():
    assert np.isnan(interval(gain, np.zeros((1, 3)), np.ones((1, 3)))).all()
    two_alike = np.array([[1, 0, 0], [0, 1, 0]])  # whose classes drawn again all have the mean 1/3: an interval of no width
    assert np.isnan(interval(lambda mean: mean, two_alike)).all()
    assert np.isfinite(interval(lambda mean: mean, random_scores(4)[:10])).all()
    assert np.isnan(interval(gain, np.ones((12, 3)), np.ones((12, 3)))).all()
