"""Targets: the measures by hand, selections of a made path, and a simulated hand that obeys the law."""

import csv
import math
import statistics
from dataclasses import replace

import numpy as np
import pytest

from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.experiments.fitts import Fitts, Targets, fitts, selections

PADDLE = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=Hand("grip"))


def test_measures_by_hand():
    ends = (0.001, -0.001, 0.002, 0.0)
    a = Targets(0.04, 0.008, (0.4, 0.6, 0.5, 0.5), ends)
    assert a.difficulty == pytest.approx(math.log2(6))
    width = 4.1327313541 * statistics.stdev(ends)  # of 96 % of a normal distribution
    assert a.effective_difficulty == pytest.approx(math.log2((0.04 + statistics.mean(ends)) / width + 1), rel=1e-9)
    assert a.throughput == pytest.approx(a.effective_difficulty / 0.5)


def test_the_law_is_the_line_through_the_means():
    rows = [
        Targets(width * (2**bits - 1), width, (0.1 + 0.15 * bits,) * 3, (0.0, 1e-4, -1e-4))
        for bits, width in ((1, 0.01), (2, 0.005), (4, 0.01))
    ]
    found = Fitts(tuple(rows), "made up")
    assert found.law == pytest.approx((0.1, 0.15, 1.0))
    assert "100 ms + 150 ms/bit" in str(found)
    assert found.throughput == pytest.approx(statistics.mean(r.throughput for r in rows))


def test_targets_are_selected_in_turn():
    t = np.arange(3000) * 1e-3
    x = np.interp(t, [0, 0.4, 0.6, 0.65, 0.7, 1.2, 1.4, 3.0], [0, 0, 0.041, 0.05, 0.039, 0.039, -0.002, -0.002])
    found = selections(t, x, 0.04, 0.008)
    assert len(found) == 2  # the third target is never reached, the second never left for good
    rest, second = found
    assert rest[0] == 0.0 and rest[2] == pytest.approx(0.0, abs=1e-9)
    assert rest[1] == pytest.approx(0.4, abs=1.5e-3)
    assert second[0] == pytest.approx(0.65 + 0.05 * 6 / 11, abs=1.5e-3)  # flown through at first, then for good
    assert second[2] == pytest.approx(-0.001, abs=6e-4)


def test_a_hand_obeys_the_law():
    pytest.importorskip("llvmlite", reason="twenty simulated seconds")
    found = fitts(PADDLE, distances=(0.02, 0.08), widths=(0.004, 0.008), movements=5)
    _, slope, fit = found.law
    assert fit > 0.8 and 0.1 < slope < 0.35
    assert 3 < found.throughput < 12  # of five ends each
    assert found.targets[0].distance == 0.02 and len(found.targets[0].times) == 5


@pytest.mark.slow
def test_many_movements_obey_the_law():
    found = fitts(PADDLE, distances=(0.02, 0.04, 0.08), widths=(0.004, 0.008), movements=40)
    intercept, slope, fit = found.law
    assert fit > 0.9 and slope == pytest.approx(0.17, abs=0.03) and abs(intercept) < 0.1
    assert 4.5 < found.throughput < 7.5


def test_a_scatter_that_is_smaller_is_faster():
    pytest.importorskip("llvmlite", reason="ten simulated seconds")
    times = [
        np.mean([a.time for a in fitts(PADDLE, distances=(0.05,), widths=(0.005, 0.01), movements=4, scatter=s).targets])
        for s in (0.01, 0.06)
    ]
    assert times[0] < 0.8 * times[1]


def test_rows_go_to_a_file(tmp_path):
    rows = (Targets(0.04, 0.008, (0.4, 0.6), (0.0, 0.001)),)
    lines = list(csv.reader(Fitts(rows).to_csv(tmp_path / "a.csv").read_text().splitlines()))
    assert lines == [["distance [m]", "width [m]", "time [s]", "end [m]"], ["0.04", "0.008", "0.4", "0.0"],
                     ["0.04", "0.008", "0.6", "0.001"]]  # fmt: skip


def test_what_cannot_be_done_is_refused():
    with pytest.raises(PaddleError, match="fitts needs a hand that holds the handle"):
        fitts(replace(PADDLE, hand=None))
    with pytest.raises(AnalysisError, match="least 2 and 3"):
        fitts(PADDLE, distances=(0.01,), widths=(0.02,))
