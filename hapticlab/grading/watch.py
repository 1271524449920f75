"""Watching a session from outside: which processes it has, and how much memory they use, as Linux tells in /proc."""

import os
import signal
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
    """Return a process' resident memory that is no file's [bytes]; proc_pid_statm(5)."""
    try:
        resident, files = (PROC / str(process) / "statm").read_text().split()[1:3]
    except (OSError, ValueError):
        return 0
    return (int(resident) - int(files)) * PAGE


def address_space(process):
    """Return the size of a process' address space [bytes]."""
    return int((PROC / str(process) / "statm").read_text().split()[0]) * PAGE


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
