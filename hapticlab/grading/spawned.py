"""Sessions on a system without Linux' fork and /proc: each a new interpreter.

Where the whole notebook ran, each request for answers has an interpreter of its own, as it has a fork elsewhere. Where only
the statements ran that answers need, they share one: nothing is called wrong there, at worst it is asked for once more.

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
from pathlib import Path

from .asking import FRAME, SessionEnded, parsed

PROGRAM = "import sys; sys.path[0] = sys.argv[1]; from hapticlab.grading.inside.alone import main; main()"
#: without these no interpreter starts on Windows
KEPT = ("SYSTEMROOT", "WINDIR", "TEMP", "PATH")
#: how long an interpreter may take to start [s], and a request that was answered before, in what its kind may
START, MOST_AGAIN = 120.0, 3


class SpawnedStarter:
    """Starts a process for each session; a context manager. Its level is "none"."""

    level = "none"

    def __init__(self, package, environment):
        self.refused = dict.fromkeys(("namespaces", "user"), "only Linux has it")
        self.package = str(Path(package).parent)
        self.environment = {**{name: os.environ[name] for name in KEPT if name in os.environ}, **environment}

    def session(self, limits):
        """Return a new SpawnedSession."""
        return SpawnedSession(self, limits)

    def close(self):
        """Do nothing: each session ends its own process."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class SpawnedSession:
    """As :class:`hapticlab.grading.asking.Session`; what it was asked before is asked anew in each further interpreter.

    ``charged`` is wall clock, without the start of interpreters and what is asked anew there.
    """

    def __init__(self, starter, limits):
        self.starter, self.limits, self.charged = starter, limits, 0.0
        self.asked, self.evaluated, self.shared, self.open = [], False, False, True
        self._start()

    def _start(self):
        self.folder = tempfile.TemporaryDirectory(prefix="hapticlab-", ignore_cleanup_errors=True)
        home = dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR"), self.folder.name)
        self.process = subprocess.Popen(
            [sys.executable, "-s", "-c", PROGRAM, self.starter.package, json.dumps(asdict(self.limits))],
            cwd=self.folder.name,
            env={**self.starter.environment, **home},
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
        try:
            if request["do"] == "evaluate" and self.evaluated:
                self._begin_anew()
            began = time.monotonic()
            try:
                reply = self._reply(request, seconds)
            finally:
                self.charged += time.monotonic() - began
        except SessionEnded:
            self.close()
            raise
        if request["do"] == "evaluate":
            self.evaluated = not self.shared
        else:
            self.asked.append(request)
            self.shared = request["do"] == "run_pieces"
        return reply

    def _begin_anew(self):
        self._kill()
        self._start()
        for request in self.asked:
            self._reply(request, MOST_AGAIN * self.limits.seconds)

    def _reply(self, request, seconds):
        number, deadline = secrets.token_hex(8), time.monotonic() + seconds
        line = json.dumps({**request, "number": number}).encode() + b"\n"
        # in a thread: what nobody reads is never written to its end
        threading.Thread(target=_write, args=(self.process.stdin, line), daemon=True).start()
        held, taken = b"", 0
        while True:
            try:
                block = self.blocks.get(timeout=max(0.0, deadline - time.monotonic()))
            except queue.Empty:
                raise SessionEnded("time") from None
            if not block:
                code = self.process.wait()
                raise SessionEnded(f"signal {-code}" if code < 0 else "exit")
            taken += len(block)
            if taken > self.limits.answer + FRAME:
                raise SessionEnded("flood")
            *lines, held = (held + block).split(b"\n")
            for reply in (parsed(line, number) for line in lines):
                if reply is not None:
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
