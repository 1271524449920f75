"""Choices on tables made by hand: what they print, note and refuse, in which words."""

import math
from functools import partial

import pytest
from trade_rows import one_row

from hapticlab.analysis.accuracy.tradeoff_choice import Asked, chosen
from hapticlab.analysis.accuracy.tradeoff_rows import Status
from hapticlab.errors import AnalysisError

ASKED = Asked(1e-2, 0.5, True)
row = partial(one_row, err_hold=0.088)


def choose(rows, asked=ASKED):
    return chosen(rows, "uno", asked, lambda row: {"method": row.method, "live": ()})


def test_a_choice_says_the_error_at_the_samples_and_that_of_the_held_force():
    choice = choose([row()])
    assert "error 0.5 % at the samples, allowed 1 %; held over the period 8.8 %" in str(choice)
    assert choice.facts()["err_hold"] == 0.088


def test_the_error_of_the_held_force_can_be_bounded():
    rows = [row(), row(T=5e-4, err_hold=0.044, load=0.45)]
    assert choose(rows, Asked(1e-2, 0.5, True, held=0.05)).row is rows[1]
    assert "held error 8.8 % instead of 5 %" in str(choose(rows[:1], Asked(1e-2, 0.5, True, held=0.05)))


@pytest.mark.parametrize(
    ("found", "word"),
    [
        ({"status": Status("chaotic", "after 0.02 s"), "why": "two solvers differ"}, "chaotic after 0.02 s: two solvers differ"),
        ({"status": "uncertified", "why": "they differ by 0.1 %", "doubt": 1e-3}, "uncertified: they differ by 0.1 %"),
        ({"status": Status("faulted", "after 0.1 s"), "why": "no number"}, "faulted after 0.1 s: no number"),
        (
            {"b_where": "x = 0.05"},
            "passive for small motions only, because the scene is not linear; it needs the most damping at x = 0.05",
        ),
    ],
)
def test_a_choice_notes_what_is_not_certain(found, word):
    assert word in str(choose([row(**found)])) and word not in str(choose([row()]))


@pytest.mark.parametrize(
    ("found", "word"),
    [
        ({"doubt": math.inf, "status": "uncertified"}, "only one of the two solved it, so no error is certain"),
        ({"b_req": math.inf}, "damping in the scene itself, because no device has enough"),
        ({"margin": 0.0}, "a different method, because with this one every step is too long"),
        ({"sensor_floor": 0.5}, "a finer encoder: this one alone causes an error of 50 % of the greatest force"),
    ],
)
def test_what_no_factor_mends_is_said_in_words(found, word):
    answer = choose([row(**found)])
    assert not answer and word in str(answer)
    assert not any(bad in str(answer) for bad in ("inf", "nan", "times 0", " 0 times"))


def test_an_encoder_raises_the_tolerance_to_a_tenth_at_most():
    assert choose([row(sensor_floor=0.19)]).tolerance == pytest.approx(0.095)
    assert not choose([row(sensor_floor=0.21)])
    assert choose([row(sensor_floor=0.21)], Asked(0.2, 0.5, True)).tolerance == 0.2


def test_an_encoder_whose_error_is_not_known_raises_nothing():
    assert choose([row(sensor_floor=math.nan)]).tolerance == 1e-2


def test_where_nothing_ran_the_reasons_are_of_what_was_tried():
    refused, wild = row(status="refused", why="takes no contacts"), row(status="unstable at t=0.1 s", why="its force passes")
    assert choose([refused, wild]).relax == ("its force passes",)
    assert choose([refused]).relax == ("takes no contacts",)


@pytest.mark.parametrize("given", [(0.0, 0.5, True), (math.nan, 0.5, True), (0.1, 0.0, True), (0.1, 0.5, True, 2.0, -1.0)])
def test_what_is_asked_for_is_more_than_nothing(given):
    with pytest.raises(AnalysisError, match="needs a number > 0"):
        Asked(*given)
