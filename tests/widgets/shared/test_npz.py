import base64
import json
from dataclasses import replace
from zipfile import ZipFile

import numpy as np
import pytest
from page_in_node import NODE, evaluated

import hapticlab as hl

pytestmark = pytest.mark.skipif(NODE is None, reason="the scripts of a page are run by node 18 or newer")
COLUMNS = """Object.fromEntries(
    Object.entries(log.columns).map(([name, column]) => [name, Float64Array.from(column, (one) => one ?? NaN)]))"""
WRITE = f'Buffer.from(recordFile({{ ...log, columns: {COLUMNS} }}, told)).toString("base64")'


def written(log, path):
    """The file that a page writes of a record."""
    names = [name for name in log.columns if name != "intent"]
    columns = {name: [None if value != value else value for value in getattr(log, name).tolist()] for name in names}
    about = {"columns": columns, "parameters": log.parameters, "changes": log.changes, "T": log.T, "fault": log.fault}
    told = {name: getattr(log, name) for name in ("scene", "paddle", "delay", "sensor_delay", "units")} | {"force_max": 1.0}
    path.write_bytes(base64.b64decode(evaluated(["rows.js", "npz.js"], WRITE, log=about, told=told)))
    return path


def test_a_record_from_a_page_is_the_record_that_python_saves(tmp_path):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, force_max=1.0, counts_per_metre=20_000, hand=hl.Hand("pinch", push=2.0))
    scene = replace(hl.library.mass_spring_damper(), name='ein "Körper" \U0001f9f2')
    log = replace(paddle.run(scene, duration=0.3), changes=((0.1, {"k": 250.0}),), fault="tick 7: F was 'not finite'")
    assert log.saturated.any() and not log.saturated.all()
    page, own = written(log, tmp_path / "page.npz"), log.save(tmp_path / "own.npz")
    read, expected = hl.records.Telemetry.load(page), hl.records.Telemetry.load(own)
    assert read.columns == expected.columns
    for name in (*expected.columns, "saturated", "gap", "overrun"):
        assert np.array_equal(getattr(read, name), getattr(expected, name), equal_nan=True), name
    for name in ("units", "parameters", "changes", "scene", "paddle", "T", "delay", "sensor_delay", "every", "fault"):
        assert getattr(read, name) == getattr(expected, name), name
    with ZipFile(page) as one, ZipFile(own) as other:
        assert one.testzip() is None and sorted(one.namelist()) == sorted(other.namelist())
    with np.load(page) as one, np.load(own) as other:
        assert all(one[name].dtype == other[name].dtype for name in other.files if name != "about")
        assert json.loads(str(one["about"])) == json.loads(str(other["about"]))
