"""What is seen of a process from outside."""

import subprocess
import sys

import pytest

from hapticlab.grading.watch import anonymous

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
