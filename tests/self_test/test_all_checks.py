"""Whatever a check does, the walk goes on; the file says what was found, and names nobody."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import hapticlab
from hapticlab.cli import main
from hapticlab.self_test import report
from hapticlab.self_test.all_checks import alone, walk
from hapticlab.self_test.outcome import ATTENTION, FAULT, OK, Outcome
from hapticlab.self_test.table import Check

BROKEN = """
import os, sys
from hapticlab.self_test.outcome import Attention, Fault

def fine(folder):
    return f"{list(folder.iterdir())} in {folder}"

def ends(folder):
    print("these words were its last", flush=True)
    os._exit(7)

def hangs(folder):
    print("it waits", flush=True)
    while True:
        pass

def stops(folder):
    sys.exit(0)

def raises(folder):
    return 1 / 0

def notes(folder):
    raise Attention("llvmlite is not installed")

def fails(folder):
    raise Fault("other bits: \\u58c1")
"""


@pytest.fixture
def broken(tmp_path, monkeypatch):
    """Return what makes a Check of a function above, which processes can import."""
    (tmp_path / "broken_checks.py").write_text(BROKEN, "utf-8")
    paths = [str(tmp_path), str(Path(hapticlab.__file__).parents[1])]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))
    return lambda name: Check(name, f"that {name} is told", f"broken_checks.{name}")


@pytest.mark.parametrize(
    "name, state, words",
    [
        ("fine", OK, "[] in "),
        ("ends", FAULT, "its process ended with code 7 before it gave an answer; it had printed: these words were its last"),
        ("stops", FAULT, "SystemExit"),
        ("raises", FAULT, "ZeroDivisionError"),
        ("notes", ATTENTION, "llvmlite is not installed"),
        ("fails", FAULT, "other bits: 壁"),
        ("no_such_check", FAULT, "AttributeError"),
    ],
)
def test_what_a_check_does_is_told(broken, name, state, words):
    outcome = alone(broken(name), 60)
    assert outcome.state == state and words in outcome.found, outcome


@pytest.mark.wide
def test_a_check_that_hangs_is_ended(broken):
    outcome = alone(broken("hangs"), 2.0)
    assert outcome.state == FAULT and "it did not end within 2 s" in outcome.found


def test_neither_a_crash_nor_the_end_of_the_time_ends_the_walk(broken):
    told = []
    found = walk([broken(name) for name in ("ends", "fails", "fine")], tell=told.append)
    assert found == told and [outcome.state for outcome in found] == [FAULT, FAULT, OK]
    (late,) = walk([broken("fine")], tell=lambda _: None, limit=0.5)
    assert late.state == ATTENTION and "not run" in late.found


def test_the_file_says_what_was_found_and_the_last_lines_what_to_do(broken, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(report, "CHECKS", [broken(name) for name in ("fine", "notes", "fails")])
    file = tmp_path / "a folder" / "result.json"
    assert main.main(["doctor", "--self-test", "--out", str(file)]) == 1
    told = capsys.readouterr()
    assert "choose another file with --out" in told.err and "checks;" not in told.out
    file.parent.mkdir()
    assert main.main(["doctor", "--self-test", "--out", str(file)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert "1 checks ok, 1 need attention, 1 found a fault." in lines
    assert str(file) in lines[-2] and "send this one file" in lines[-1]
    facts = json.loads(file.read_text("utf-8"))
    found = {check["name"]: check["state"] for check in facts["checks"]}
    assert found == {"fine": OK, "notes": ATTENTION, "fails": FAULT}
    assert facts["checks"][2]["found"] == ["other bits: 壁"] and facts["system"]["python"]


def test_on_a_console_that_is_not_utf_8_the_walk_goes_on(broken, tmp_path):
    code = (
        "from hapticlab.cli.main import main; from hapticlab.self_test import report\n"
        "from hapticlab.self_test.table import Check\n"
        "report.CHECKS = [Check('fails', 'fails', 'broken_checks.fails')]\n"
        f"raise SystemExit(main(['doctor', '--self-test', '--out', {str(tmp_path / 'found.json')!r}]))"
    )
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "LC_ALL": "C", "PYTHONUTF8": "0"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, env=environment)
    assert done.returncode == 1 and done.stderr == b""
    assert rb"other bits: \u58c1" in done.stdout


class Windows:
    """What the report asks of a computer, answered as on one whose user is Ada Lovelace."""

    node = staticmethod(lambda: "ENGINE-1842.example")
    user, home, temp = "Ada Lovelace", r"C:\Users\Ada Lovelace", r"C:\Users\ADALOV~1\AppData\Local\Temp"


@pytest.fixture
def windows(monkeypatch):
    monkeypatch.setattr(report.platform, "node", Windows.node)
    monkeypatch.setattr(report.getpass, "getuser", lambda: Windows.user)
    monkeypatch.setattr(report.Path, "home", lambda: Windows.home)
    monkeypatch.setattr(report.tempfile, "gettempdir", lambda: Windows.temp)


@pytest.mark.parametrize(
    "text",
    [
        r"File C:\Users\Ada Lovelace\labs\wall.py, line 3",
        r"c:\users\ada lovelace\labs",
        json.dumps(r"C:\Users\Ada Lovelace\labs"),
        "C:/Users/Ada Lovelace/labs",
        r"C:\Users\ADALOV~1\AppData\Local\Temp\hapticlab-x1",
        r"D:\ADALOV~1\labs",
        r"E:\data\Ada Lovelace\x",
        "on engine-1842.example and ENGINE-1842",
    ],
)
def test_no_name_is_told(windows, text):
    told = report.without_names(text).lower()
    assert not any(name in told for name in ("ada", "lovelace", "engine", "1842")), told


def test_a_short_name_is_replaced_in_paths_and_left_in_words(windows, monkeypatch):
    monkeypatch.setattr(report.getpass, "getuser", lambda: "vm")
    assert report.without_names("the stored bits by vm, in /srv/vm/labs") == "the stored bits by vm, in /srv/USER/labs"


def test_a_system_without_a_name_for_its_user_is_no_hindrance(monkeypatch):
    def nobody():
        raise KeyError("getpwuid(): uid not found: 1000")

    monkeypatch.setattr(report.getpass, "getuser", nobody)
    assert json.loads(report.written([Outcome("a", "b", OK, "c")]))["checks"][0]["found"] == ["c"]
