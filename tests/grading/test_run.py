"""A class is graded: the same reports with any number of workers, whoever ends them, and however often it begins anew."""

import json
import os
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from attacks.small_lab import HONEST, OPEN, notebook, write_lab

from hapticlab.cli.main import main
from hapticlab.errors import CourseError
from hapticlab.grading import formats, workers
from hapticlab.grading.assignment import find_assignment
from hapticlab.grading.run import run
from hapticlab.grading.sessions.limits import Limits
from hapticlab.grading.sessions.preloaded import Preloaded

LIMITS = Limits(seconds=2.0)
CLASS = {
    "ada": HONEST,
    "bob": HONEST | {"why": 'why = "a"'},
    "cy": OPEN,
    "dan": HONEST | {"force": "import time\ndef force(x, k):\n    time.sleep(1e6)"},
    "eve": HONEST | {"energy": "import os\ndef energy(x, k):\n    os._exit(1)"},
}
#: of whose submissions a report is kept before dan's
BEFORE_DAN = 3
EARNED = {"ada": 10.0, "bad": 0.0, "bob": 9.0, "cy": 0.0, "dan": 8.0, "eve": 8.0}


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    place = tmp_path_factory.mktemp("course")
    lab, answers = write_lab(place)
    (place / "class").mkdir()
    for student, cells in CLASS.items():
        (place / "class" / f"{student}.ipynb").write_bytes(notebook(cells.values()))
    (place / "class" / "bad.ipynb").write_text("nothing")
    return place / "class", find_assignment(lab, answers.parent, seed=3), place


@pytest.fixture(scope="module")
def one(course, here):
    with here():
        return run(course[:1], course[1], LIMITS, workers=1)


def test_each_earns_what_is_right(one):
    assert {report.student: report.earned for report in one.reports} == EARNED
    assert [report.student for report in one.reports] == sorted(EARNED)
    assert [report.student for report in one.failed] == ["bad"] and one.failed[0].problem.startswith(
        "bad.ipynb is not a notebook"
    )
    assert len(one.seconds) == len(CLASS) and one.processor > 0


@pytest.mark.slow  # test_scale has two workers, and one that is killed
@pytest.mark.skipif(sys.platform != "linux", reason="kills a process")
def test_two_workers_one_of_which_is_killed_give_the_same_bytes(one, course, tmp_path, monkeypatch):
    (tmp_path / "zed.ipynb").write_bytes(notebook(HONEST.values()))
    begin = workers._Worker.begin

    def begun(self, task, last):
        begin(self, task, last)
        if task.submission.student == "zed":
            self._process.kill()

    monkeypatch.setattr(workers._Worker, "begin", begun)
    paths, given = [course[0], tmp_path / "zed.ipynb"], {"workers": 2, "journal": tmp_path / "j"}
    *others, zed = run(paths, course[1], LIMITS, **given).reports
    assert [report.to_json() for report in others] == [report.to_json() for report in one.reports]
    assert (zed.student, zed.earned) == ("zed", 0.0) and "ended twice" in zed.problem
    again = run([course[0]], course[1], LIMITS, **given)
    assert again.seconds == () and again.reports == tuple(others) and again.walls.level == "", "all is known: no process began"


@pytest.mark.wide
@pytest.mark.skipif(sys.platform != "linux", reason="sessions are forked from another process")
def test_the_processor_time_of_sessions_is_counted_and_charged(course, tmp_path):
    folder, assignment, _ = course
    (tmp_path / "bob.ipynb").write_bytes(notebook((HONEST | {"force": "def force(x, k):\n    while True: pass"}).values()))
    with Preloaded() as lent:
        asleep = run([folder / "ada.ipynb"], assignment, Limits(seconds=1.0), preloaded=lent)
        burnt = run([tmp_path / "bob.ipynb"], assignment, Limits(seconds=1.0), preloaded=lent)
    (report,) = burnt.reports
    assert report.earned == 8.0 and {one.name: one.ended for one in report.exercises}["force"] == "time"
    # a quarter of the limit the quick way, all of it in the notebook; what the first run took is in the second count too
    assert 1.25 < burnt.processor - asleep.processor < 10 and asleep.processor > 0.5


@pytest.mark.wide
def test_what_keeps_a_worker_from_beginning_is_said(course):
    with pytest.raises(CourseError, match="sandbox"):
        run([course[0] / "ada.ipynb"], course[1], LIMITS, sandbox="iron")


@pytest.mark.wide
@pytest.mark.skipif(os.name == "nt", reason="there is no SIGINT to send to one process")
def test_ctrl_c_ends_cleanly_and_the_same_command_goes_on(one, course, here, tmp_path, capsys):
    folder, assignment, _ = course
    shutil.copytree(folder, tmp_path / "class")
    output, journal = tmp_path / "results.json", tmp_path / "results.json.journal.jsonl"
    # dan's answer outlasts this test
    arguments = ["grade", str(tmp_path / "class"), "--lab", str(assignment.folder.path), "--timeout", "600", "--workers", "1"]
    arguments += ["--instructor", str(assignment.answers.parent), "--seed", "3", "--format", "json", "-o", str(output)]
    env = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    command = [sys.executable, "-m", "hapticlab", *arguments]
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored, as nohup has it, the command would inherit it
    with subprocess.Popen(command, env=env, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        signal.signal(signal.SIGINT, before)
        try:
            while not (journal.is_file() and journal.read_bytes().count(b"\n") == BEFORE_DAN):
                with suppress(subprocess.TimeoutExpired):
                    pytest.fail(f"it ended by itself: {process.wait(0.05)}")
            os.killpg(process.pid, signal.SIGINT)
            told = process.communicate(timeout=60)[1]
        finally:
            process.kill()  # whatever went wrong: dan's answer takes ten minutes
    assert process.returncode == 130 and "the same command again goes on" in told and "Traceback" not in told
    assert not output.exists()
    (tmp_path / "class" / "dan.ipynb").write_bytes(notebook(HONEST.values()))
    with here():
        assert main(arguments) == 1
    assert f"2 graded, {BEFORE_DAN} known from before" in capsys.readouterr().err
    found = {held["student"]: held for held in json.loads(output.read_text())["reports"]}
    assert found.pop("dan")["earned"] == 10.0
    known = json.loads(formats.write("json", one.reports))["reports"]
    assert found == {held["student"]: held for held in known if held["student"] != "dan"}
