"""Watching a session from outside: which processes it has, and how much memory they use, as Linux tells in /proc."""

import os
import signal
import time
from contextlib import suppress
from pathlib import Path

PROC = Path("/proc")
PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096

#: in the environment of a zygote and of all it forks; proc_pid_environ(5) tells it also where a program deleted its own
MARK = "HAPTICLAB_SESSIONS"


def descendants(root):
    """Return the process ids below a process that still run; zombies left aside.

    Examples
    --------
    >>> import os, subprocess, sys
    >>> child = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    >>> child.pid in descendants(os.getpid())
    True
    >>> child.kill(), child.wait(), child.stdin.close()
    (None, -9, None)
    >>> child.pid in descendants(os.getpid())
    False
    """
    found, left = [], _children(root)
    while left:
        process, state, its = _looked_at(left.pop())
        left += its
        if state not in "ZX":
            found.append(process)
    return found


def _looked_at(process):
    """Return (process, state, children); proc_pid_stat(5): the name before the state stands in parentheses."""
    try:
        state = (PROC / str(process) / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()[0]
    except OSError:
        return process, "X", []
    return process, state, _children(process)


def _children(process):
    """Return the children of a process, proc_tid_children(5); one may be missed while another ends."""
    try:
        threads = os.listdir(PROC / str(process) / "task")
        return [int(c) for t in threads for c in (PROC / str(process) / "task" / t / "children").read_text().split()]
    except OSError:
        return []


def memory(processes, shared=0):
    """Return what processes hold beyond files, and beyond what each shares with the one they were forked from [bytes].

    Parameters
    ----------
    processes : sequence of int
    shared : int
        What that one holds [bytes].
    """
    return sum(max(0, anonymous(process) - shared) for process in processes)


def anonymous(process):
    """Return a process' resident memory that is no file's, shared or not [bytes]; proc_pid_status(5)."""
    try:
        lines = (PROC / str(process) / "status").read_text("utf-8", "replace").split("\n")
    except OSError:
        return 0
    # a name of several lines would be escaped, so no program feigns one of these
    return sum(int(line.split()[1]) << 10 for line in lines if line.startswith(("RssAnon:", "RssShmem:")))


def address_space(process):
    """Return the size of a process' address space [bytes]."""
    return int((PROC / str(process) / "statm").read_text().split()[0]) * PAGE


class Meter:
    """What a step of a session is charged: not what it waited for a processor that others had.

    Parameters
    ----------
    zygote : int
        The session is below its only child, the keeper.
    """

    def __init__(self, zygote):
        self.zygote, self.began = zygote, time.monotonic()
        self.waited, self.wait_before, self.work_before = 0.0, self._waits(), self._work()

    @property
    def wall(self):
        """Wall clock since the step began [s]."""
        return time.monotonic() - self.began

    def charged(self):
        """Return the greater of its processes' processor time, and the wall clock less what its main thread waited [s]."""
        # a fork that has ended tells no more, so what was seen of it is kept
        waits = sum(wait - self.wait_before.get(process, 0.0) for process, wait in self._waits().items())
        self.waited = max(self.waited, waits)
        return max(self._work() - self.work_before, self.wall - self.waited)

    def _waits(self):
        """Return what the session's main thread waited, and that of the fork which evaluates for it [s]; proc(5), schedstat."""
        session = [child for keeper in _children(self.zygote) for child in _children(keeper)[:1]]
        return {process: _waited(process) for process in session + [fork for one in session for fork in _children(one)[-1:]]}

    def _work(self):
        return sum(map(_worked, descendants(self.zygote)))


def _waited(process):
    try:
        return int((PROC / str(process) / "schedstat").read_text().split()[1]) / 1e9
    except (OSError, IndexError):  # a kernel without it: all of the wall clock is charged
        return 0.0


def _worked(process):
    """Return the processor time of a process and of its children that ended [s]; proc_pid_stat(5), utime to cstime."""
    try:
        fields = (PROC / str(process) / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()
    except OSError:
        return 0.0
    return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


def kill_descendants(root):
    """Kill all processes found below one."""
    for process in descendants(root):
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)


def kill_marked(mark):
    """Kill all processes that began, or whose parents began, with a mark in their environment."""
    for entry in filter(str.isdigit, os.listdir(PROC)):
        with suppress(OSError):
            if f"{MARK}={mark}".encode() in (PROC / entry / "environ").read_bytes():
                os.kill(int(entry), signal.SIGKILL)


def size(folder):
    """Return what a folder holds on the disk [bytes]."""
    total = 0
    for where, _, names in os.walk(folder):
        for name in names:
            with suppress(OSError):
                total += os.lstat(os.path.join(where, name)).st_blocks * 512
    return total


def threads_of(user):
    """Return how many threads a user runs now."""
    count = 0
    for entry in filter(str.isdigit, os.listdir(PROC)):
        try:
            if (PROC / entry).stat().st_uid == user:
                count += len(os.listdir(PROC / entry / "task"))
        except OSError:
            continue
    return count
