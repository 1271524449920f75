"""Starting students' sessions, asking them, and ending them: the grader's side of the wall."""

import json
import os
import select
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict
from pathlib import Path

import hapticlab

from . import watch

#: what one look at a session's processes is apart from the next [s]
PERIOD = 0.03
#: of a reply, beside its values
FRAME = 1 << 16
PACKAGE = Path(hapticlab.__file__).resolve().parent
#: one thread, as a zygote forks; no port but a simulated one; the same order of sets in every run
ENVIRONMENT = {
    "PATH": "/usr/local/bin:/usr/bin:/bin",
    "LANG": "C.UTF-8",
    "PYTHONHASHSEED": "0",
    "PYTHONDONTWRITEBYTECODE": "1",
    "MPLBACKEND": "Agg",
    "HAPTICLAB_PORTS": "sim",
    **{f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL", "NUMEXPR", "VECLIB")},
}
#: in place of the folder that -c begins sys.path with: the folder of this package
PROGRAM = "import sys; sys.path[0] = sys.argv[2]; from hapticlab.grading.inside.zygote import main; main(int(sys.argv[1]))"


class SessionEnded(Exception):
    """A session is over before it replied.

    ``reason`` is "time", "memory", "processes", "exit", "signal N", "flood" or "garbage".
    """

    def __init__(self, reason):
        super().__init__(f"the session ended: {reason}")
        self.reason = reason


def start(sandbox="auto", hidden=()):
    """Return a Starter."""
    return Starter("none", hidden)


class Starter:
    """One zygote, which forks a session for each submission; a context manager.

    Attributes
    ----------
    level : str
        "namespaces", "user" or "none".
    """

    def __init__(self, level, hidden=()):
        self.level, self.hidden, self.now = level, tuple(hidden), None
        self._begin()

    def _begin(self):
        self.control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        arguments = [sys.executable, "-s", "-c", PROGRAM, str(theirs.fileno()), str(PACKAGE.parent)]
        cache = {name: os.environ[name] for name in ("HOME", "XDG_CACHE_HOME") if name in os.environ}
        null, environment = subprocess.DEVNULL, {**cache, **ENVIRONMENT}
        self.process = subprocess.Popen(arguments, env=environment, stdin=null, stdout=null, pass_fds=[theirs.fileno()])
        theirs.close()
        self.zygote = self._answer()["pid"]
        self.held = watch.anonymous(self.zygote)

    def _answer(self):
        return json.loads(self.control.recv(1 << 16))

    def session(self, limits):
        """Return a new Session; one that is still open ends."""
        if self.now:
            self.now.close()
        if self.process.poll() is not None:
            self._begin()
        self.now = Session(self, limits)
        return self.now

    def fork(self, request, *descriptors):
        """Ask the zygote for a session."""
        socket.send_fds(self.control, [json.dumps(request).encode()], descriptors)
        return self._answer()["pid"]

    def end(self):
        """Kill the session and all it started."""
        watch.kill_descendants(self.process.pid)
        try:
            self.control.send(b'{"do": "end"}')
            self._answer()
        except (OSError, ValueError):
            self.process.wait()  # somebody killed the zygote

    def close(self):
        """End the session and the zygote."""
        if self.now:
            self.now.close()
        self.control.close()
        self.process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Session:
    """A student's session, asked by :meth:`ask`; a context manager, which kills all its processes when it is left."""

    def __init__(self, starter, limits):
        self.starter, self.limits, self.number, self.open = starter, limits, 0, True
        self.scratch = tempfile.mkdtemp(prefix="hapticlab-")
        self.channel, theirs = socket.socketpair()
        self.channel.setblocking(False)
        self.status, status = os.pipe()
        base = watch.address_space(starter.zygote)
        request = {"do": "session", "scratch": self.scratch, "limits": asdict(limits), "base": base}
        starter.fork(request, theirs.fileno(), status)
        theirs.close()
        os.close(status)

    def ask(self, request, seconds):
        """Return the reply to a request.

        Parameters
        ----------
        request : dict
        seconds : float
            Wall clock [s].

        Raises
        ------
        SessionEnded
        """
        if not self.open:
            raise SessionEnded("exit")
        self.number += 1
        try:
            return self._reply(json.dumps({**request, "number": self.number}).encode() + b"\n", time.monotonic() + seconds)
        except SessionEnded:
            self.close()
            raise

    def _reply(self, line, deadline):
        """Send a line and wait for the reply, watching meanwhile; the end of the socket is no news, as anybody may hold it."""
        left, held, taken, look = memoryview(line), b"", 0, time.monotonic() + PERIOD
        poller = select.poll()
        poller.register(self.status, select.POLLIN)
        poller.register(self.channel, select.POLLIN | select.POLLOUT)
        while True:
            now = time.monotonic()
            if now >= deadline:
                raise SessionEnded("time")
            if now >= look:
                self.check()
                look = time.monotonic() + PERIOD
            events = dict(poller.poll(1e3 * max(0.001, min(look, deadline) - now)))
            about = events.get(self.channel.fileno(), 0)
            if about & select.POLLIN:
                block = self.received()
                taken += len(block)
                if taken > self.limits.answer + FRAME:
                    raise SessionEnded("flood")
                *lines, held = (held + block).split(b"\n")
                for reply in map(self.parsed, lines):
                    if reply is not None:
                        return reply
                if block:
                    continue
                poller.unregister(self.channel)
            elif about & select.POLLOUT:
                left = left[self.sent(left) :]
                if not left:
                    poller.modify(self.channel, select.POLLIN)
            elif about:
                poller.unregister(self.channel)
            if self.status in events and not about & select.POLLIN:
                code = os.read(self.status, 1)
                raise SessionEnded(f"signal {code[0]}" if code and code[0] else "exit")

    def received(self):
        """Return what has come; nothing at the end of the socket."""
        try:
            return self.channel.recv(1 << 20)
        except OSError:
            return b""

    def sent(self, line):
        """Return how much could be sent; where the other end is gone, the keeper will say how it ended."""
        try:
            return self.channel.send(line)
        except BlockingIOError:
            return 0
        except OSError:
            return len(line)

    def parsed(self, line):
        """Return the reply to the last request, or None for one before it."""
        try:
            reply = json.loads(line)
            number = reply.pop("number")
        except (ValueError, RecursionError, KeyError, AttributeError, TypeError):
            raise SessionEnded("garbage") from None
        return reply if number == self.number else None

    def check(self):
        """Raise where the session has too many processes, or too much memory."""
        found = watch.descendants(self.starter.zygote)
        if len(found) > self.limits.processes + 2:
            raise SessionEnded("processes")
        if watch.memory(found, self.starter.held) > self.limits.memory:
            raise SessionEnded("memory")

    def close(self):
        """Kill all processes of the session and delete what it wrote."""
        if self.open:
            self.open = False
            self.starter.end()
            self.channel.close()
            os.close(self.status)
            shutil.rmtree(self.scratch, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
