"""The demonstration's conclusions are computed: other numbers give other words."""

from dataclasses import replace

import numpy as np
import pytest

from hapticlab import demo
from hapticlab.analysis.limit import Limit
from hapticlab.analysis.sweep import Sweep


def felt(limit, first_chattering):
    k = np.array([100.0, 110.0, 121.0, 133.1])
    grid = Sweep({"k": k}, np.where(np.arange(4) >= first_chattering, 1e-3, 0.0), "chatter", "m")
    return demo.Felt("a hand", None, Limit(limit, 4.0, "kind", "reason"), grid)


@pytest.mark.parametrize(
    ("limit", "first", "onset", "agrees"),
    [
        (115.0, 2, (110.0, 121.0), True),
        (130.0, 2, (110.0, 121.0), True),  # a grid step of 10 percent further
        (140.0, 2, (110.0, 121.0), False),
        (99.0, 2, (110.0, 121.0), False),
        (115.0, 0, None, False),  # chatters everywhere: the grid does not hold the beginning
        (115.0, 4, None, False),
    ],
)
def test_agreement_is_within_one_grid_step(limit, first, onset, agrees):
    one = felt(limit, first)
    assert one.onset == onset
    assert one.agrees is agrees


@pytest.fixture(scope="module")
def found():
    return demo.study(quick=True, progress=False)


def test_words_follow_the_numbers(found):
    facts = demo.report(found)
    assert "no simulated wall chattered below" in demo.words(facts)
    first = found.felt[0]
    assert demo.words(facts).count("within one grid step of the exact limit") == len(found.felt)

    elsewhere = replace(first, limit=replace(first.limit, K=3 * first.limit.K))
    early = replace(found.felt[1], grid=replace(found.felt[1].grid, values=np.ones_like(first.grid.values)))
    told = demo.words(demo.report(replace(found, felt=(elsewhere, early))))
    assert "NOT where the exact limit is" in told
    assert "chatter was seen below" in told
    assert "chatter does not begin in the grid" in told


def test_figure_shows_both_limits_by_name_and_value(found):
    onset, walls, own = demo.draw(found).axes
    legend = [text.get_text() for text in onset.get_legend().get_texts()]
    assert sum("Eq. (23.10)" in text and "114" in text for text in legend) == 1
    assert sum("exact limit" in text for text in legend) == 2
    drawn = {round(line.get_xdata()[0], 6) for line in onset.lines if len(line.get_xdata()) == 2}
    assert drawn == {round(found.passive.K, 6), *(round(f.limit.K, 6) for f in found.felt)}
    assert all("[" in axes.get_xlabel() and "[" in axes.get_ylabel() for axes in (onset, walls, own))
