"""Whatever ends a run, and at whatever byte, the reports that were whole are there."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from hapticlab.errors import CourseError
from hapticlab.grading.journal import Journal, key_of
from hapticlab.grading.limits import Limits
from hapticlab.grading.report import ExerciseReport, Failing, Report
from hapticlab.grading.submission import Submission

FAILING = Failing({"x": [0.1, -2e-3]}, "nan", 2.5, "N", True)
EXERCISES = (ExerciseReport("k", "value", points=2.0, words="wé\n\u2603", failing=FAILING),)
ADA = Report("ada", "02", "Walls", "a.ipynb", "c0ffee", cells=((3, "NameError"),), exercises=EXERCISES)
BOB = Report("bob", "02", "Walls", "b.ipynb", "beef")


def test_a_journal_cut_at_any_byte_keeps_what_is_whole_and_goes_on(tmp_path):
    path = tmp_path / "j"
    with Journal(path) as journal:
        journal.write("1", ADA)
        length = path.stat().st_size  # it is there before the file is closed
        journal.write("2", BOB)
    whole = path.read_bytes()
    assert Journal(path).reports == {"1": ADA, "2": BOB}
    for cut in range(len(whole)):
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
            with pytest.raises(CourseError, match=r"another run writes .*journal\.jsonl"), Journal(path, fresh):
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
