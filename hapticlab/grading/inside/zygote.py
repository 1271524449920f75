"""The zygote: a fresh interpreter that has loaded what notebooks need, and forks a session for each submission.

It never held an answer, so no session can find one in its memory. One thread only, as a fork takes no other along.
"""

import errno
import gc
import importlib
import json
import os
import signal
import socket
import sys
from contextlib import suppress

from ..watch import MARK, kill_descendants
from . import linux, sandbox
from .keeper import keep, prepare

#: beside what the package itself loads; by name, as all of it is needed only where the walls hold
SESSION = "hapticlab.grading.inside.session"
PRELOADED = ("matplotlib.pyplot", "scipy.integrate", SESSION)


def main(control):
    """Serve the grader over a socket, until it closes it.

    Parameters
    ----------
    control : int
        File descriptor of a SOCK_SEQPACKET socket. Requests: ``probe``, ``ready``, ``session`` with two file descriptors,
        ``end``.
    """
    control = socket.socket(fileno=control)
    linux.become_subreaper()
    del os.environ[MARK]
    os.umask(0o022)  # in the new root, others pass through the folders it makes
    keeper = user = 0
    try:
        while message := (received := socket.recv_fds(control, 1 << 20, 2))[0]:
            request, descriptors = json.loads(message), received[1]
            user, answer = request["user"], {}
            if request["do"] == "probe":
                answer = probe(request)
            elif request["do"] == "ready":
                preload()
                settle(request)
            elif request["do"] == "session":
                keeper = start(request, *descriptors)
                for descriptor in descriptors:
                    os.close(descriptor)
            else:
                end(keeper, user)
                keeper = 0
            control.send(json.dumps(answer).encode())
    except OSError as problem:
        if problem.errno not in (errno.EPIPE, errno.ECONNRESET):  # the grader closes while it is served
            raise
    finally:
        end(keeper, user)


def settle(request):
    """Move into the root that all sessions see, where there are namespaces."""
    if request["level"] == "namespaces":
        sandbox.move(request["new"], request["seen"], request["hidden"])


def probe(request):
    """Return what a session would find: {"read": a file it must not read, "missing": one it must}; or {"problem": ...}."""
    outlet, inlet = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            linux.become_subreaper()
            settle(request)
            os.waitpid(start(request, inlet, inlet), 0)
        except OSError as problem:
            os.write(inlet, json.dumps({"problem": str(problem)}).encode() + b"\n")
        finally:
            os._exit(0)
    os.close(inlet)
    os.waitpid(child, 0)
    found = os.read(outlet, 1 << 16)
    os.close(outlet)
    return json.loads(found.partition(b"\n")[0]) if found else {"problem": "a session ended at once"}


def preload():
    """Load what notebooks use, and run a scene once, which fills caches on the way."""
    for name in PRELOADED:
        importlib.import_module(name)
    package = sys.modules["hapticlab"]
    for name in package.__all__:
        try:
            getattr(package, name)
        except ImportError:
            continue  # an optional dependency is not installed
    importlib.import_module("tqdm").tqdm.monitor_interval = 0  # else its first bar starts a thread
    package.parameters("k", units="N/m")
    package.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).run(package.wall()(k=150.0, x_o=0.01), duration=0.01)
    sys.modules["hapticlab.course.felt"].felt(package.wall()(k=150.0, x_o=0.01), x=[0.0, 0.012])
    gc.collect()
    gc.freeze()


def start(request, channel, status):
    """Fork a session and return the process id of its keeper, or 0 where the system refused one."""
    outlet, inlet = os.pipe()
    between = os.fork()
    if between == 0:
        try:
            become_keeper(request, channel, status, inlet)
        except OSError as problem:
            os.write(channel, json.dumps({"problem": str(problem)}).encode() + b"\n")
        finally:
            os._exit(1)
    os.close(inlet)
    keeper = int(os.read(outlet, 32) or 0)
    os.close(outlet)
    if keeper != between:
        os.waitpid(between, 0)  # then the keeper is a child of this process
    return keeper


def become_keeper(request, channel, status, inlet):
    """Go on as a keeper, in namespaces as process 1 of its own, which takes one more fork."""
    namespaces = request["level"] == "namespaces"
    if namespaces:
        linux.unshare(sandbox.NAMESPACES)
        keeper = os.fork()
        if keeper:
            os.write(inlet, str(keeper).encode())
            os._exit(0)
    else:
        os.write(inlet, str(os.getpid()).encode())
    prepare()
    if namespaces:
        sandbox.furnish(request)
    session = os.fork()
    if session:
        keep(session, status)
    become_session(request, channel)


def become_session(request, channel):
    """Go on as a student's session: behind the walls, with one file descriptor and nothing else."""
    os.setsid()
    linux.close_all_but(2, channel)
    sandbox.enter(request)
    linux.die_with_parent()
    null = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1, 2):
        os.dup2(null, standard)
    if null > 2:
        os.close(null)
    if request["do"] == "probe":
        os.write(channel, json.dumps(sandbox.findings(request)).encode() + b"\n")
        os._exit(0)
    sys.stdin, sys.stdout, sys.stderr = os.fdopen(0), os.fdopen(1, "w"), os.fdopen(2, "w")
    sys.modules[SESSION].Session(channel, request["limits"]).serve()
    os._exit(0)


def end(keeper, user):
    """Kill a session, and wait until all of it is gone.

    In namespaces the keeper's end is the end of all. Elsewhere orphans become children of this process.
    """
    if keeper:
        os.kill(keeper, signal.SIGKILL)
        os.waitpid(keeper, 0)
    if user:
        sandbox.kill_user(user)
    with suppress(ChildProcessError):
        while True:
            if os.waitpid(-1, os.WNOHANG)[0] == 0:
                kill_descendants(os.getpid())
