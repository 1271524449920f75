"""What a worker grades with: the assignment, and processes for the students' code; what it is told and says is JSON text."""

from __future__ import annotations

import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path

from ..errors import HapticlabError
from .grade import Deferred, grade
from .handed_in.submission import Submission
from .report import Report
from .sessions.starter import start


@dataclass(frozen=True)
class Task:
    """A submission to grade, and the key of its report."""

    submission: Submission
    key: str


@dataclass(frozen=True)
class Reply:
    """What came of a task: a report; or none, where it is to be decided in the last turn, or the worker ended (``died``)."""

    report: Report | None = None
    seconds: float = 0.0
    died: bool = False
    problem: str = ""

    @classmethod
    def from_json(cls, text: str) -> Reply:
        """Return the reply that a worker wrote."""
        held = json.loads(text)
        report = Report.from_json(held["report"]) if held["report"] else None
        return cls(report, held["seconds"], problem=held["problem"])


def as_json(task: Task, last: bool) -> str:
    """The message that tells a worker its task."""
    return json.dumps({**asdict(task.submission), "last": last})


class Bench:
    """What a worker grades with: the assignment, and processes for the students' code. A context manager.

    Parameters
    ----------
    assignment : Assignment
    limits : Limits
    sandbox : {"auto", "namespaces", "user", "landlock", "none"}
    hidden : sequence of str
        Paths that no student's code may see, beside the answers.
    zygote : (socket, int), optional
        Of :meth:`Preloaded.zygote`; without it one is begun.
    """

    def __init__(self, assignment, limits, sandbox="auto", hidden=(), zygote=None):
        self.assignment, self.limits, self.sandbox = assignment, limits, sandbox
        paths = {Path(path) for path in (*hidden, *([assignment.answers] if assignment.answers else []))}
        # what lies in another one is hidden with that
        self.hidden = sorted(str(path) for path in paths if paths.isdisjoint(path.parents))
        self._starter, self._zygote = None, zygote

    def __enter__(self):
        zygote, self._zygote = self._zygote, None
        self._starter = start(self.sandbox, self.hidden, self.limits, self.assignment.untouched, zygote)
        self._starter.__enter__()
        return self

    def __exit__(self, *_):
        starter, self._starter = self._starter, None
        if starter is not None:
            starter.__exit__(None, None, None)

    @property
    def walls(self):
        """What stands around a student's processes."""
        return self._starter.walls

    def graded(self, text):
        """Grade a task of :func:`as_json`, and answer as JSON."""
        held, began = json.loads(text), time.perf_counter()
        last = held.pop("last")
        found, problem = self._found(Submission(**{**held, "cells": tuple(held["cells"])}), last)
        report = found.to_json() if isinstance(found, Report) else None
        return json.dumps({"report": report, "problem": problem, "seconds": time.perf_counter() - began})

    def _found(self, submission, last):
        """Return report or Deferred; or None, and why there is neither."""
        for again in (False, True):
            try:
                return grade(submission, self.assignment, self._starter, self.limits, last=last), ""
            except HapticlabError as problem:
                return None, f"the grader failed: {problem}"
            except Exception as problem:  # a student's code may end whatever it can reach; the class goes on
                if again:
                    return None, f"the grader failed: {type(problem).__name__}: {problem}"
                self.__exit__()
                self.__enter__()
        return Deferred(submission.student), ""
