"""The wall a board has room for."""

import pytest

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.errors import AnalysisError, ProgramLimitError


def paddle(T):
    return hl.SimulatedPaddle(m=0.05, b=0.1, T=T, counts_per_metre=1e5, force_max=5.0)


@pytest.mark.slow
def test_a_slower_rate_buys_a_better_wall():
    found = hl.laws.wall_for_board(paddle(1e-3), K=500)
    assert found.name == "half a sample by the model" and cost(found.cost.program).fits
    assert "needs" in found.passed_over["dead-beat pairs, crossings to 1 %"] and "not dead-beat pairs" in str(found)
    assert hl.laws.wall_for_board(paddle(2.2e-3), K=500).name == "half a sample, dead-beat pairs at crossings, to 5 %"


def test_where_nothing_fits_the_period_is_named():
    with pytest.raises(ProgramLimitError, match=r"no model-based wall of 500 N/m fits uno at T = 0.5 ms; .*needs T >= 0\.\d+ ms"):
        hl.laws.wall_for_board(paddle(5e-4), K=500)


def test_what_is_wrong_with_the_constants_is_said_once():
    for given, words in (({"K": -1}, "a wall needs K > 0"), ({"K": 500, "hand": "pinch"}, 'as hl.Hand\\("pinch"\\)')):
        with pytest.raises(AnalysisError, match=words):
            hl.laws.wall_for_board(paddle(1e-3), **given)
    with pytest.raises(AnalysisError, match="^a Scene has no m; needs a paddle, as hl.SimulatedPaddle"):
        hl.laws.wall_for_board(hl.wall(), K=500)
