"""Maximum-likelihood fits against scipy's own minimum, closed forms, Fisher's information and known curves."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize, minimize_scalar
from scipy.special import ndtr

from hapticlab.errors import AnalysisError
from hapticlab.experiments.likelihood import Likelihood
from hapticlab.experiments.psychometric import Intervals, psychometric
from hapticlab.experiments.response_curves import Psychometric

LEVELS = np.geomspace(0.03, 0.8, 8)


def answers(curve, each=50, seed=1):
    return np.random.default_rng(seed).binomial(each, curve(LEVELS))


@pytest.mark.parametrize("lapse", [None, 0.02])
def test_the_fit_is_the_minimum_that_another_search_finds(lapse):
    right = answers(Psychometric(0.2, 1.2, lapse=0.02))

    def loss(q):
        missed = q[2] if lapse is None else lapse
        F = 2 * ndtr((LEVELS / math.exp(q[0])) ** math.exp(q[1]) / math.sqrt(2)) - 1
        P = np.clip(0.5 + (0.5 - missed) * F, 1e-12, 1 - 1e-12)
        return -float(right @ np.log(P) + (50 - right) @ np.log(1 - P))

    box = [(-4, 1), (-1.5, 3)] + ([(0, 0.06)] if lapse is None else [])
    starts = [[math.log(a), b] + ([0.01] if lapse is None else []) for a in (0.1, 0.3) for b in (0.0, 0.5)]
    best = min((minimize(loss, s, method="Nelder-Mead", bounds=box, options={"xatol": 1e-9, "fatol": 1e-11, "maxiter": 4000})
                for s in starts), key=lambda found: found.fun)  # fmt: skip
    found = psychometric(LEVELS, right, np.full(8, 50), lapse=lapse, intervals=Intervals(bootstrap=2))
    assert found.curve.threshold == pytest.approx(math.exp(best.x[0]), rel=1e-5)
    assert found.curve.slope == pytest.approx(math.exp(best.x[1]), rel=1e-5)


def test_two_levels_are_met_exactly():
    """A Weibull of no lapses through two proportions: ln(-ln(1 - F)) is linear in ln(level)."""
    found = psychometric([0.1, 0.4], [64, 90], [100, 100], shape="weibull", lapse=0.0, intervals=Intervals(bootstrap=2))
    u = [-math.log(1 - (2 * p - 1)) for p in (0.64, 0.90)]
    slope = math.log(u[1] / u[0]) / math.log(4)
    assert found.curve.slope == pytest.approx(slope, rel=1e-7)
    assert found.curve.threshold == pytest.approx(0.1 * u[0] ** (-1 / slope), rel=1e-7)
    assert found.deviance == pytest.approx(0.0, abs=1e-9)


def test_the_interval_is_as_wide_as_fisher_says():
    """Many trials: likelihood ratio against the Cramer-Rao bound from derivatives of the likelihood by finite differences."""
    truth, each = Psychometric(0.2, 1.0), 2000
    found = psychometric(LEVELS, np.round(each * truth(LEVELS)), np.full(8, each), lapse=0.0, intervals=Intervals(bootstrap=2))
    h = 1e-5
    rows = [
        (Psychometric(0.2 * math.exp(h * a), math.exp(h * b))(LEVELS)
         - Psychometric(0.2 * math.exp(-h * a), math.exp(-h * b))(LEVELS)) / (2 * h)
        for a, b in ((1, 0), (0, 1))
    ]  # fmt: skip
    P = truth(LEVELS)
    information = np.array([[np.sum(each * i * j / (P * (1 - P))) for j in rows] for i in rows])
    expected = np.sqrt(np.diag(np.linalg.inv(information)))
    for name, true, deviation in (("threshold", 0.2, expected[0]), ("slope", 1.0, expected[1])):
        low, high = found.interval[name]
        assert getattr(found.curve, name) == pytest.approx(true, rel=3e-3)  # counts are rounded to whole answers
        assert math.log(high / low) == pytest.approx(2 * 1.96 * deviation, rel=0.01)  # 16 000 trials: a parabola but for 1 %


def test_a_fixed_slope_and_guess_as_lapse():
    right = answers(Psychometric(0.2, 1.0))
    assert psychometric(LEVELS, right, np.full(8, 50), slope=1.0, intervals=Intervals(bootstrap=2)).curve.slope == pytest.approx(
        1.0, rel=1e-12
    )
    levels = np.linspace(-1, 1, 5)
    truth = Psychometric(0.1, 2.0, 0.02, 0.02, "normal")
    found = psychometric(
        levels, np.round(1e5 * truth(levels)), np.full(5, 1e5), shape="normal", guess=None, intervals=Intervals(bootstrap=2)
    ).curve
    assert (found.threshold, found.slope, found.lapse) == pytest.approx((0.1, 2.0, 0.02), abs=2e-3)
    assert found.guess == found.lapse


def test_a_wrong_curve_has_a_large_deviance():
    levels, each = np.array([0.1, 0.2, 0.3, 0.4, 0.5]), np.full(5, 200)
    assert psychometric(levels, [110, 180, 120, 190, 130], each, intervals=Intervals(bootstrap=100)).p_deviance == 0.0
    truth = Psychometric(0.2, 1.0)
    p = [
        psychometric(LEVELS, answers(truth, seed=k), np.full(8, 50), lapse=0.0, intervals=Intervals(bootstrap=60)).p_deviance
        for k in range(12)
    ]
    assert 0.2 < np.mean(p) < 0.8  # uniform: mean 0.5, standard deviation of the mean 0.08


def test_gradient_and_information_of_the_likelihood():
    fitting = Likelihood(LEVELS, np.full(8, 50.0), "d_prime", 0.5, None)
    right, q, h = answers(Psychometric(0.2, 1.0)).astype(float), np.array([math.log(0.25), 0.2, 0.03]), 1e-6
    _, gradient, _ = fitting.loss(q, right)
    steps = np.eye(3) * h
    assert gradient == pytest.approx([(fitting.loss(q + s, right)[0] - fitting.loss(q - s, right)[0]) / (2 * h) for s in steps],
                                     rel=1e-6)  # fmt: skip
    expected = 50 * fitting.chance(q)[0]  # at expected counts the Hessian is the information
    hessian = [(fitting.loss(q + s, expected)[1] - fitting.loss(q - s, expected)[1]) / (2 * h) for s in steps]
    np.testing.assert_allclose(fitting.loss(q, expected)[2], hessian, rtol=1e-5)


def test_intervals_end_where_the_likelihood_ratio_says():
    """At each end, the other parameter by scipy's search: 2 log of the ratio is the chi-squared quantile, 3.8415."""
    right = answers(Psychometric(0.2, 1.2), each=40)
    found = psychometric(LEVELS, right, np.full(8, 40), lapse=0.0, intervals=Intervals(bootstrap=1))

    def loss(log_threshold, log_slope):
        P = 0.5 + 0.5 * (2 * ndtr((LEVELS / math.exp(log_threshold)) ** math.exp(log_slope) / math.sqrt(2)) - 1)
        return -float(right @ np.log(P) + (40 - right) @ np.log1p(-np.minimum(P, 1 - 1e-12)))

    least = loss(math.log(found.curve.threshold), math.log(found.curve.slope))
    for name, held in (("threshold", lambda a, b: loss(a, b)), ("slope", lambda a, b: loss(b, a))):
        box = (-1.5, 2.5) if name == "threshold" else (-4.0, 1.0)
        for end in found.interval[name]:
            best = minimize_scalar(lambda b, end=end, held=held: held(math.log(end), b), bounds=box, method="bounded").fun
            assert 2 * (best - least) == pytest.approx(3.8415, abs=0.01)  # ends to a part in 1e4 of what is looked through


