"""Sessions on a system without Linux' fork and /proc: each a new interpreter.

There is a deadline, and the bounds on what is answered; nothing bounds memory and processes, and nothing is hidden.
"""

import json
import os
import queue
import secrets
import signal
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import suppress
from dataclasses import asdict

from .asking import FRAME, Replies, SessionEnded
from .preloaded import ENVIRONMENT, FIND_PACKAGE, FLAGS, PACKAGE

PROGRAM = FIND_PACKAGE + "from hapticlab.grading.inside.standalone_session import main; main()"
#: without these no interpreter starts on Windows
KEPT = ("SYSTEMROOT", "WINDIR", "TEMP", "PATH")
#: how long an interpreter may take to start [s]
START = 120.0


class SpawnedStarter:
    """Starts a process for each session; a context manager. Its level is "none"."""

    level = "none"

    def __init__(self, walls=None):
        self.walls = walls

    def session(self, limits):
        """Return a new SpawnedSession."""
        return SpawnedSession(limits)

    def close(self):
        """Do nothing: each session ends its own process."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class SpawnedSession:
    """As :class:`hapticlab.grading.sessions.asking.Session`; ``charged`` is wall clock, without the start of its interpreter."""

    def __init__(self, limits):
        self.limits, self.charged, self.open = limits, 0.0, True
        self.folder = tempfile.TemporaryDirectory(prefix="hapticlab-", ignore_cleanup_errors=True)
        home = dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR"), self.folder.name)
        kept = {name: os.environ[name] for name in KEPT if name in os.environ}
        self.process = subprocess.Popen(
            [sys.executable, *FLAGS, "-c", PROGRAM, str(PACKAGE.parent), json.dumps(asdict(self.limits))],
            cwd=self.folder.name,
            env={**ENVIRONMENT, **kept, **home},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            bufsize=0,
            start_new_session=True,
        )
        self.blocks = queue.Queue()
        threading.Thread(target=_read, args=(self.process.stdout, self.blocks), daemon=True).start()
        try:
            self._reply({"do": "ready"}, START)
        except SessionEnded as end:
            self.close()
            raise RuntimeError(f"an interpreter did not start: {end}") from None

    def ask(self, request, seconds):
        """Return the reply to a request, or raise SessionEnded; ``seconds`` of wall clock."""
        if not self.open:
            raise SessionEnded("exit")
        began = time.monotonic()
        try:
            return self._reply(request, seconds)
        except SessionEnded:
            self.close()
            raise
        finally:
            self.charged += time.monotonic() - began

    def _reply(self, request, seconds):
        number, deadline = secrets.token_hex(8), time.monotonic() + seconds
        line = json.dumps({**request, "number": number}).encode() + b"\n"
        # in a thread: what nobody reads is never written to its end
        threading.Thread(target=_write, args=(self.process.stdin, line), daemon=True).start()
        replies = Replies(number, self.limits.answer + FRAME)
        while True:
            try:
                block = self.blocks.get(timeout=max(0.0, deadline - time.monotonic()))
            except queue.Empty:
                raise SessionEnded("time") from None
            if not block:
                code = self.process.wait()
                raise SessionEnded(f"signal {-code}" if code < 0 else "exit")
            if (reply := replies.found(block)) is not None:
                return reply

    def _kill(self):
        """Kill the process with its group, or on Windows with its children."""
        if os.name == "posix":
            with suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)
        else:
            subprocess.run(["taskkill", "/F", "/T", "/PID", str(self.process.pid)], capture_output=True, check=False)
        self.process.wait()
        self.process.stdin.close()
        with suppress(RecursionError):  # nested deeper than Python deletes
            self.folder.cleanup()

    def close(self):
        """Kill its process and delete what it wrote."""
        if self.open:
            self.open = False
            self._kill()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def _read(stream, blocks):
    """Put what comes into a queue, at the end an empty block; one that others still write to is simply never read on."""
    with stream:
        while block := stream.read(FRAME):
            blocks.put(block)
    blocks.put(b"")


def _write(stream, line):
    left = memoryview(line)
    with suppress(OSError, ValueError):  # it has ended, as the reader will see
        while left:
            left = left[stream.write(left) :]
