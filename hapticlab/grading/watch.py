"""Watching a session from outside: which processes it has, and how much memory they use, as Linux tells in /proc."""

import os
import signal
from pathlib import Path

PROC = Path("/proc")
PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096


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
    children = {}
    for entry in os.listdir(PROC):
        if entry.isdigit():
            state, parent = _state(entry)
            children.setdefault(parent, []).append((int(entry), state))
    found, left = [], [root]
    while left:
        for child, state in children.get(left.pop(), ()):
            left.append(child)
            if state not in "ZX":
                found.append(child)
    return found


def _state(entry):
    """Return (state, parent) of a process; proc_pid_stat(5): the name before them stands in parentheses."""
    try:
        state, parent = (PROC / entry / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()[:2]
    except (OSError, ValueError):
        return "X", 0
    return state, int(parent)


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
    """Kill all processes below one, also those that are started meanwhile."""
    while found := descendants(root):
        for process in found:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                continue


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
