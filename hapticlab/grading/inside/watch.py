"""Watching a session from outside: which processes it has, and how much memory they use, as Linux tells in /proc."""

import math
import os
import signal
import stat
import time
from contextlib import suppress
from pathlib import Path

PROC = Path("/proc")
PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096


def descendants(root):
    """Return the process ids below a process that still run, be it that their first thread has ended; the dead left aside.

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
    """Return (process, state, children); proc_pid_stat(5): the name before the state stands in parentheses.

    A process whose first thread has ended says Z while others run, and its memory is still there.
    """
    try:
        threads = os.listdir(PROC / str(process) / "task")
        states = [_fields(f"{process}/task/{thread}")[0] for thread in threads]
    except OSError:
        return process, "X", []
    running = [state for state in states if state not in "ZX"]
    return process, (running or ["Z"])[0], _children(process)


def _fields(process):
    return (PROC / process / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()


def _children(process):
    """Return the children of a process, proc_tid_children(5); one may be missed while another ends."""
    try:
        threads = os.listdir(PROC / str(process) / "task")
        return [int(c) for t in threads for c in (PROC / str(process) / "task" / t / "children").read_text().split()]
    except OSError:
        return []


def memory(processes):
    """Return the memory of processes that is no file's; what several share is counted once [bytes].

    proc_pid_smaps_rollup(5): of a page of three processes, each has a third.
    """
    return sum(_first_of(process, "smaps_rollup", ("Pss_Anon:", "Pss_Shmem:")) for process in processes)


def anonymous(process):
    """Return a process' resident memory that is no file's, shared or not [bytes]; proc_pid_status(5)."""
    return _first_of(process, "status", ("RssAnon:", "RssShmem:"))


def _first_of(process, file, names):
    """Return the sum of lines in kB of the first thread that has any: one that ended tells nothing [bytes]."""
    with suppress(OSError):
        for thread in os.listdir(PROC / str(process) / "task"):
            with suppress(OSError):
                # a name of several lines would be escaped, so no program feigns one of these
                lines = (PROC / str(process) / "task" / thread / file).read_text("utf-8", "replace").split("\n")
                found = [int(line.split()[1]) << 10 for line in lines if line.startswith(names)]
                if found:
                    return sum(found)
    return 0


def address_space(process):
    """Return the size of a process' address space [bytes]."""
    return int((PROC / str(process) / "statm").read_text().split()[0]) * PAGE


class Meter:
    """What a step of a session is charged: not what it waited for a processor that others had.

    Parameters
    ----------
    session : int
        Its process.
    """

    def __init__(self, session):
        self.session, self.began = session, time.monotonic()
        self.work = self.waited = 0.0
        self._work_before, self._wait_before = self._worked(), _waited(session)

    @property
    def wall(self):
        """Wall clock since the step began [s]."""
        return time.monotonic() - self.began

    def charged(self):
        """Return the greater of its processes' processor time, and the wall clock less what its main thread waited [s]."""
        # what has ended tells no more, so what was seen of it is kept
        self.work = max(self.work, self._worked() - self._work_before)
        self.waited = max(self.waited, _waited(self.session) - self._wait_before)
        return max(self.work, self.wall - self.waited)

    def _worked(self):
        return _processor(self.session) + sum(map(_processor, descendants(self.session)))


def _waited(process):
    """Time that the first thread of a process waited for a processor [s]; proc(5), schedstat."""
    try:
        return int((PROC / str(process) / "schedstat").read_text().split()[1]) / 1e9
    except (OSError, IndexError):  # a kernel without it: all of the wall clock is charged
        return 0.0


def _processor(process):
    """Return the processor time of a process with all its threads [s]; clock_getcpuclockid(3)."""
    try:
        return time.clock_gettime(~process << 3 | 2)
    except OSError:
        return 0.0


def kill_descendants(root):
    """Kill all processes found below one."""
    for process in descendants(root):
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)


def size(folder, deepest=64):
    """Size of a folder: bytes on the disk, and how many files and folders.

    One that is nested deeper, or whose folders cannot be looked into, has infinitely many.
    """
    total, count, left = 0, 0, [(folder, 0)]
    while left:
        place, depth = left.pop()
        try:
            entries = list(os.scandir(place))
        except FileNotFoundError:
            continue
        except NotADirectoryError:
            total += os.lstat(place).st_blocks * 512
            continue
        except OSError:
            return total, math.inf
        for entry in entries:
            count += 1
            with suppress(FileNotFoundError):
                total += entry.stat(follow_symlinks=False).st_blocks * 512
                if entry.is_dir(follow_symlinks=False):
                    if depth == deepest:
                        return total, math.inf
                    left.append((entry.path, depth + 1))
    return total, count


def writable_folders(top="/", deepest=4):
    """Return the folders in which anybody may write, some levels below the top; not those of the system's own views."""
    found, left = [], [(top, 0)]
    while left:
        place, depth = left.pop()
        with suppress(OSError):
            if os.stat(place).st_mode & stat.S_IWOTH:
                found.append(place)
            elif depth < deepest and place not in ("/proc", "/sys"):
                below = [entry.path for entry in os.scandir(place) if entry.is_dir(follow_symlinks=False)]
                left += [(path, depth + 1) for path in below]
    return found


def left_by(user, folders):
    """Files of a user in these folders."""
    found = []
    for folder in folders:
        with suppress(OSError):
            found += [entry.path for entry in os.scandir(folder) if entry.stat(follow_symlinks=False).st_uid == user]
    return found


def unlinked(process):
    """Bytes that a process holds in files without a name any more."""
    total = 0
    with suppress(OSError):
        for descriptor in os.scandir(PROC / str(process) / "fd"):
            with suppress(OSError):
                file = os.stat(descriptor.path)
                total += file.st_blocks * 512 if stat.S_ISREG(file.st_mode) and not file.st_nlink else 0
    return total
