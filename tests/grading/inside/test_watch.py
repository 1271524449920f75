"""What is seen of a process from outside."""

import math
import os
import subprocess
import sys
from contextlib import ExitStack

import pytest

from hapticlab.grading.inside.watch import Meter, anonymous, size

LARGE = 40 << 20
HOLDS = {
    "its own": f"held = b'x' * {LARGE}",
    "shared": f"import mmap\nheld = mmap.mmap(-1, {LARGE})\nheld.write(b'x' * {LARGE})",
}


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("kind", HOLDS)
def test_memory_is_counted_whether_shared_or_not(kind):
    program = [sys.executable, "-I", "-S", "-c", HOLDS[kind] + "\nprint(flush=True)\ninput()"]
    with subprocess.Popen(program, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        process.stdout.readline()
        assert LARGE < anonymous(process.pid) < 1.5 * LARGE
        process.communicate(b"\n")


#: computes for so long by its own clock, between two lines that it reads and writes
WORKS = """
import time
print(flush=True)
input()
while time.process_time() < {}: pass
print(time.process_time(), flush=True)
input()
"""


@pytest.mark.wide
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("rivals", [0, 2])
def test_a_meter_charges_what_a_process_works_and_not_what_it_waits_for_a_processor(rivals):
    (first, *_) = os.sched_getaffinity(0)

    def begun(seconds):
        program = [sys.executable, "-I", "-S", "-c", WORKS.format(seconds)]
        process = subprocess.Popen(program, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        os.sched_setaffinity(process.pid, {first})
        process.stdout.readline()
        return process

    with ExitStack() as running:
        one, *others = (running.enter_context(begun(seconds)) for seconds in (0.6, *[60.0] * rivals))
        for process in (one, *others):
            running.callback(process.kill)
        meter = Meter(one.pid)
        for process in (*others, one):
            process.stdin.write(b"\n")
            process.stdin.flush()
        worked, wall = float(one.stdout.readline()), meter.wall
        assert 0.5 < worked <= 0.7
        assert meter.charged() == pytest.approx(worked, rel=0.25), "of which the start was not charged"
        assert wall > (1.5 if rivals else 0.8) * worked


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_a_meter_charges_sleep():
    with subprocess.Popen([sys.executable, "-I", "-S", "-c", "input()"], stdin=subprocess.PIPE) as process:
        meter = Meter(process.pid)
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(0.3)
        charged = meter.charged()  # first: the wall's clock goes on meanwhile
        assert meter.wall >= charged > 0.25
        process.communicate(b"\n")


def test_what_is_nested_too_deep_or_cannot_be_read_counts_for_infinitely_many(tmp_path):
    place = tmp_path
    for _ in range(70):
        place = place / "d"
        place.mkdir()
        (place / "f").write_bytes(bytes(5000))
    assert size(tmp_path)[1] == math.inf
    total, count = size(place)
    assert total >= 5000 and count == 1
