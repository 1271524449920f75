"""`hapticlab bench` and `hapticlab doctor --report`: the reports they write, and the exit code of the bench."""

import json
from pathlib import Path

import pytest

from hapticlab.cli.main import main
from hapticlab.device.board.settings import changed, nominal
from hapticlab.device.bring_up import bench as walk
from hapticlab.device.bring_up.about import restorable
from hapticlab.device.bring_up.practised import PractisingOwner
from hapticlab.errors import PaddleError


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


def test_an_earlier_report_stays(short, tmp_path, capsys):
    for _ in range(3):
        main(["bench", "--port", "sim://hapkit", "--out", str(tmp_path / "mine")])
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        f"mine{number}.{kind}" for number in ("", "-2", "-3") for kind in ("md", "json")
    )
    assert "mine-3.md" in capsys.readouterr().out


def test_a_walk_that_ends_early_is_a_partial_report_and_no_success(short, tmp_path, monkeypatch):
    def interrupt(person, question, ask=PractisingOwner.ask):
        if "Switch the supply off" in question:
            raise KeyboardInterrupt
        return ask(person, question)

    monkeypatch.setattr(PractisingOwner, "ask", interrupt)
    assert main(["bench", "--port", "sim://hapkit", "--out", str(tmp_path / "mine")]) == 130
    assert "PARTIAL: interrupted in the step 'switch'; the motor is off" in (tmp_path / "mine.md").read_text("utf-8")


def test_settings_of_a_report_are_stored_again(short, tmp_path, monkeypatch, capsys):
    main(["bench", "--port", "sim://hapkit", "--out", str(tmp_path / "mine")])
    facts = json.loads((tmp_path / "mine.json").read_text("utf-8"))
    monkeypatch.setattr("builtins.input", lambda question: "yes")
    restore = ["bench", "--port", "sim://hapkit", "--restore", str(tmp_path / "mine.json")]
    assert main(restore) == 0
    assert "found equal in every bit" in capsys.readouterr().out
    for spoilt in ({"about": {"settings_hex": "00" + facts["about"]["settings_hex"][2:]}}, {"about": {"settings_hex": "00"}}, []):
        (tmp_path / "mine.json").write_text(json.dumps(spoilt), "utf-8")
        assert main(restore) == 1
    assert "another layout" in (said := capsys.readouterr().err) and "holds no settings" in said


def test_a_report_confirms_neither_a_wiring_nor_a_sign():
    """It did: a person who took the wiring back, or swapped the motor's wires since, had the confirmation of before again."""
    kept = nominal("hapkit", ident=7, wired=1, checked=1)
    assert restorable(kept, kept) == kept
    unconfirmed, swapped = changed(kept, wired=0, checked=0), changed(kept, motor_sign=-kept.motor_sign)
    other = changed(kept, carrier=31_372)
    for now, wired in ((None, 0), (unconfirmed, 0), (changed(kept, checked=0), 1), (swapped, 1), (other, 0)):
        assert restorable(kept, now) == changed(kept, wired=wired, checked=0)
    reversed_ = changed(swapped, metres_per_count=-kept.metres_per_count)  # x and the force have turned together
    assert restorable(kept, reversed_) == kept
    with pytest.raises(PaddleError, match=r"of paddle 0007, and this is 0008.*hapticlab calibrate"):
        restorable(kept, changed(kept, ident=8))


def test_a_doctor_writes_what_it_found_without_the_users_folder(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(Path, "home", lambda: Path("/home/quxley"))
    monkeypatch.setattr("hapticlab.device.setup.computer_checks.permission_cure", lambda: "sudo cp /home/quxley/x/rules /etc")
    monkeypatch.setattr("hapticlab.device.setup.computer_checks.UDEV", ())
    main(["doctor", "--port", "sim://hapkit", "--report", str(tmp_path / "found.json")])
    text = (tmp_path / "found.json").read_text("utf-8")
    found = json.loads(text)
    checks = {check["name"]: check["found"] for check in found["checks"]}
    assert {"firmware", "reset", "settings", "latency"} <= set(checks) and found["hapticlab"]
    assert "quxley" not in text
