"""The interval of a prediction, against closed forms and against paddles drawn from the intervals."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, PaddleError

SPANS = {"m": (0.04, 0.06, "kg"), "b": (0.08, 0.14, "N s/m"), "coulomb": (0.01, 0.06, "N"), "delay": (0.0, 4e-4, "s")}


def twin(*names, **more):
    """A profile with intervals of these names, each value in the middle of its interval."""
    estimates = [hl.identify.Estimate(name, (low + high) / 2, low, high, unit) for name, (low, high, unit) in pick(names)]
    values = {"m": 0.05, "b": 0.11, **{one.name: one.value for one in estimates}, **more}
    return hl.devices.PaddleProfile("toy", **values, estimates=tuple(estimates))


def pick(names):
    return [(name, SPANS[name]) for name in names]


def test_the_passive_wall_is_2_b_over_T_plus_twice_the_delay():
    found = twin("m", "b", "delay").predict(hl.passivity_limit)
    assert found.low == pytest.approx(2 * 0.08 / 1.8e-3, rel=0.08)  # a fraction of a period: up to 8 % below
    assert found.high == pytest.approx(2 * 0.14 / 1e-3) and found.unit == "N/m"
    assert found.low_ends == {"b": "low", "delay": "high"} and found.high_ends == {"b": "high", "delay": "low"}
    assert found.unmoved == ("m",) and found.not_monotone == () and float(found) in found
    assert (found.at_low.b, found.at_low.delay) == (0.08, 4e-4) and found.at_low["m"] == twin("m")["m"]
    assert hl.passivity_limit(found.at_low).K == found.low and hl.passivity_limit(found.at_high).K == found.high


def test_which_end_is_the_safe_one_depends_on_the_question():
    """Damping bears a stiff wall, and is felt where nothing is rendered."""
    assert twin("b").predict(hl.passivity_limit).low_ends == {"b": "low"}
    felt = twin("b").predict(lambda paddle: 0.2 * paddle.b)  # N at 0.2 m/s in free air
    assert (felt.low, felt.high, felt.unit) == (0.2 * 0.08, 0.2 * 0.14, "") and felt.high_ends == {"b": "high"}


def test_what_binds_at_one_corner_only_is_seen():
    """min(2 b/T, 2 f_c/Delta): at the values the hold binds; friction counts at its lower end alone."""
    found = twin("b", "coulomb", counts_per_metre=4000.0).predict(hl.bounds.abbott_okamura)
    assert float(found) == pytest.approx(2 * 0.11 / 1e-3)
    assert found.low == pytest.approx(2 * 0.01 * 4000) and found.high == pytest.approx(2 * 0.14 / 1e-3)


def test_no_paddle_within_the_intervals_is_outside():
    paddle, draws = twin("m", "b", "delay"), np.random.default_rng(5)
    found = paddle.predict(hl.stability_limit, B=0.05)
    drawn = [
        hl.stability_limit(
            paddle.at(**{name: draws.uniform(low, high) for name, (low, high, _) in pick(("m", "b", "delay"))}), B=0.05
        )
        for _ in range(30)
    ]
    assert all(limit.K in found for limit in drawn) and found.not_monotone == ()
    assert min(limit.K for limit in drawn) < float(found) < max(limit.K for limit in drawn)


def test_an_answer_that_rises_and_falls_is_told():
    found = twin("m", "b").predict(lambda paddle: (paddle.m - 0.05) ** 2 * paddle.b)
    assert found.not_monotone == ("m",) and found.low == 0.0 and found.high == pytest.approx(1e-4 * 0.14)
    assert "both rises and falls with m, so the true ends may lie a little further out" in str(found)


def test_an_infinite_end_is_an_end():
    found = twin("b").predict(lambda paddle: math.inf if paddle.b > 0.12 else 5.0)
    assert (found.low, found.high, found.unmoved) == (5.0, math.inf, ())


def test_a_question_without_an_answer_is_refused_with_the_end():
    with pytest.raises(AnalysisError, match="the profile toy has no interval, so its prediction has none"):
        twin().predict(hl.passivity_limit)
    with pytest.raises(AnalysisError, match="no prediction at the profile's own values: .*needs at most 0.1"):
        twin("b").predict(hl.bounds.gil, B=-0.109)
    with pytest.raises(AnalysisError, match="no prediction at b = 0.14: too much"):
        twin("b").predict(raising)
    for nothing in (math.nan, None, "stiff"):
        with pytest.raises(AnalysisError, match="is not a number; a prediction needs a question that returns a number"):
            twin("b").predict(lambda paddle, nothing=nothing: nothing)


def test_a_paddle_in_a_hand_predicts_over_its_profile():
    """b + b_hand <= 2 (...) rises with the hand's damping; a constant that is given is exact."""
    held = hl.SimulatedPaddle.from_profile(twin("b", "delay"), hand=hl.Hand(m=0.02, b=1.0, k=200.0))
    found = held.predict(hl.stability_limit)
    ends = [
        hl.stability_limit(hl.SimulatedPaddle(m=0.05, b=b, T=1e-3, delay=late, hand=held.hand)).K
        for b, late in ((0.08, 4e-4), (0.14, 0.0))
    ]
    assert [found.low, found.high] == pytest.approx(ends)
    damped = hl.SimulatedPaddle.from_profile(twin("b", "delay"), b=0.5).predict(hl.passivity_limit)
    assert damped.high == pytest.approx(2 * 0.5 / 1e-3) and damped.low_ends == {"delay": "high"} and damped.at_low.b == 0.5
    with pytest.raises(PaddleError, match="the paddle has no profile"):
        hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).predict(hl.passivity_limit)


def raising(paddle):
    if paddle.b > 0.13:
        raise AnalysisError("too much")
    return paddle.b