def test_samples_say_how_unlikely_an_end_may_be():
    """Ratios at a held threshold against scipy's search over the slope, and intervals that are never narrower for it."""
    q, each = np.array([math.log(0.2), 0.0]), np.full(8, 10.0)
    fitting = Likelihood(LEVELS, each, "d_prime", 0.5, 0.0)
    right = np.random.default_rng(1).binomial(10, Psychometric(0.2, 1.0)(LEVELS), (6, 8)).astype(float)
    _, losses = fitting.most_likely(right, np.tile(q, (6, 1)))
    found = fitting.ratios(right, q, losses)
    for one, least, ratio in zip(right, losses, found[:, 0], strict=True):
        held = minimize_scalar(lambda b, one=one: fitting.loss(np.array([[q[0], b]]), one[None])[0][0],
                               bounds=(fitting.low[1], fitting.high[1]), method="bounded", options={"xatol": 1e-9})  # fmt: skip
        assert ratio == pytest.approx(2 * (held.fun - least), abs=1e-8)
    plain, sampled = (
        psychometric(LEVELS, right[0], each, lapse=0.0, intervals=Intervals(bootstrap=n)).interval for n in (1, 200)
    )
    for name in ("threshold", "slope"):
        assert sampled[name][0] <= plain[name][0] < plain[name][1] <= sampled[name][1]
    assert sampled["threshold"] != plain["threshold"]


