"""Processes that grade, one submission at a time each; what they say of it comes back as JSON text."""

import json
import multiprocessing
import os
import signal
import sys
import threading
import time
from contextlib import ExitStack, nullcontext, suppress
from dataclasses import asdict
from multiprocessing.connection import wait

from ..analysis.sweeps.workers import safe_path
from ..errors import CourseError, HapticlabError
from .bench import Bench, Reply, as_json
from .grade import MOST_WALL
from .inside import linux
from .sessions import asking
from .sessions.preloaded import Preloaded
from .sessions.starter import Walls, weakest

#: how long to wait at a time [s]; on Windows Ctrl-C is heard in between only
LOOK = 0.5
#: time that a worker has beside its submission's, which it counts itself [s]
GRACE = 60.0


def processor_seconds():
    """Processor time of this process and those it waited for [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


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
        self.number, self._bench, self._all, self._preloaded, self._lent = number, bench, [], preloaded, preloaded
        self.walls, self.seconds = Walls(), 0.0

    def __enter__(self):
        with ExitStack() as stack:
            if self._preloaded is None and sys.platform == "linux":
                self._preloaded = stack.enter_context(Preloaded())
            stack.callback(self._end)
            for _ in range(self.number):
                self._all.append(_Worker(self._bench, self._preloaded))
            self.walls = weakest([worker.walls() for worker in self._all])
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
        self.seconds = self._lent.processor() if self._lent else 0.0  # one's own is waited for, and counted with that

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
        self.walls = weakest([self.walls, self._all[-1].walls()])
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
        zygote = preloaded.zygote() if preloaded else None
        self.connection, there = context.Pipe()
        self._process = context.Process(target=_work, args=(there, bench, zygote), name="hapticlab grade")
        with nullcontext() if preloaded else safe_path():
            self._process.start()
        there.close()
        if zygote:
            zygote[0].close()
        self._most, self.until = MOST_WALL * bench[1].total + asking.MOST_WALL * bench[1].seconds + GRACE, 0.0

    def walls(self):
        """Wait until it is ready, and return its walls; raise what keeps it from being so."""
        try:
            said = json.loads(self.connection.recv_bytes())
        except (EOFError, OSError):
            raise CourseError("a grading process ended at its start; is there enough memory?") from None
        if said["problem"]:
            raise CourseError(said["problem"])
        return Walls(**said["walls"])

    def begin(self, task, last):
        """Give it a task; whether it still lives is seen when it should reply."""
        self.until = time.monotonic() + self._most
        with suppress(OSError):
            self.connection.send_bytes(as_json(task, last).encode())

    def reply(self):
        """The outcome of its task."""
        if not self.connection.poll():
            return Reply(died=True)
        try:
            return Reply.from_json(self.connection.recv_bytes())
        except (EOFError, OSError, ValueError, KeyError, TypeError):
            return Reply(died=True)

    def end(self):
        """Have it end; whatever it does is stopped."""
        self.connection.close()  # it ends when it reads on, should the signal come where no exception gets out
        if self._process.is_alive():
            self._process.terminate()

    def ended(self):
        """Wait for its end, after :meth:`end`."""
        self._process.join(10)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()


def _work(connection, bench, zygote):
    """Grade what comes, until the other end is gone: the whole life of a worker."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that began this one
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    os.chdir(os.path.abspath(os.sep))  # away from what was handed in
    if zygote:
        linux.die_with_parent()
        linux.close_all_but(0, 1, 2, connection.fileno(), zygote[0].fileno())
    else:
        threading.Thread(target=_end_with_parent, daemon=True).start()
    with suppress(EOFError, BrokenPipeError, ConnectionResetError):
        try:
            with Bench(*bench, zygote=zygote) as ready:
                connection.send_bytes(json.dumps({"walls": asdict(ready.walls), "problem": ""}).encode())
                while True:
                    connection.send_bytes(ready.graded(connection.recv_bytes()).encode())
        except HapticlabError as problem:
            connection.send_bytes(json.dumps({"problem": str(problem)}).encode())


def _end_with_parent():
    """End this process where the one that began it was killed: what it would find nobody reads."""
    wait([multiprocessing.parent_process().sentinel])
    os._exit(1)
