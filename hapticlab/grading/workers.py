"""Processes that grade, one submission at a time each; what they say of it comes back as JSON text."""

import json
import multiprocessing
import os
import signal
import sys
import threading
import time
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass
from multiprocessing.connection import wait
from pathlib import Path

from ..errors import CourseError, HapticlabError
from . import asking
from .assignment import Assignment
from .formats.gradescope import GRADER_FAILED
from .grade import MOST_WALL, Deferred, grade
from .inside import linux
from .limits import Limits
from .preloaded import Preloaded
from .report import Report
from .starter import LEVELS, start
from .submission import Submission

#: how long to wait at a time [s]; on Windows Ctrl-C is heard in between only
LOOK = 0.5
#: time that a worker has beside its submission's, which it counts itself [s]
GRACE = 60.0


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
    def from_json(cls, text):
        """Return the reply that a worker wrote."""
        held = json.loads(text)
        report = Report.from_json(held["report"]) if held["report"] else None
        return cls(report, held["seconds"], problem=held["problem"])


def as_json(task, last):
    """Return what a worker is told of a task."""
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

    def __init__(self, assignment: Assignment, limits: Limits, sandbox="auto", hidden=(), zygote=None):
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
    def level(self):
        """Which walls there are around a student's processes."""
        return self._starter.level

    @property
    def refused(self):
        """Why there are no better ones, level to words."""
        return self._starter.refused

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
                return None, f"{GRADER_FAILED}: {problem}"
            except Exception as problem:  # a student's code may end whatever it can reach; the class goes on
                if again:
                    return None, f"{GRADER_FAILED}: {type(problem).__name__}: {problem}"
                self.__exit__()
                self.__enter__()
        return Deferred(submission.student), ""


def processor_seconds():
    """Return what this process and those it waited for took of processors [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def weakest(several):
    """Return the level that keeps students' code in least, and why there is no better one.

    Parameters
    ----------
    several : iterable of (str, dict)
        Of workers: level, and level to why it was refused.

    Examples
    --------
    >>> weakest([("namespaces", {}), ("none", {"namespaces": "forbidden", "user": "not root"}), ("user", {})])
    ('none', {'namespaces': 'forbidden', 'user': 'not root'})
    """
    return max(several, key=lambda one: LEVELS.index(one[0]))


class Workers:
    """Processes on this computer; a context manager. One that ends is replaced.

    Parameters
    ----------
    number : int
    *bench
        As :class:`Bench` takes them.
    preloaded : Preloaded, optional
        Of whose zygotes they use; without it one is begun where the system has them.
    """

    def __init__(self, number, *bench, preloaded=None):
        self.number, self._bench, self._all, self._preloaded = number, bench, [], preloaded
        self.level, self.refused, self.seconds = "", {}, 0.0

    def __enter__(self):
        with ExitStack() as stack:
            if self._preloaded is None and sys.platform == "linux":
                self._preloaded = stack.enter_context(Preloaded())
            stack.callback(self._end)
            for _ in range(self.number):
                self._all.append(_Worker(self._bench, self._preloaded))
            self.level, self.refused = weakest([worker.level() for worker in self._all])
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *_):
        self._stack.close()

    def _end(self):
        for worker in self._all:
            worker.end()
        for worker in self._all:
            worker.ended()
        self._all = []

    def graded(self, tasks, last):
        """Yield (task, Reply) as each is known."""
        tasks, busy = iter(tasks), {}
        while True:
            while len(busy) < self.number and (task := next(tasks, None)) is not None:
                worker = self._free(busy)
                worker.begin(task, last)
                busy[worker] = task
            if not busy:
                return
            for worker in _ready(busy):
                reply, task = worker.reply(), busy.pop(worker)
                if reply.died:
                    self._all.remove(worker)
                    worker.end()
                    worker.ended()
                yield task, reply

    def _free(self, busy):
        """Return a worker that has nothing to do, a new one where too many have died."""
        for worker in self._all:
            if worker not in busy:
                return worker
        self._all.append(_Worker(self._bench, self._preloaded))
        self.level, self.refused = weakest([(self.level, self.refused), self._all[-1].level()])
        return self._all[-1]


def _ready(busy):
    """Return the workers that have something to say, or have taken too long for saying anything."""
    while True:
        said = wait([worker.connection for worker in busy], LOOK)
        ready = [worker for worker in busy if worker.connection in said or time.monotonic() > worker.until]
        if ready:
            return ready


class _Worker:
    """A process with a bench, and the connection to it, which carries JSON."""

    def __init__(self, bench, preloaded):
        # a fork has all that this process loaded; on other systems a new interpreter, which takes nothing from the working folder
        context = multiprocessing.get_context("fork" if preloaded else "spawn")
        os.environ.setdefault("PYTHONSAFEPATH", "1")
        zygote = preloaded.zygote() if preloaded else None
        self.connection, there = context.Pipe()
        self._process = context.Process(target=_work, args=(there, bench, zygote), name="hapticlab grade")
        self._process.start()
        there.close()
        if zygote:
            zygote[0].close()
        self._most, self.until = MOST_WALL * bench[1].total + asking.MOST_WALL * bench[1].seconds + GRACE, 0.0

    def level(self):
        """Wait until it is ready, and return its level and why it has no better one; raise what keeps it from being so."""
        try:
            said = json.loads(self.connection.recv_bytes())
        except (EOFError, OSError):
            raise CourseError("a process that grades ended as it began; is there memory for it?") from None
        if said["problem"]:
            raise CourseError(said["problem"])
        return said["level"], said["refused"]

    def begin(self, task, last):
        """Give it a task; whether it still lives is seen when it should reply."""
        self.until = time.monotonic() + self._most
        with suppress(OSError):
            self.connection.send_bytes(as_json(task, last).encode())

    def reply(self):
        """Return what came of its task."""
        if not self.connection.poll():
            return Reply(died=True)
        try:
            return Reply.from_json(self.connection.recv_bytes())
        except (EOFError, OSError, ValueError, KeyError, TypeError):
            return Reply(died=True)

    def end(self):
        """Have it end; whatever it does is stopped."""
        if self._process.is_alive():
            self._process.terminate()

    def ended(self):
        """Wait for its end."""
        self._process.join(10)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()
        self.connection.close()


def _work(connection, bench, zygote):
    """Grade what comes, until the other end is gone: the whole life of a worker."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that began this one
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    if zygote:
        linux.die_with_parent()
        linux.close_all_but(0, 1, 2, connection.fileno(), zygote[0].fileno())
    else:
        threading.Thread(target=_end_with_parent, daemon=True).start()
    with suppress(EOFError, BrokenPipeError, ConnectionResetError):
        try:
            with Bench(*bench, zygote=zygote) as ready:
                connection.send_bytes(json.dumps({"level": ready.level, "refused": ready.refused, "problem": ""}).encode())
                while True:
                    connection.send_bytes(ready.graded(connection.recv_bytes()).encode())
        except HapticlabError as problem:
            connection.send_bytes(json.dumps({"level": "", "problem": str(problem)}).encode())


def _end_with_parent():
    """End this process where the one that began it was killed: what it would find nobody reads."""
    wait([multiprocessing.parent_process().sentinel])
    os._exit(1)
