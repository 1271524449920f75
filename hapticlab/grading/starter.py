"""Starting students' sessions, asking them, and ending them: the grader's side of the wall."""

import json
import os
import secrets
import shutil
import socket
import subprocess
import sys
import tempfile
from contextlib import nullcontext, suppress
from dataclasses import asdict
from pathlib import Path

from ..errors import CourseError
from . import watch
from .asking import Session
from .asking import SessionEnded as SessionEnded
from .limits import Limits
from .spawned import SpawnedStarter

LEVELS = "namespaces", "user", "none"
#: more process ids no Linux has; pid_max in proc(5)
PROCESSES = 1 << 22
PACKAGE = Path(__file__).resolve().parents[1]
#: one thread, as a zygote forks; no port but a simulated one; the same order of sets in every run
ENVIRONMENT = {
    "PATH": "/usr/local/bin:/usr/bin:/bin",
    "LANG": "C.UTF-8",
    "PYTHONHASHSEED": "0",
    "PYTHONDONTWRITEBYTECODE": "1",
    "MPLBACKEND": "Agg",
    "HAPTICLAB_PORTS": "sim",
    # large pages, of which a fork copies fewer: 3 ms instead of 14 where 130 MB are loaded
    "PYTHONMALLOC": "malloc",
    "GLIBC_TUNABLES": "glibc.malloc.hugetlb=1",
    **{f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL", "NUMEXPR", "VECLIB")},
}
#: in place of the folder that -c begins sys.path with: the folder of this package
PROGRAM = "import sys; sys.path[0] = sys.argv[2]; from hapticlab.grading.inside.zygote import main; main(int(sys.argv[1]))"


def start(sandbox="auto", hidden=()):
    """Return a Starter of the best level that works here, or of the one named.

    Parameters
    ----------
    sandbox : {"auto", "namespaces", "user", "none"}
    hidden : sequence of path
        What no student's code may read: answers, submissions, results.

    Raises
    ------
    CourseError
        Where the system refuses that level, or a file of ``hidden`` could be read at level "user".
    """
    if sandbox not in ("auto", *LEVELS):
        raise CourseError(f"sandbox = {sandbox!r}; needs one of auto, {', '.join(LEVELS)}")
    if sys.platform != "linux":
        if sandbox in ("auto", "none"):
            return SpawnedStarter(PACKAGE, ENVIRONMENT)
        raise CourseError(f"sandbox = {sandbox!r}; only Linux has it; on this system use auto or none")
    refused = {}
    for level in LEVELS if sandbox == "auto" else (sandbox,):
        try:
            starter = Starter(level, hidden)
            starter.refused = refused
            return starter
        except _Refused as refusal:
            refused[level] = str(refusal)
    raise CourseError(f"sandbox {sandbox}: {refused[sandbox]}; try another of auto, {', '.join(LEVELS)}")


class _Refused(Exception):
    """This system has not what a level needs."""


class Starter:
    """One zygote, which forks a session for each submission, one at a time; a context manager.

    Attributes
    ----------
    level : str
        "namespaces", "user" or "none".
    refused : dict
        Why better levels do not work here: level to words.
    """

    def __init__(self, level, hidden=()):
        self.level, self.now, self.process, self.refused, self.sessions = level, None, None, {}, 0
        self.hidden = [str(Path(path).resolve()) for path in (PACKAGE / "labs", *hidden)]
        if level == "user" and not _is_root():
            raise _Refused("only root can run code as another user")
        self._begin()

    def _begin(self):
        """Start the zygote, and see whether the level's walls hold."""
        self.control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.control.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
        arguments = [sys.executable, "-s", "-c", PROGRAM, str(theirs.fileno()), str(PACKAGE.parent)]
        cache = {name: os.environ[name] for name in ("HOME", "XDG_CACHE_HOME") if name in os.environ}
        self.mark = secrets.token_hex(16)
        # a session of its own: an interrupt at the keyboard is for the grader, which then ends it in order
        self.process = subprocess.Popen(
            arguments,
            env={**cache, **ENVIRONMENT, watch.MARK: self.mark},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            pass_fds=[theirs.fileno()],
            start_new_session=True,
        )
        theirs.close()
        self.user = _free_user(self.process.pid) if _is_root() and self.level != "none" else 0
        self.others = watch.threads_of(os.getuid()) if self.level == "none" else 0
        try:
            self._settle()
        except BaseException:
            self.close()
            raise
        self.held, self.size = watch.anonymous(self.process.pid), watch.address_space(self.process.pid)

    def _settle(self):
        with tempfile.TemporaryDirectory(prefix="hapticlab-root-") as new, self._scratch() as scratch:
            settings = {"new": new, "seen": seen(), "hidden": self.hidden, "scratch": scratch}
            if self.level != "none":
                found = self.order("probe", **settings, limits=asdict(Limits()))
                if "problem" in found:
                    raise _Refused(found["problem"])
                if found["missing"]:
                    raise _Refused(f"the user of a session cannot read {found['missing']}, which Python needs")
                if found["read"]:
                    raise CourseError(f"a submission could read {found['read']}; chmod -R go= its folder")
            self.order("ready", **settings)

    def _scratch(self):
        """Return a folder for a session; in namespaces it has one in a file system of its own."""
        if self.level == "namespaces":
            return nullcontext("/tmp/hapticlab-scratch")
        folder = tempfile.TemporaryDirectory(prefix="hapticlab-", ignore_cleanup_errors=True)
        if self.user:
            os.chown(folder.name, self.user, self.user)
        return folder

    def order(self, do, *descriptors, **settings):
        """Have the zygote do something, and return what it answers."""
        base = {"base": self.size} if do == "session" else {"base": watch.address_space(self.process.pid)}
        request = {"do": do, "level": self.level, "user": self.user, "others": self.others, **base, **settings}
        socket.send_fds(self.control, [json.dumps(request).encode()], descriptors)
        answer = self.control.recv(1 << 16)
        if not answer:
            raise ConnectionError("the zygote is gone")
        return json.loads(answer)

    def session(self, limits):
        """Return a new Session; one that is still open ends."""
        if self.now:
            self.now.close()
        if self.process.poll() is not None:  # at level none, student's code can kill it
            self.control.close()
            self._begin()
        self.sessions += 1
        if self.level == "user":
            self.user = _free_user(self.process.pid, self.sessions)
        self.now = Session(self, limits)
        return self.now

    def end(self):
        """Kill the session and all it started."""
        try:
            self.order("end")
        except OSError:  # it is gone: at level none, student's code can kill it
            self.process.wait()
            watch.kill_marked(self.mark)
        if self.level == "user":
            _delete_files_of(self.user)

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


def _delete_files_of(user):
    """Delete what a user left where anybody may write: no session reads what another knew."""
    for folder in {tempfile.gettempdir(), "/tmp", "/var/tmp", "/dev/shm"}:
        with suppress(OSError):
            for entry in list(os.scandir(folder)):
                if entry.stat(follow_symlinks=False).st_uid == user:
                    if entry.is_dir(follow_symlinks=False):
                        shutil.rmtree(entry, ignore_errors=True)
                    else:
                        os.unlink(entry)


def seen():
    """Return the folders that sessions see beside Python's own: this package, and others'."""
    return [str(PACKAGE), *(path for path in sys.path if Path(path).name in ("site-packages", "dist-packages"))]


def _is_root():
    return hasattr(os, "geteuid") and os.geteuid() == 0


def _free_user(process, session=0):
    """Return the number of a user that nobody has, another for each zygote and session; few in a container without root."""
    first, _, mapped = map(int, Path("/proc/self/uid_map").read_text().split()[:3])
    if mapped < 4 * 10**9:
        return first + mapped - 2 - process % (mapped // 4)
    return 10**9 + process + session % 700 * PROCESSES
