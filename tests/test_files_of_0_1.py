"""What version 0.1 wrote is read, or refused in words; its code made the files, see files_of_0_1/make.py."""

import json
import re
from operator import attrgetter
from pathlib import Path
from shutil import copy

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.cli.main import main
from hapticlab.device.board.host_board import HostBoard
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.serial_ports import open_port
from hapticlab.errors import AnalysisError
from hapticlab.experiments.forced_choice import ForcedChoice
from hapticlab.grading.journal import Journal
from hapticlab.vocabulary import PAGES

FILES = Path(__file__).parent / "files_of_0_1"
T = 1e-3


def test_a_record_is_read():
    log = hl.records.Telemetry.load(FILES / "log.npz")
    assert (len(log), log.columns, log.T, log.fault) == (50, ("t", "x", "v", "F", "z"), T, None)
    assert log.parameters == {"K": 300.0, "m": 0.05}
    np.testing.assert_allclose(log.F, 300 * (log.x - log.z), atol=1e-5)  # float32 of 0.1 N


def test_its_table_says_the_same():
    table = np.genfromtxt(FILES / "log.csv", delimiter=",", skip_header=1)
    log = hl.records.Telemetry.load(FILES / "log.npz")
    assert (FILES / "log.csv").read_text("utf-8").startswith("t [s],x [m],v [m/s],F [N],z [m]")
    np.testing.assert_array_equal(table[:, :4], np.c_[log.t, log.x, log.v, log.F])


def test_a_profile_is_read():
    given = json.loads((FILES / "profile.json").read_text("utf-8"))
    profile = hl.devices.PaddleProfile(**given)
    today = hl.devices.profile("hapkit")  # says more: its full force, carrier and wiring
    assert given == {name: getattr(profile, name) for name in given} == {name: getattr(today, name) for name in given}
    assert hl.SimulatedPaddle.from_profile(profile).m == 0.03


def test_an_experiment_is_read():
    found = ForcedChoice.load(FILES / "choices.json")
    assert [trial.level for trial in found.trials].count(0.5) == 2
    assert "4 trials" in str(found)


def test_a_sweep_is_refused_by_its_version(tmp_path):
    """The metric of a point may change from a version to the next, so points of both are not mixed."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand(push=2.0))
    kept = copy(FILES / "walls.sweep", tmp_path)
    before = Path(kept).read_bytes()
    with pytest.raises(
        AnalysisError, match=rf"hapticlab: 0\.1\.0 there, {hl.__version__} here.*Give a different file, or delete"
    ):
        hl.sweep(hl.wall(), paddle, k=[100.0, 200.0, 400.0], duration=0.3, resume=kept)
    assert Path(kept).read_bytes() == before


def test_a_journal_is_read():
    (report,) = Journal(FILES / "marks.journal").reports.values()
    (exercise,) = report.exercises
    assert (report.student, report.points, exercise.right, exercise.failing.value) == ("ada", 2.0, 1, -1.5)
    assert not report.grader_failed  # not known to 0.1


def test_settings_of_a_board_of_0_1_are_not_taken_for_those_of_today():
    """Its memory, as it was on a board of 0.1 that had been calibrated and had kept a spring: no wiring was confirmed."""
    store = (FILES / "board.store").read_bytes()
    port = open_port("sim://hapkit")
    port.put_on(None, store=store)
    with SerialPaddle("sim://hapkit", port=port) as paddle:
        assert paddle.settings is None and "not calibrated, so the motor stays off (run `hapticlab calibrate`)" in str(paddle)
    metres = nominal("hapkit").metres_per_count
    there, back = np.linspace(0, 0.05, 1000), np.linspace(0.05, -0.05, 1000)
    path = np.r_[there, back, np.linspace(-0.05, 0, 1000), np.zeros(2100), np.linspace(0, 0.01, 200)]  # the deliberate act
    board = HostBoard(store)
    assert not any(board.tick(round(x / metres), n * T) for n, x in enumerate(path))


def test_a_scene_file_is_refused_with_the_new_name(capsys, tmp_path):
    assert main(["run", str(FILES / "scene.py"), "--out", str(tmp_path)]) != 0
    error = capsys.readouterr().err
    assert "in scene.py, line 7" in error
    assert "hapticlab has no lagrange; did you mean hl.mechanics.lagrange?" in error


def test_the_changelog_says_where_each_name_is():
    changelog = (FILES.parents[1] / "CHANGELOG.md").read_text("utf-8")
    moved = dict(re.findall(r"^\| `hl\.(\w+)` \| `hl\.([\w.]+)` \|$", changelog, re.M))
    old = (FILES / "names.txt").read_text("utf-8").split()
    assert [name for name in old if name not in moved and (name not in hl.__all__ or name in PAGES)] == ["library"]
    assert sorted(moved.keys() - old) == []
    assert [attrgetter(path)(hl) for path in moved.values()]  # each is there


def test_a_name_of_0_1_is_answered_with_where_it_is():
    changelog = (FILES.parents[1] / "CHANGELOG.md").read_text("utf-8")
    for old, new in re.findall(r"^\| `hl\.(\w+)` \| `hl\.([\w.]+)` \|$", changelog, re.M):
        if old not in PAGES:
            with pytest.raises(AttributeError, match=rf"did you mean .*\bhl\.{new}\b"):
                getattr(hl, old)
