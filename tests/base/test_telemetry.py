"""Telemetry: immutable, saved and read back without loss, and clear about what is missing."""

import copy
import csv
import dataclasses
import pickle

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.records.chatter import chatter
from hapticlab.analysis.records.energy import energy
from hapticlab.base.telemetry import Telemetry
from hapticlab.errors import AnalysisError


def make_log(**changes):
    t = np.arange(5) * 1e-3
    given = dict(
        t=t, x=np.sqrt(t) / 3, v=np.cos(t), F=-np.sin(t), T=1e-3, delay=2.5e-4, channels={"z": t**2, "x_true": t / 7},
        units={"z": "m"}, paddle="toy", scene="wall", parameters={"k": 150.0}, fault="tick 3: F was nan",
        saturated=[0, 0, 1, 0, 0],
    )  # fmt: skip
    return Telemetry(**{**given, **changes})


def test_arrays_are_read_only_copies():
    x = np.zeros(5)
    log = make_log(x=x)
    x[0] = 9
    assert log.x[0] == 0
    with pytest.raises(ValueError, match="read-only"):
        log.z[0] = 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        log.T = 1


def test_saved_and_loaded_is_the_same(tmp_path):
    log = make_log()
    path = log.save(tmp_path / "run")
    assert path.name == "run.npz"
    back = Telemetry.load(path)
    for name in (*log.columns, "saturated", "gap", "overrun"):
        assert np.array_equal(getattr(back, name), getattr(log, name)), name
    for name in ("T", "delay", "units", "paddle", "scene", "parameters", "fault", "columns"):
        assert getattr(back, name) == getattr(log, name), name


def test_load_refuses_other_files(tmp_path):
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    with pytest.raises(AnalysisError, match="not a telemetry file.*log.save"):
        Telemetry.load(tmp_path / "other.npz")
    np.savez(tmp_path / "code.npz", about=np.array([{}], object))
    np.save(tmp_path / "array.npy", np.zeros(3))
    whole = make_log().save(tmp_path / "whole.npz").read_bytes()
    (tmp_path / "cut.npz").write_bytes(whole[: len(whole) // 2])
    (tmp_path / "text.npz").write_text("t,x,v,F")
    for name in ("code.npz", "array.npy", "cut.npz", "text.npz"):
        with pytest.raises(AnalysisError, match="not a telemetry file"):
            Telemetry.load(tmp_path / name)


def test_csv_has_units_and_every_digit(tmp_path):
    log = make_log()
    with open(log.to_csv(tmp_path / "run.csv"), newline="") as file:
        header, *rows = csv.reader(file)
    assert header == ["t [s]", "x [m]", "v [m/s]", "F [N]", "z [m]", "x_true [m]", "saturated"]
    table = np.array(rows, float)
    assert np.array_equal(table[:, 1], log.x) and np.array_equal(table[:, 5], log.x_true)
    assert table[:, 6].tolist() == [0, 0, 1, 0, 0]


def test_missing_channel_says_what_was_recorded():
    with pytest.raises(AttributeError, match=r"'y' was not recorded; this log has t, x, v, F, z, x_true\. Watch it"):
        _ = make_log().y
    with pytest.raises(AttributeError, match=r"Write hl\.plot\(log\)"):
        make_log().plot()
    assert "z" in dir(make_log()) and not hasattr(make_log(), "w")


@pytest.mark.parametrize(
    "tried, meant", [("force", "F"), ("position", "x"), ("velocity", "v"), ("time", "t"), ("period", "T"), ("csv", "to_csv")]
)
def test_a_wrong_guess_names_the_right_one(tried, meant):
    with pytest.raises(AttributeError, match=rf"a record has {meant}, not {tried}: log\.{meant}; it holds t, x, v, F, z, x_true"):
        getattr(make_log(), tried)
    assert hasattr(make_log(), meant)


def test_other_words_for_a_table_lead_to_it():
    with pytest.raises(AttributeError, match=r"a record has no to_dataframe; log\.to_pandas\(\) makes a table of it"):
        make_log().to_dataframe()


def test_copies_and_pickles():
    for twin in (copy.deepcopy(make_log()), pickle.loads(pickle.dumps(make_log()))):
        assert np.array_equal(twin.z, make_log().z)


def test_wrong_length_is_refused():
    with pytest.raises(AnalysisError, match=r"z has shape \(3,\); needs one value per sample, the shape \(5,\) of t"):
        make_log(channels={"z": np.zeros(3)})


def test_repr_is_short_and_names_the_fault():
    text = repr(make_log())
    assert len(text) < 150 and "5 samples" in text and "F was nan" in text


def test_repr_tells_of_events_that_were_not_located():
    missed = make_log(channels={"unlocated": [0, 1, 0, 2, 0]})
    assert "an event was not located in 2 of them, see unlocated" in repr(missed)
    assert "not located" not in repr(make_log(channels={"unlocated": np.zeros(5)}))


@pytest.mark.parametrize("asker", [hl.chatter, hl.energy, hl.plot])
def test_what_is_no_record_is_refused_with_the_call_that_makes_one(asker):
    with pytest.raises(AnalysisError, match=r"was given a Scene; needs the record of a run, log = paddle.run\(scene,"):
        asker(hl.wall())


def test_a_list_of_names_and_a_scene_for_a_paddle_are_refused_in_words():
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).run(hl.wall()(k=100), duration=0.05, x=0.001)
    with pytest.raises(AnalysisError, match="needs separate names"):
        hl.plot(log, ["x", "F"])
    with pytest.raises(AnalysisError, match="a Scene has no m; needs a paddle"):
        hl.stability_limit(hl.wall())


def test_what_needs_every_sample_refuses_a_record_that_lost_some():
    t = np.r_[np.arange(20), np.arange(25, 45)] * 1e-3
    gap = np.arange(40) == 20
    log = Telemetry(t=t, x=0 * t, v=0 * t, F=0 * t, T=1e-3, gap=gap)
    for asker in (energy, chatter):
        with pytest.raises(AnalysisError, match=r"samples were lost 1 times, first before t = 0.025 s."):
            asker(log)


def test_energy_refuses_one_sample_in_three_and_a_saved_record_knows():
    t = np.arange(40) * 3e-3
    log = Telemetry(t=t, x=0 * t, v=0 * t, F=0 * t, T=3e-3, every=3, changes=[(0.03, {"k": 300})])
    with pytest.raises(AnalysisError, match="one sample in 3"):
        energy(log)


def test_changes_and_decimation_survive_a_file(tmp_path):
    log = Telemetry(t=[0], x=[0], v=[0], F=[0], T=3e-3, every=3, changes=[(0.03, {"k": 300})])
    back = Telemetry.load(log.save(tmp_path / "log"))
    assert back.every == 3 and back.changes == ((0.03, {"k": 300}),)
