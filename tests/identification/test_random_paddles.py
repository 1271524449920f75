"""Intervals hold the truth of paddles and hands drawn at random, few here; a benchmark's table has hundreds."""

import importlib.util
from pathlib import Path

import pytest

_FILE = Path(__file__).parents[1] / "benchmarks" / "random_paddles.py"
_spec = importlib.util.spec_from_file_location("random_paddles", _FILE)
trials = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(trials)


@pytest.mark.parametrize(("what", "number"), [("steps", 1), ("steps", 5), (trials.RECOMMENDED, 1), ("hand", 1), ("hand", 2)])
@pytest.mark.always("steps-1", "kick+steps+chirp-1")
def test_random_ones_are_found_and_none_is_far_off(what, number):
    for k in range(number):
        _, refused, found = trials.identified(k, what)
        assert not refused, (k, refused)
        for name, (true, value, low, high) in found.items():
            # twice the half width is four standard errors; a wrong basin is hundreds away
            assert abs(value - true) < high - low, (k, name, true, value)


@pytest.mark.slow
@pytest.mark.parametrize(("what", "number"), [(trials.RECOMMENDED, 300), ("hand", 300)])
def test_hundreds_are_covered(what, number):
    count, refused, holds = trials.coverage([trials.identified(k, what) for k in range(number)])["all"]
    assert refused <= 0.05 * count
    for name, part in holds.items():
        assert 0.92 <= part <= 0.98, (name, part)
