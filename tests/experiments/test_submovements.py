"""Bellman's times against playing the policy out, and the law that comes of them."""

import math

import numpy as np
import pytest

from hapticlab.errors import AnalysisError
from hapticlab.experiments.submovements import Submovements


def test_times_are_those_of_playing_it_out():
    aim, rng, plays = Submovements(0.008, scatter=0.04, pause=0.18, furthest=0.3), np.random.default_rng(3), 20_000
    left, spent = np.full(plays, 0.08), np.zeros(plays)
    while (left > 0.004).any():
        going = left > 0.004
        duration = np.interp(np.log(left[going]), np.log(aim.distances), aim.durations)
        miss = np.abs(0.04 * left[going] / duration * rng.standard_normal(going.sum()))
        spent[going] += duration + 0.18 * (miss > 0.004)
        left[going] = miss
    # the grid of distances has steps of 5 %
    assert aim.time(0.08) == pytest.approx(spent.mean(), rel=0.01)


def test_no_other_first_duration_is_sooner():
    aim = Submovements(0.008, scatter=0.04, pause=0.18, furthest=0.3)

    def mean_time(duration):
        z = np.linspace(-8, 8, 4001)
        weight = np.exp(-z * z / 2)
        left = np.abs(0.04 * 0.08 / duration * z)
        rest = np.where(left > 0.004, 0.18 + np.interp(np.log(np.maximum(left, 0.004)), np.log(aim.distances), aim.times), 0.0)
        return duration + float(weight @ rest / weight.sum())

    best = mean_time(aim.duration(0.08))
    assert best == pytest.approx(aim.time(0.08), rel=0.01)
    assert all(mean_time(aim.duration(0.08) * f) > best for f in (0.7, 1.4))


def test_fitts_law_comes_out():
    """Times grow with the logarithm of distance over width, whatever the width is."""
    difficulty, times = [], []
    for width in (0.004, 0.008, 0.016):
        aim = Submovements(width, scatter=0.04, furthest=32 * width)
        for ratio in (2, 4, 8, 16, 32):
            difficulty.append(math.log2(ratio + 1))
            times.append(aim.time(ratio * width))
    np.testing.assert_allclose(times[:5], times[10:], rtol=1e-12)  # only the ratio matters
    assert np.corrcoef(difficulty, times)[0, 1] ** 2 > 0.98


def test_what_is_no_target_is_refused():
    with pytest.raises(AnalysisError, match="the distances larger than half the width"):
        Submovements(0.01, furthest=0.004)
