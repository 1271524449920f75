"""Whatever ends a run, and at whatever byte, the reports that were whole are there."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from hapticlab.errors import CourseError
from hapticlab.grading.handed_in.submission import Submission
from hapticlab.grading.journal import Journal, key_of
from hapticlab.grading.report import ExerciseReport, Failing, Report
from hapticlab.grading.sessions.limits import Limits

FAILING = Failing({"x": [0.1, -2e-3]}, "nan", 2.5, "N", True)
EXERCISES = (ExerciseReport("k", "value", points=2.0, words="wé\n\u2603", failing=FAILING),)
ADA = Report("ada", "02", "Walls", "a.ipynb", "c0ffee", cells=((3, "NameError"),), exercises=EXERCISES)
BOB = Report("bob", "02", "Walls", "b.ipynb", "beef")


@pytest.mark.parametrize("step", [7, pytest.param(1, marks=pytest.mark.wide)])
def test_a_journal_cut_at_any_byte_keeps_what_is_whole_and_goes_on(tmp_path, step):
    path = tmp_path / "j"
    with Journal(path) as journal:
        journal.write("1", ADA)
        length = path.stat().st_size  # it is there before the file is closed
        journal.write("2", BOB)
    whole = path.read_bytes()
    assert Journal(path).reports == {"1": ADA, "2": BOB}
    ends = range(length - 2, length + 2), range(len(whole) - 2, len(whole))
    for cut in sorted({*range(0, len(whole), step), *ends[0], *ends[1]}):
        path.write_bytes(whole[:cut])
        kept = ({"1": ADA} if cut >= length - 1 else {}) | ({"2": BOB} if cut >= len(whole) - 1 else {})
        with Journal(path) as journal:
            assert journal.reports == kept
            journal.write("3", BOB)
        assert Journal(path).reports == {**kept, "3": BOB}


def test_lines_of_something_else_are_as_none_and_fresh_forgets(tmp_path):
    path = tmp_path / "j"
    path.write_bytes(b'\xff\xfe\n[]\n{"key": "1"}\n{"key": "1", "report": "{}"}\n7\n{"key": "1", "report": 3}\n')
    assert Journal(path).reports == {}
    with Journal(path) as journal:
        journal.write("1", ADA)
    with Journal(path, fresh=True) as journal:
        assert journal.reports == {}
    assert path.read_bytes() == b""


def test_one_run_writes_a_journal_at_a_time(tmp_path):
    path = tmp_path / "r.json.journal.jsonl"
    with Journal(path) as journal:
        journal.write("1", ADA)
        for fresh in (False, True):
            with pytest.raises(CourseError, match=r"another run is writing .*journal\.jsonl"), Journal(path, fresh):
                pass
        journal.write("2", BOB)
    with Journal(path) as journal:
        assert journal.reports == {"1": ADA, "2": BOB}


def test_a_key_is_of_all_that_a_report_depends_on():
    handed_in, assignment = Submission("ada", "a.ipynb", ("k = 1",), "c0ffee"), SimpleNamespace(digest="d1")
    keys = {
        key_of(handed_in, assignment, Limits(), "auto"),
        key_of(replace(handed_in, student="bob"), assignment, Limits(), "auto"),
        key_of(replace(handed_in, name="b.ipynb"), assignment, Limits(), "auto"),
        key_of(replace(handed_in, sha256="beef"), assignment, Limits(), "auto"),
        key_of(handed_in, SimpleNamespace(digest="d2"), Limits(), "auto"),
        key_of(handed_in, assignment, Limits(seconds=3.0), "auto"),
        key_of(handed_in, assignment, Limits(), "none"),
    }
    assert len(keys) == 7
    assert key_of(replace(handed_in, cells=()), assignment, Limits(), "auto") in keys, "cells are those of the digest"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no disk that is always full")
def test_a_full_disk_is_told_with_the_files_name(tmp_path):
    path = tmp_path / "r.json.journal.jsonl"
    path.symlink_to("/dev/full")
    with pytest.raises(CourseError, match=r"cannot write .*r\.json\.journal\.jsonl: No space left"), Journal(path) as journal:
        journal.write("1", ADA)


@pytest.mark.skipif(sys.platform == "win32", reason="this system bounds no file")
def test_a_disk_that_fills_up_keeps_what_was_whole_and_the_next_run_goes_on(tmp_path):
    path = tmp_path / "j"
    code = f"""
import resource, sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
from test_journal import ADA, Journal
with Journal({str(path)!r}) as journal:
    journal.write("1", ADA)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
    for key in "23456789":
        journal.write(key, ADA)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert f"CourseError: cannot write {path}: File too large. The earlier reports are kept" in done.stderr
    kept = Journal(path).reports
    assert 1 <= len(kept) < 8 and path.stat().st_size == 1000
    with Journal(path) as journal:
        journal.write("9", BOB)
    assert Journal(path).reports == {**kept, "9": BOB}
