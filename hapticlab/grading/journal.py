"""Reports are written down as they are made, so that a run which was ended, however, goes on where it was."""

import hashlib
import json
from dataclasses import asdict
from pathlib import Path

from .report import Report


class Journal:
    """Reports by their keys, in a file of one line of JSON for each; a context manager.

    A line that was cut, because the run was killed while it wrote, is as none. The file may be read while it grows.

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
        self.path = None if path is None else Path(path)
        if fresh and self.path is not None:
            self.path.unlink(missing_ok=True)
        self.reports = self._read()

    def __enter__(self):
        self._file = None if self.path is None else self.path.open("ab")
        if self._file and self._file.tell():
            self._file.write(b"\n")  # what was cut stays a line of its own
        return self

    def __exit__(self, *_):
        if self._file:
            self._file.close()

    def write(self, key, report):
        """Write down a report, at once."""
        if self._file:
            self._file.write(json.dumps({"key": key, "report": report.to_json()}).encode() + b"\n")
            self._file.flush()

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
    """Return what a report is found again by: all that it depends on.

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
