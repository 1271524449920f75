"""The zygote: a fresh interpreter that has loaded what notebooks need, and forks a session for each submission.

It never held an answer, so no session can find one in its memory. One thread only, as a fork takes no other along.
"""

import gc
import importlib
import json
import os
import signal
import socket
import sys

import hapticlab

from ...course.evaluate import evaluate
from . import linux, sandbox
from .keeper import keep, prepare
from .session import Session

#: beside what the package itself loads
PRELOADED = ("matplotlib.pyplot", "scipy.signal", "scipy.integrate", "scipy.optimize")


def main(control):
    """Serve the grader over a socket, until it closes it.

    Parameters
    ----------
    control : int
        File descriptor of a SOCK_SEQPACKET socket. Requests: ``session`` with two file descriptors, ``end``.
    """
    control = socket.socket(fileno=control)
    linux.become_subreaper()
    preload()
    control.send(json.dumps({"pid": os.getpid()}).encode())
    keeper = 0
    while True:
        message, descriptors, *_ = socket.recv_fds(control, 1 << 16, 2)
        if not message:
            return
        request = json.loads(message)
        if request["do"] == "session":
            keeper = start(control, request, *descriptors)
            for descriptor in descriptors:
                os.close(descriptor)
        else:
            end(keeper)
        control.send(json.dumps({"pid": keeper}).encode())


def preload():
    """Load what notebooks use, and run a scene once, which fills caches on the way."""
    for name in PRELOADED:
        importlib.import_module(name)
    for name in hapticlab.__all__:
        try:
            getattr(hapticlab, name)
        except ImportError:
            continue  # an optional dependency is not installed
    evaluate("scene", hapticlab.wall()(k=150.0, x_o=0.01), {"x": [0.0, 0.012]})
    gc.collect()
    gc.freeze()


def start(control, request, channel, status):
    """Fork a session and return the process id of its keeper."""
    keeper = os.fork()
    if keeper:
        return keeper
    try:
        control.close()
        prepare()
        session = os.fork()
        if session:
            keep(session, status)
        run(request, channel)
    finally:
        os._exit(1)


def run(request, channel):
    """Become a student's session: behind the walls, with one file descriptor and nothing else."""
    os.setsid()
    linux.close_all_but(2, channel)
    sandbox.enter(request)
    null = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1, 2):
        os.dup2(null, standard)
    if null > 2:
        os.close(null)
    sys.stdin, sys.stdout, sys.stderr = os.fdopen(0), os.fdopen(1, "w"), os.fdopen(2, "w")
    Session(channel, request["limits"]).serve()
    os._exit(0)


def end(keeper):
    """Kill a session, and wait for all that came back to this process."""
    try:
        os.kill(keeper, signal.SIGKILL)
        while True:
            os.waitpid(-1, 0 if keeper else os.WNOHANG)
    except (ChildProcessError, ProcessLookupError):
        pass
