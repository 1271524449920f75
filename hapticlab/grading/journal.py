"""Reports are written down as they are made, so that a run which was ended, however, goes on where it was."""

import hashlib
import json
import sys
from dataclasses import asdict
from pathlib import Path

from ..errors import CourseError
from .report import Report

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

#: the byte that Windows locks: far behind all that is written
LOCKED = 1 << 40


class Journal:
    """Reports by their keys, in a file of one line of JSON for each; a context manager.

    A line that was cut, because the run was killed while it wrote, is as none. The file may be read while it grows; one run
    writes it at a time.

    Parameters
    ----------
    path : str or Path or None
        None keeps nothing.
    fresh : bool
        Forget what is there.

    Examples
    --------
    >>> with Journal(None) as journal:
    ...     journal.write("key", Report("ada", "02", "Walls", "wall.ipynb"))
    ...     journal.reports
    {}
    """

    def __init__(self, path, fresh=False):
        self.path, self._fresh = None if path is None else Path(path), fresh
        self.reports = {} if fresh else self._read()

    def __enter__(self):
        self._file = None if self.path is None else self.path.open("ab", buffering=0)
        if self._file:
            self._lock()
            if self._fresh:
                self._file.truncate(0)
            elif self._file.tell():
                self._append(b"\n")  # what was cut stays a line of its own
        return self

    def _lock(self):
        """Keep other runs from writing, until the file is closed or this process ends, however."""
        try:
            if sys.platform == "win32":
                self._file.seek(LOCKED)
                msvcrt.locking(self._file.fileno(), msvcrt.LK_NBLCK, 1)
                self._file.seek(0, 2)
            else:
                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            self._file.close()
            raise CourseError(
                f"another run is writing {self.path}; wait until it ends, or write the results to a different file"
            ) from None
        except OSError:  # some file systems of a network have no locks
            pass

    def __exit__(self, *_):
        if self._file:
            self._file.close()

    def write(self, key, report):
        """Write down a report, at once."""
        if self._file:
            self._append(json.dumps({"key": key, "report": report.to_json()}).encode() + b"\n")

    def _append(self, left):
        """Write bytes, at once, to the last one."""
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError as problem:  # of a disk that is full, without the name of the file
            words = "The earlier reports are kept. Free some disk space and run the same command again"
            raise CourseError(f"cannot write {self.path}: {problem.strerror or problem}. {words}") from None

    def _read(self):
        """Return the reports that are whole, by their keys; of several the last."""
        if self.path is None or not self.path.is_file():
            return {}
        found = (_entry(line) for line in self.path.read_bytes().split(b"\n"))
        return {entry[0]: entry[1] for entry in found if entry}


def _entry(line):
    """Return key and report of a line, or None where it is not whole."""
    try:
        held = json.loads(line)
        return held["key"], Report.from_json(held["report"])
    except (ValueError, KeyError, TypeError, AttributeError):
        return None


def key_of(submission, assignment, limits, sandbox):
    """The key of a report: all that it depends on.

    Parameters
    ----------
    submission : Submission
    assignment : Assignment
    limits : Limits
    sandbox : str
        The walls asked for around the student's processes.
    """
    held = (submission.student, submission.name, submission.sha256, assignment.digest, asdict(limits), sandbox)
    return hashlib.sha256(json.dumps(held).encode()).hexdigest()
