"""A fresh interpreter that loads what notebooks need once, and forks: zygotes for graders, and these a session a submission.

No process here ever held an answer, so no session can find one in its memory. One thread only, as a fork takes no other along.

    preloaded (main) --fork--> zygote (serve), one a grader --fork--> session, one a submission
"""

import gc
import importlib
import json
import os
import select
import signal
import socket
import sys
from contextlib import suppress

from . import linux, sandbox
from .watch import kill_descendants

#: beside what the package itself loads; by name, as all of it is needed only where the walls hold
SESSION, SLICES = "hapticlab.grading.inside.session", "hapticlab.grading.inside.slices"
PRELOADED = ("matplotlib.pyplot", SESSION)


def main(control):
    """Load, then fork a zygote for each socket that comes, until the other end is closed; say what all took of processors.

    Parameters
    ----------
    control : int
        File descriptor of a SOCK_SEQPACKET socket.
    """
    control = socket.socket(fileno=control)
    linux.become_subreaper()
    os.umask(0o022)  # in the new root, others pass through the folders it makes
    preload()
    zygotes = []
    with suppress(ConnectionError):
        while (received := socket.recv_fds(control, 1 << 16, 1))[0]:
            if not received[1]:  # all zygotes end as their graders have
                wait_for(zygotes)
                control.send(json.dumps({"processor": sum(os.times()[:4])}).encode())
                continue
            (descriptor,) = received[1]
            child = os.fork()
            if child == 0:
                control.close()
                serve(socket.socket(fileno=descriptor))
                os._exit(0)
            os.close(descriptor)
            zygotes.append(child)
            control.send(json.dumps({"process": child}).encode())
    wait_for(zygotes)  # each ends as its grader does
    wait_for_all()
    os._exit(0)  # nothing is left to be put in order, nor told that it was ended


def serve(control):
    """Go on as a zygote: serve a grader until it closes.

    Parameters
    ----------
    control : socket
        Requests: ``probe``, ``ready``, ``session`` with one file descriptor, ``end``.
    """
    linux.become_subreaper()
    session, request = 0, {"user": 0}
    with suppress(ConnectionError):
        while message := (received := socket.recv_fds(control, 1 << 20, 1))[0]:
            request, answer = json.loads(message), {}
            if request["do"] == "probe":
                answer = probe(request)
            elif request["do"] == "ready":
                settle(request)
                sys.modules[SLICES].needed(request["cells"], ())  # what students left as it came is then known
            elif request["do"] == "session":
                session = start(request, *received[1])
                os.close(*received[1])
                answer = {"process": session}
            else:
                answer, session = end(session, request), 0
            control.send(json.dumps(answer).encode())
    end(session, {**request, "grace": 0})


def settle(request):
    """Move into the root that all sessions see, where there are namespaces."""
    if request["level"] == "namespaces":
        sandbox.move(request["new"], request["seen"], request["hidden"])


def probe(request):
    """A session's view: {"read": a file it must not read, "missing": one it must}; or {"problem": ...}."""
    outlet, inlet = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            linux.become_subreaper()
            settle(request)
            os.waitpid(start(request, inlet), 0)
        except OSError as problem:
            os.write(inlet, json.dumps({"problem": str(problem)}).encode() + b"\n")
        finally:
            os._exit(0)
    os.close(inlet)
    os.waitpid(child, 0)
    with os.fdopen(outlet, "rb") as said:
        found = said.readline()
    return json.loads(found) if found else {"problem": "a session ended at once"}


def preload():
    """Load what notebooks use, and run a scene once, which fills caches on the way."""
    gc.disable()  # it finds nothing among what is loaded, and looks at all of it again and again
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
    gc.enable()


def start(request, channel):
    """Fork a session and return its process id, or 0 where the system refused one, which the channel then says why.

    In namespaces it is process 1 of its own: its end is the end of all it started.
    """
    if request["level"] != "namespaces":
        return forked(request, channel)
    outlet, inlet = os.pipe()
    between = os.fork()
    if between == 0:
        session = 0
        try:
            linux.unshare(sandbox.NAMESPACES)
            session = forked(request, channel)
        except OSError as problem:
            os.write(channel, json.dumps({"problem": str(problem)}).encode() + b"\n")
        finally:
            os.write(inlet, str(session).encode())
            os._exit(0)
    os.close(inlet)
    os.waitpid(between, 0)  # the session is a child of this process from here on
    with os.fdopen(outlet) as said:
        return int(said.read() or 0)


def forked(request, channel):
    """Fork a session, and return its process id."""
    session = os.fork()
    if session == 0:
        try:
            become_session(request, channel)
        except OSError as problem:
            os.write(channel, json.dumps({"problem": str(problem)}).encode() + b"\n")
        finally:
            os._exit(1)
    return session


def become_session(request, channel):
    """Go on as a student's session: behind the walls, with one file descriptor and nothing else."""
    os.setsid()
    linux.close_all_but(2, channel)
    if request["level"] == "namespaces":
        sandbox.furnish(request)
    null = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1, 2):
        os.dup2(null, standard)
    if null > 2:
        os.close(null)
    sandbox.enter(request)
    if request["do"] == "probe":
        os.write(channel, json.dumps(sandbox.findings(request)).encode() + b"\n")
        os._exit(0)
    sys.stdin, sys.stdout, sys.stderr = os.fdopen(0), os.fdopen(1, "w"), os.fdopen(2, "w")
    sys.modules[SESSION].Session(channel, request["limits"]).serve()
    os._exit(0)


def end(session, request):
    """Kill a session and all it started, wait until all is gone, and return how it ended by itself: {"code": ...}.

    It has ``grace`` seconds to end by itself: of a process that is ending its channel is closed first. None where it did not.
    """
    code = None
    if session:
        own = os.pidfd_open(session)
        if request["grace"] and select.select([own], [], [], request["grace"])[0]:
            code = os.waitstatus_to_exitcode(os.waitpid(session, 0)[1])
        else:
            signal.pidfd_send_signal(own, signal.SIGKILL)
            os.waitpid(session, 0)
        os.close(own)
    if request["user"] and request["level"] != "namespaces":
        sandbox.kill_user(request["user"])
    wait_for_all()
    return {"code": code}


def wait_for(zygotes):
    """Wait for zygotes alone: what Python itself starts, such as its resource tracker, ends only after this process."""
    while zygotes:
        os.waitpid(zygotes.pop(), 0)


def wait_for_all():
    """Kill what is below this process, and wait until it has no child: nothing that one of them starts meanwhile is left."""
    with suppress(ChildProcessError):
        while True:
            kill_descendants(os.getpid())
            os.waitpid(-1, 0)
