"""The demonstration's conclusions are computed: other numbers give other words."""

from dataclasses import replace

import numpy as np
import pytest
import tqdm

from hapticlab.analysis.sweeps.sweep import Sweep
from hapticlab.cli import demo
from hapticlab.limits.limit import Limit


def felt(limit, first_chattering):
    k = np.array([100.0, 110.0, 121.0, 133.1])
    grid = Sweep({"k": k}, np.where(np.arange(4) >= first_chattering, 1e-3, 0.0), "chatter", "m")
    return demo.Felt("a hand", None, Limit(limit, 4.0, "kind", "reason"), grid)


@pytest.mark.parametrize(
    ("limit", "first", "bracket", "inside", "near"),
    [
        (115.0, 2, (110.0, 121.0), True, True),
        (110.0, 2, (110.0, 121.0), True, True),
        (121.0, 2, (110.0, 121.0), True, True),
        (130.0, 2, (110.0, 121.0), False, True),  # a grid step of 10 percent outside
        (101.0, 2, (110.0, 121.0), False, True),
        (140.0, 2, (110.0, 121.0), False, False),
        (99.0, 2, (110.0, 121.0), False, False),
        (115.0, 0, None, False, False),  # chatters everywhere: the grid does not hold the beginning
        (115.0, 4, None, False, False),
    ],
)
def test_limit_inside_the_bracket_or_one_grid_step_outside(limit, first, bracket, inside, near):
    one = felt(limit, first)
    assert one.bracket == bracket
    assert one.lies_within(0) is inside
    assert one.lies_within(1) is near


def test_a_run_that_could_not_tell_is_not_quiet():
    one = felt(105.0, 2)
    one.grid.values[1] = np.nan
    assert one.bracket == (100.0, 121.0)


@pytest.fixture(scope="module")
def study():
    """The quick study, and every progress bar it showed."""
    bars = []

    class Bar(tqdm.tqdm):
        def __init__(self, **options):
            super().__init__(**options)
            self.told = 0
            bars.extend([] if self.disable else [self])  # closing disables it too

        def update(self, n=1):
            self.told += n
            return super().update(n)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tqdm, "tqdm", Bar)
        return demo.study(quick=True), bars


@pytest.fixture(scope="module")
def found(study):
    return study[0]


def test_one_progress_bar_covers_the_study(study):
    (bar,) = study[1]
    # two sweeps and two walls of 8 s, the student's scene for 3 s; a tick is 1 ms
    assert bar.told == bar.total == 4 * 8000 + 3000


def test_words_follow_the_numbers(found):
    facts = demo.report(found)
    assert "no simulated wall chattered below" in demo.words(facts)
    first = found.felt[0]
    assert demo.words(facts).count("the exact limit is inside this bracket") == len(found.felt)

    low, high = first.bracket
    near = replace(first, limit=replace(first.limit, K=high * (1 + 0.5 * (high / low - 1))))
    told = demo.words(demo.report(replace(found, felt=(near, found.felt[1]))))
    assert "the exact limit is at most one grid step outside this bracket" in told

    elsewhere = replace(first, limit=replace(first.limit, K=3 * first.limit.K))
    early = replace(found.felt[1], grid=replace(found.felt[1].grid, values=np.ones_like(first.grid.values)))
    told = demo.words(demo.report(replace(found, felt=(elsewhere, early))))
    assert "NOT where the exact limit is" in told
    assert "chatter was seen below" in told
    assert "chatter does not begin in the grid" in told


def test_a_decay_is_not_told_to_run_longer(found):
    decays = [line for line in demo.words(demo.report(found)).splitlines() if "decaying" in line]
    assert len(decays) == 1
    assert "run longer" not in decays[0]


def test_figure_shows_both_limits_by_name_and_value(found):
    onset, walls, own = demo.draw(found).axes
    legend = [text.get_text() for text in onset.get_legend().get_texts()]
    assert sum("Eq. (23.10)" in text and "114" in text for text in legend) == 1
    assert sum("exact limit" in text for text in legend) == 2
    drawn = {round(line.get_xdata()[0], 6) for line in onset.lines if len(line.get_xdata()) == 2}
    assert drawn == {round(found.passive.K, 6), *(round(f.limit.K, 6) for f in found.felt)}
    assert all("[" in axes.get_xlabel() and "[" in axes.get_ylabel() for axes in (onset, walls, own))
