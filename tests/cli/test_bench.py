"""`hapticlab bench`: the report it writes, and its exit code."""

import json

import pytest

from hapticlab.cli.main import main
from hapticlab.device.bring_up import bench as walk
from hapticlab.device.bring_up.practised import PractisingOwner


@pytest.fixture
def short(monkeypatch):
    """Walk three steps alone."""
    monkeypatch.setattr(walk, "OFF", {})
    monkeypatch.setattr(walk, "ON", {name: walk.ON[name] for name in ("switch", "host silent", "STOP")})


def test_it_writes_one_report_to_read_and_as_data(short, tmp_path, capsys):
    assert main(["bench", "--port", "sim://hapkit", "--out", str(tmp_path / "mine")]) == 0
    said, page = capsys.readouterr().out, (tmp_path / "mine.md").read_text("utf-8")
    facts = json.loads((tmp_path / "mine.json").read_text("utf-8"))
    assert facts["ended"] == "whole" and facts["whole"] and [f["step"] for f in facts["findings"]].count("switch") == 2
    assert "| host silent | stop time | 0.099 to 0.102 s |" in page and "mine.json" in said
    assert said.index("== switch") < said.index("== host silent")


def test_a_walk_that_ends_early_is_a_partial_report_and_no_success(short, tmp_path, monkeypatch):
    def interrupt(person, question, ask=PractisingOwner.ask):
        if "Switch the supply off" in question:
            raise KeyboardInterrupt
        return ask(person, question)

    monkeypatch.setattr(PractisingOwner, "ask", interrupt)
    assert main(["bench", "--port", "sim://hapkit", "--out", str(tmp_path / "mine")]) == 130
    assert "PARTIAL: interrupted in the step 'switch'; the motor is off" in (tmp_path / "mine.md").read_text("utf-8")
