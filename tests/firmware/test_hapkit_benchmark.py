"""The benchmark beside the published Hapkit loop compares equals: the same wall, the same handle, the same clock."""

import importlib
import json
from pathlib import Path

import numpy as np
import pytest
from emulator import CYCLES_PER_SECOND, missing

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))


@pytest.fixture
def hapkit(monkeypatch):
    monkeypatch.syspath_prepend(BENCHMARKS)
    return importlib.import_module("hapkit")


def test_both_images_render_the_same_wall(hapkit):
    with hapkit.firmware(1e-3) as board:
        ours = hapkit.staircase(board)
    with hapkit.sketch() as board:
        theirs = hapkit.staircase(board)
    # the law by hand, F = FULL (duty / 256)^2, in clocks of the carrier: the firmware takes the nearest number, the sketch
    # cuts 255 parts off and its pin is high for one clock more
    exact = 256 * np.sqrt(hapkit.wall_force() / hapkit.FULL)
    assert exact.max() > 90 and (exact == 0).sum() > 5
    assert np.abs(ours - exact).max() <= 0.501
    assert np.abs(theirs - exact).max() < 1.001
    # so they differ by one step of the duty at most: 28 mN at the deepest, where the wall gives 1.5 N
    assert set(ours - theirs) <= {-1.0, 0.0, 1.0}
    assert np.abs(np.diff(hapkit.FULL * np.array([ours, theirs]) ** 2 / 256**2, axis=0)).max() < 0.028


def test_the_sketch_sees_a_velocity_that_is_its_period_over_the_hard_coded_one_too_large(hapkit):
    with hapkit.sketch() as board:
        board.loop.handle = hapkit.Led(lambda t: -0.1 * t)  # free: every loop does the same
        board.wait(0.2)
        period = np.diff(board.loop.board.samples()[-200:]).mean() / CYCLES_PER_SECOND
        assert board.variable("vh") / -0.1 == pytest.approx(period / 1e-4, rel=0.08)  # the sensor's steps come through
        assert period > 2.5e-4


@pytest.mark.wide
def test_the_benchmark_runs(hapkit, monkeypatch, tmp_path, capsys):
    ours, theirs = hapkit.measure_firmware(1e-3, 0.3), hapkit.measure_sketch(1, 1, 0.3)
    monkeypatch.setattr(hapkit, "measure", lambda: {"hapticlab 1 ms": ours, "hapticlab": ours, "sketch, line/1": theirs})
    hapkit.main(["--json", str(tmp_path / "found.json")])
    assert json.loads((tmp_path / "found.json").read_text())["sketch, line/1"]["rate"] == theirs["rate"]
    table = capsys.readouterr().out
    assert all(what in table for what, *_ in hapkit.ROWS)
    assert ours["sample"]["median"] == pytest.approx(1e-3, abs=1e-6) and ours["sample"]["range"] < 25e-6
    assert ours["samples"] == pytest.approx(1000, abs=5) and ours["lost"] == ours["overruns"] == 0
    assert ours["velocity"]["free"] == pytest.approx(1, rel=0.01) and ours["velocity"]["wall"] == pytest.approx(1, rel=0.01)
    # 9 characters a loop at 117647 baud are less than the line carries: every loop's line arrives
    assert theirs["samples"] == pytest.approx(theirs["rate"], rel=0.02) and theirs["lost"] == 0
    assert theirs["x_error"] <= 5.001e-6 < hapkit.METRES / 2  # digits enough to tell counts apart
