"""A class is graded with any number of workers, is killed half way, goes on, and its reports are the same bytes."""

import json
import os
import select
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the attackers among them need namespaces, which are Linux'")

if sys.platform == "linux":
    from attacks.arena import Arena
    from attacks.mixed import mixed

ROOT = Path(__file__).parents[2]
SECONDS = 2
#: grades as the command does, and is killed, as `kill -9` does, once it has written so many reports; tells whom it leaves behind
KILLED = """
import os, signal, sys
from pathlib import Path
from hapticlab.cli import main
from hapticlab.grading import journal, watch

if __name__ == "__main__":
    most, left = int(sys.argv[1]), Path(sys.argv[2])
    write, written = journal.Journal.write, []

    def written_down(self, *report):
        write(self, *report)
        written.append(report)
        if len(written) == most:
            left.write_text(" ".join(map(str, watch.descendants(os.getpid()))))
            os.kill(os.getpid(), signal.SIGKILL)

    journal.Journal.write = written_down
    main(sys.argv[3:])
"""


def command(arena, output, workers):
    lab = ["--lab", str(arena.lab), "--instructor", str(arena.answers.parent), "--seed", "3", "--timeout", str(SECONDS)]
    return ["grade", str(arena.submissions), *lab, "--format", "json", "-o", str(output), "--workers", str(workers)]


def graded(arguments):
    """Run the command and return what it said."""
    python = [sys.executable, "-m", "hapticlab", *arguments]
    done = subprocess.run(python, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    return done.stderr


def killed(arguments, most, place):
    """Run the command, have it killed after so many reports, and wait until none of its processes is left."""
    program, left = place / "killed.py", place / "left"
    program.write_text(KILLED)
    done = subprocess.run(
        [sys.executable, program, str(most), left, *arguments],
        cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    assert done.returncode == -9
    return [pid for pid in map(int, left.read_text().split()) if not _ends(pid)]


def _ends(pid, seconds=20):
    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    try:
        return bool(select.select([descriptor], [], [], seconds)[0])
    finally:
        os.close(descriptor)


def same_bytes(place, number):
    class_ = mixed(number, seed=number)
    with Arena(place, class_) as arena:
        once, again = place / "once.json", place / "again.json"
        graded(command(arena, once, workers=1))
        assert not killed(command(arena, again, workers=2), number // 2, place)
        assert not again.exists()
        said = graded(command(arena, again, workers=2))
        assert f"{number // 2} known from before" in said
        assert once.read_bytes() == again.read_bytes()
        earned = {one["student"]: one for one in json.loads(once.read_text())["reports"]}
        assert len(earned) == number
        for one in class_:
            right = sum(exercise["earned"] for exercise in earned[one.name]["exercises"])
            assert right == one.earned, (one.name, earned[one.name])
        assert not arena.reached()


def test_a_few_graded_twice_and_once_killed(tmp_path):
    same_bytes(tmp_path, 10)


@pytest.mark.slow
def test_a_thousand_graded_twice_and_once_killed(tmp_path):
    same_bytes(tmp_path, 1000)