def test_answers_without_an_error_leave_the_threshold_open_in_between():
    """Never right at 0.1, always at 0.2: a steep curve anywhere in between explains it, by hand for the steepest."""
    found = psychometric([0.05, 0.1, 0.2, 0.4], [0, 0, 40, 40], [40] * 4, guess=0.0, lapse=0.0, intervals=Intervals(bootstrap=2))
    low, high = found.interval["threshold"]
    # slope 20: 2*40*(-log(1 - F(0.1))) = 3.8415 and 2*40*(-log(F(0.2))) = 3.8415, F = 2 Phi(u/sqrt(2)) - 1 = erf(u/2)
    F = [1 - math.exp(-3.8415 / 80), math.exp(-3.8415 / 80)]
    u = [minimize_scalar(lambda u, F=F: (math.erf(u / 2) - F) ** 2, bounds=(0, 9), method="bounded",
                         options={"xatol": 1e-10}).x for F in F]  # fmt: skip
    assert low == pytest.approx(0.1 * u[0] ** (-1 / 20), rel=2e-3) and high == pytest.approx(0.2 * u[1] ** (-1 / 20), rel=2e-3)
    assert found.interval["slope"][1] == pytest.approx(20.0)


@pytest.mark.parametrize("sets", [20, pytest.param(400, marks=pytest.mark.slow)])
@pytest.mark.wide
def test_intervals_cover_threshold_and_slope_at_forty_trials_a_level(sets):
    """Seven levels of 40 trials: 95 % of sets, where percentiles of a bootstrap hold the slope in 88 %."""
    truth, levels, hits = Psychometric(0.2, 1.0), np.geomspace(0.05, 0.8, 7), np.zeros(2)
    for k in range(sets):
        right = np.random.default_rng(100 + k).binomial(40, truth(levels))
        found = psychometric(
            levels, right, np.full(7, 40), lapse=0.0, intervals=Intervals(bootstrap=100 if sets > 20 else 1)
        ).interval
        hits += [found["threshold"][0] <= 0.2 <= found["threshold"][1], found["slope"][0] <= 1.0 <= found["slope"][1]]
    assert np.all(np.abs(hits / sets - 0.95) < 3 * math.sqrt(0.95 * 0.05 / sets))


def test_answers_that_tell_nothing_are_refused_or_noted():
    with pytest.raises(AnalysisError, match="right and wrong answers at two levels"):
        psychometric([0.1, 0.2], [5, 5], [5, 5])
    with pytest.raises(AnalysisError, match="whole numbers"):
        psychometric([0.1, 0.2], [5, 6], [5, 5])
    with pytest.raises(AnalysisError, match="one entry per level in each"):
        psychometric([0.1, 0.2], [5])
    with pytest.raises(AnalysisError, match="shape='normal'"):
        psychometric([-0.1, 0.2], [1, 0])
    for wrong in ({"confidence": 95}, {"bootstrap": 0}):
        with pytest.raises(AnalysisError, match=next(iter(wrong))):
            Intervals(**wrong)
    for wrong in ({"guess": 1.2}, {"guess": 0.97}):
        with pytest.raises(AnalysisError, match=next(iter(wrong))):
            psychometric([0.1, 0.2], [3, 5], [5, 6], **wrong)
    steep = psychometric([0.1, 0.2], [10, 20], [20, 20], lapse=0.0, intervals=Intervals(bootstrap=20))
    assert any("slope" in note for note in steep.notes) and "slope is at the end" in str(steep)


def test_the_picture():
    figure = psychometric(LEVELS, answers(Psychometric(0.2, 1.0)), np.full(8, 50), intervals=Intervals(bootstrap=20)).plot()
    assert [a.get_xlabel() for a in figure.axes] == ["level [1]"]
