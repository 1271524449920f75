"""The file a sweep goes on from: whatever its end looks like, what it gives back was measured."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.sweeps import sweep_chunks, sweep_plan
from hapticlab.analysis.sweeps.sweep_file import CRC, HEAD, Partial, Record, remaining

WHAT = {"scene": "wall", "axis k": "4 from 1 to 2"}
PUSHED = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0), noise=1e-5, seed=7)
AXES = {"k": np.linspace(50, 800, 60), "T": np.array([1e-3, 8e-4]), "b": np.array([0.05, 0.4, 1.3])}


def written(path, records):
    with Partial(path, WHAT) as kept:
        for record in records:
            kept.add(record)


def read(path):
    with Partial(path, WHAT) as kept:
        return [(r.group, r.first, r.digest, r.values.tolist()) for r in kept.records]


RECORDS = [
    Record(0, 0, b"0123456789abcdef", np.array([1.5, -2.25, 1e-310])),
    Record(3, 2**40, b"fedcba9876543210", np.array([np.inf])),
    Record(1, 7, bytes(16), np.arange(5.0)),
]


def test_records_come_back(tmp_path):
    written(tmp_path / "a", RECORDS[:2])
    written(tmp_path / "a", RECORDS[2:])  # goes on at the end
    assert read(tmp_path / "a") == [(r.group, r.first, r.digest, r.values.tolist()) for r in RECORDS]


def test_a_file_that_ends_anywhere_keeps_what_was_whole(tmp_path):
    written(tmp_path / "whole", RECORDS)
    whole = (tmp_path / "whole").read_bytes()
    ends = np.cumsum([HEAD.size + 8 * len(r.values) + CRC.size for r in RECORDS])
    begin = len(whole) - ends[-1]
    for length in range(len(whole)):
        path = tmp_path / "cut"
        path.write_bytes(whole[:length])
        assert len(read(path)) == np.count_nonzero(begin + ends <= length)
        if length % 13 == 0:
            written(path, RECORDS[2:])  # and takes more
            assert read(path)[-1][:2] == (1, 7)


def test_damage_is_noticed(tmp_path):
    written(tmp_path / "whole", RECORDS)
    whole = bytearray((tmp_path / "whole").read_bytes())
    begin = whole.index(b"\n") + 1
    for at in range(begin, len(whole)):
        damaged = bytearray(whole)
        damaged[at] ^= 0x10
        (tmp_path / "damaged").write_bytes(damaged)
        before = np.searchsorted(begin + np.cumsum([HEAD.size + 8 * len(r.values) + CRC.size for r in RECORDS]), at, "right")
        assert len(read(tmp_path / "damaged")) == before


def test_two_at_once_do_each_other_no_harm(tmp_path):
    with Partial(tmp_path / "a", WHAT) as one, Partial(tmp_path / "a", WHAT) as other:
        for record in RECORDS:
            one.add(record)
            other.add(record)
    assert len(read(tmp_path / "a")) == 2 * len(RECORDS)


def test_what_is_left():
    random = np.random.default_rng(5)
    for _ in range(50):
        points, missing = 40, np.ones(40, bool)
        records = []
        for first, count in random.integers(0, 20, (random.integers(0, 6), 2)):
            records.append(Record(0, int(first), b"", np.zeros(count)))
            missing[first : first + count] = False
        covered = [k for start, stop in remaining(records, points) for k in range(start, stop)]
        assert covered == np.flatnonzero(missing).tolist()


def test_other_files_are_refused(tmp_path):
    (tmp_path / "letter").write_text("Dear all,\n")
    with pytest.raises(hl.errors.AnalysisError, match=r"is not the file of a sweep; give the path of a new file"):
        Partial(tmp_path / "letter", WHAT)
    assert (tmp_path / "letter").read_text() == "Dear all,\n"
    written(tmp_path / "other", RECORDS)
    with pytest.raises(
        hl.errors.AnalysisError, match=r"a different sweep \(axis k: 4 from 1 to 2 there, none here; axis b: 9 here\)|there"
    ):
        Partial(tmp_path / "other", {"scene": "wall", "axis b": "9"})
    with pytest.raises(hl.errors.AnalysisError, match="cannot open it"):
        Partial(tmp_path / "no folder" / "a", WHAT)
    with pytest.raises(hl.errors.AnalysisError, match="resume = True; needs the path of a file"):
        Partial(True, WHAT)


def swept(**changes):
    given = {"duration": 0.2, "metric": "energy", "progress": False, "x_o": 0.0, **AXES, **changes}
    return hl.sweep(hl.wall(), given.pop("paddle", PUSHED), **given)


def stopped_after(number):
    """Return a map that is interrupted, as by Ctrl-C, before it has so many results."""

    def mapped(function, pieces):
        for piece in pieces[:number]:
            yield function(piece)
        raise KeyboardInterrupt

    return mapped


def test_a_sweep_goes_on_where_it_was_interrupted(tmp_path, monkeypatch):
    monkeypatch.setattr(sweep_chunks, "MOST", 64)
    path, alone = tmp_path / "map.sweep", swept()
    with pytest.raises(KeyboardInterrupt) as stop:
        swept(workers=stopped_after(4), resume=path)
    (note,) = stop.value.__notes__
    done = int(note.split()[0])
    assert 0 < done < 360 and note == f"{done} of 360 points are in {str(path)!r}; the same call continues from there"
    given = []

    def counting(function, pieces):
        given.extend(piece.count for piece in pieces)
        return map(function, pieces)

    monkeypatch.setattr(sweep_chunks, "MOST", 50)  # other chunks than before
    np.testing.assert_array_equal(swept(workers=counting, resume=path).values, alone.values)
    assert sum(given) == 360 - done
    np.testing.assert_array_equal(swept(workers=stopped_after(0) and counting, resume=path).values, alone.values)
    assert sum(given) == 360 - done  # nothing was left to do


def test_a_file_that_two_have_filled_at_once(tmp_path, monkeypatch):
    """Each point twice, in chunks of other lengths: it counts once."""
    monkeypatch.setattr(sweep_chunks, "MOST", 64)
    path, alone = tmp_path / "map.sweep", swept(resume=tmp_path / "map.sweep")
    monkeypatch.setattr(sweep_chunks, "MOST", 50)
    with pytest.raises(KeyboardInterrupt):
        swept(workers=stopped_after(4), resume=tmp_path / "other.sweep")
    head, _, records = (tmp_path / "other.sweep").read_bytes().partition(b"\n")
    assert path.read_bytes().startswith(head) and len(records) > 4 * 40 * 8
    path.write_bytes(path.read_bytes() + records)
    before = path.stat().st_size
    np.testing.assert_array_equal(swept(resume=path).values, alone.values)
    assert path.stat().st_size == before


def test_a_stale_file_is_refused_and_says_why(tmp_path, monkeypatch):
    path = tmp_path / "map.sweep"
    swept(resume=path)
    for change, said in [
        ({"metric": "peak_force"}, "metric: energy there, peak_force here"),
        ({"duration": 0.3}, r"duration: 0.2 s there, 0.3 s here"),
        ({"k": AXES["k"] * (1 + 1e-15)}, "axis k: 60 from 50 to 800"),
        ({"v": 0.1}, "start: x = 0.0, v = 0.0 there"),
        ({"method": "heun"}, "options: none there, method = heun here"),
        ({"paddle": hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, noise=1e-5)}, "paddle: "),
    ]:
        with pytest.raises(hl.errors.AnalysisError, match=said):
            swept(resume=path, **change)
    for change in ({"x_o": 1e-9}, {"paddle": hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=PUSHED.hand, noise=1e-5, seed=8)}):
        with pytest.raises(hl.errors.AnalysisError, match="a different sweep"):  # what a line does not show is in the program
            swept(resume=path, **change)
    np.testing.assert_array_equal(swept(resume=path).values, swept().values)
    monkeypatch.setattr(sweep_plan, "__version__", "99.0")
    with pytest.raises(hl.errors.AnalysisError, match=r"hapticlab: \d+\.\d+\.\d+ there, 99.0 here"):
        swept(resume=path)


KILLED = """
import os, sys
sys.path[:0] = {path!r}
import test_sweep_file as t
from hapticlab.analysis.sweeps import sweep_chunks
sweep_chunks.MOST = 64
def dies(function, pieces):
    for piece in pieces[:3]:
        yield function(piece)
    os._exit(9)  # as a kill ends it: nothing is closed
t.swept(workers=dies, resume={file!r})
"""


@pytest.mark.wide
def test_a_sweep_goes_on_after_its_process_was_killed(tmp_path):
    """In another process, with other hashes: what it measured is the same to the bit, or the file would be refused."""
    path = tmp_path / "map.sweep"
    here = [str(Path(__file__).parent), *sys.path]
    done = subprocess.run([sys.executable, "-c", KILLED.format(path=here, file=str(path))], env={"PYTHONHASHSEED": "9"})
    assert done.returncode == 9
    before = path.stat().st_size
    np.testing.assert_array_equal(swept(resume=path).values, swept().values)
    assert path.stat().st_size > before > 64 * 3 * 8
