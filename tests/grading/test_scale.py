"""A class is graded with any number of workers, is killed half way, goes on, and its reports are the same bytes."""

import json
import os
import re
import select
import subprocess
import sys
from pathlib import Path

import pytest

from hapticlab.cli.main import main

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the attackers among them need namespaces, which are Linux'")

if sys.platform == "linux":
    from attacks.arena import Arena
    from attacks.mixed import SECONDS, mixed

ROOT = Path(__file__).parents[2]
#: in attacks that kill, interrupt or flood their own session: whether an answer or an end is seen first is chance, what they earn
#: is not
RACING = (b"getppid", b"kill(-1", b"setitimer", b"set_blocking")
#: grades as the command does, and is killed, as `kill -9` does, once it has written so many reports, or, where that is 0, while
#: it grades those that met a limit; tells whom it leaves behind
KILLED = """
import os, signal, sys
from pathlib import Path
from hapticlab.cli.main import main
from hapticlab.grading import journal, workers
from hapticlab.grading.inside import watch

def end():
    Path(sys.argv[2]).write_text(" ".join(map(str, watch.descendants(os.getpid()))))
    os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    most = int(sys.argv[1])
    write, begin, written = journal.Journal.write, workers._Worker.begin, []

    def written_down(self, *report):
        write(self, *report)
        written.append(report)
        if len(written) == most:
            end()

    def begun(self, task, last):
        begin(self, task, last)
        if last and not most:
            end()

    journal.Journal.write, workers._Worker.begin = written_down, begun
    main(sys.argv[3:])
"""


def command(arena, output, workers):
    lab = ["--lab", str(arena.lab), "--instructor", str(arena.answers.parent), "--seed", "3", "--timeout", str(SECONDS)]
    output = ["--format", "json", "-o", str(output), "--workers", str(workers), "--sandbox", "namespaces"]
    return ["grade", str(arena.submissions), *lab, *output]


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


def same_bytes(place, number, capsys, *ends):
    class_ = mixed(number, seed=number)
    with Arena(place, class_) as arena:
        once, again = place / "once.json", place / "again.json"
        assert main(command(arena, once, workers=1)) in (0, 1)
        for most in ends:
            assert not killed(command(arena, again, workers=2), most, place)
            assert not again.exists()
        capsys.readouterr()
        assert main(command(arena, again, workers=2)) in (0, 1)
        left = int(re.search("([0-9]+) graded, [0-9]+ known from before", capsys.readouterr().err)[1])
        assert 0 < left < number / 2, "what waited for a limit, at the end"
        first, second = ({one["student"]: one for one in json.loads(file.read_text())["reports"]} for file in (once, again))
        assert len(first) == number and [*first] == [*second]
        for one in class_:
            for found in (first, second):
                right = sum(exercise["earned"] for exercise in found[one.name]["exercises"])
                assert right == one.earned, (one.name, found[one.name])
        racing = {one.name for one in class_ if any(word in content for word in RACING for content in one.files.values())}
        assert len(racing) < number / 10
        if not racing:
            assert once.read_bytes() == again.read_bytes()
        assert {name for name in first if first[name] != second[name]} <= racing
        assert not arena.reached()


@pytest.mark.wide
def test_a_few_graded_twice_and_once_killed(tmp_path, here, capsys):
    with here():  # but for the run that is killed, which has two workers
        same_bytes(tmp_path, 10, capsys, 0)


@pytest.mark.slow
def test_a_thousand_graded_twice_and_killed_half_way_and_near_the_end(tmp_path, capsys):
    same_bytes(tmp_path, 1000, capsys, 500, 0)
