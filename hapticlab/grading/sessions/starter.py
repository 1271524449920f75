"""Starting students' sessions, asking them, and ending them: the grader's side of the wall."""

import json
import os
import socket
import subprocess
import sys
import sysconfig
import tempfile
from contextlib import ExitStack, nullcontext, suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path

from ...base.in_notebook import require_processes
from ...errors import CourseError
from ..inside import callfilter, linux, root, watch
from . import memory_group
from .asking import Session
from .asking import SessionEnded as SessionEnded
from .limits import Limits
from .preloaded import PACKAGE, Preloaded
from .spawned import SpawnedStarter

LEVELS = "namespaces", "user", "landlock", "none"
#: more process ids no Linux has; pid_max in proc(5)
PROCESSES = 1 << 22
#: the labs that came with the package: what judges their public cases
LABS = PACKAGE / "labs"
#: characters of a notebook that a zygote is told
MOST_CELLS = 200_000


#: what a level leaves open, told before it is used
NONE_LINUX = (
    "files are not hidden from the students' code, which runs with your rights: grade only students whom you trust, or "
    "grade in a container"
)
NONE_ELSEWHERE = (
    "only the limits on time and on answers restrict the students' code, which runs with your rights: grade only students "
    "whom you trust, or grade in a container"
)
NO_LANDLOCK = (
    "the kernel has no Landlock, so the students' code can read files that all users may read, and write where all users "
    "may write, until its session ends"
)
NO_CALLS = "the system calls of this machine are not known, so none is blocked"


@dataclass(frozen=True)
class Walls:
    """What stands around students' code.

    Attributes
    ----------
    level : str
        "namespaces", "user", "landlock" or "none"; empty where nothing was begun.
    refused : dict
        Why better levels do not work here: level to words.
    weakness : str
        What this one leaves open, in a sentence.
    """

    level: str = ""
    refused: dict = field(default_factory=dict)
    weakness: str = ""


def weakest(several):
    """Return those of several walls that keep students' code in least.

    Examples
    --------
    >>> weakest([Walls("namespaces"), Walls("none", {"user": "not root"}), Walls("user")]).level
    'none'
    """
    return max(several, key=lambda walls: LEVELS.index(walls.level))


def start(sandbox="auto", hidden=(), limits=None, cells=(), zygote=None):
    """Return a Starter of the best level that works here, or of the one named.

    Parameters
    ----------
    sandbox : {"auto", "namespaces", "user", "landlock", "none"}
    hidden : sequence of path
        What no student's code may read: answers, submissions, results.
    limits : Limits, optional
        Of its sessions.
    cells : sequence of str
        Of the notebook as it was handed out.
    zygote : (socket, int), optional
        Of :meth:`Preloaded.zygote`; without it one is begun.

    Raises
    ------
    CourseError
        Where the system refuses that level, or a file of ``hidden`` could be read at level "user".
    """
    require_processes("Grading", CourseError)
    if sandbox not in ("auto", *LEVELS):
        raise CourseError(f"sandbox = {sandbox!r}; needs one of auto, {', '.join(LEVELS)}")
    if sys.platform != "linux":
        if sandbox in ("auto", "none"):
            refused = dict.fromkeys(LEVELS[:-1], "it exists on Linux only")
            return SpawnedStarter(Walls("none", refused, NONE_ELSEWHERE))
        raise CourseError(f"sandbox = {sandbox!r}; it exists on Linux only; on this system use auto or none")
    refused, own = {}, None if zygote else Preloaded()
    with ExitStack() as ending:
        if own:
            ending.callback(own.close)
        control, process = zygote or own.zygote()
        ending.callback(control.close)
        for level in LEVELS if sandbox == "auto" else (sandbox,):
            try:
                starter = Starter(level, hidden, limits or Limits(), control, process, cells, refused)
            except _Refused as refusal:
                refused[level] = str(refusal)
            else:
                starter.ending = ending.pop_all()
                return starter
    raise CourseError(f"sandbox {sandbox}: {refused[sandbox]}; try another of auto, {', '.join(LEVELS)}")


class _Refused(Exception):
    """This system has not what a level needs."""


class Starter:
    """One zygote, which forks a session for each submission, one at a time; a context manager.

    Attributes
    ----------
    walls : Walls
    """

    def __init__(self, level, hidden, limits, control, process, cells=(), refused=()):
        self.level, self.limits = level, limits
        self.now, self.sessions, self.ending = None, 0, ExitStack()
        self.hidden = [str(Path(path).resolve()) for path in hidden]
        self.walled = level in ("user", "landlock") and linux.landlock_version() > 0
        if level == "user" and not _is_root():
            raise _Refused("only root can run code as another user")
        if limits.processes > 1 and level not in ("namespaces", "user"):
            raise _Refused("more than one process needs namespaces, or a separate user by which the system counts processes")
        if level == "landlock" and not self.walled:
            raise _Refused("the kernel has no Landlock, or it is off; Linux 5.13 and later have it")
        self.walls = Walls(level, dict(refused), self._weakness())
        # where nothing keeps another user to its own folder, what it leaves elsewhere is counted and deleted
        self.writable = watch.writable_folders() if level == "user" and not self.walled else []
        self.cells = list(cells) if sum(map(len, cells)) < MOST_CELLS else []
        self.group, self.no_group = memory_group.make(limits.memory + limits.scratch)
        try:
            self._take(control, process)
        except BaseException:
            self._remove_group()
            raise

    def _weakness(self):
        if self.level == "none":
            return NONE_LINUX if callfilter.program() else f"{NONE_LINUX}; {NO_CALLS}"
        return NO_LANDLOCK if self.level == "user" and not self.walled else ""

    def _take(self, control, process):
        """Take a zygote, and see whether the level's walls hold."""
        self.control, self.process = control, process
        self.user = _free_user(process) if _is_root() and self.level in ("namespaces", "user") else 0
        readable = seen(self.limits.processes > 1)
        hidden = [str(LABS), *self.hidden]
        with tempfile.TemporaryDirectory(prefix="hapticlab-root-") as new, self._scratch() as scratch:
            self.settings = {"new": new, "seen": readable, "hidden": hidden, "scratch": scratch, "readable": []}
            if self.walled:
                self.settings["readable"] = root.without(root.outermost(readable), hidden)
            if self.level != "none":
                self._probe()
            self.order("ready", **self.settings, cells=self.cells)
        self.held, self.size = watch.anonymous(process), watch.address_space(process)
        if self.group:
            self.group.add(process)

    def _probe(self):
        """Have a session look what it can read."""
        public = [] if self.level == "namespaces" or self.walled else [str(LABS)]  # nothing hides a part of what is seen
        secret = [path for path in self.settings["hidden"] if path not in public]
        found = self.order("probe", **{**self.settings, "hidden": secret})
        if "problem" in found:
            raise _Refused(found["problem"])
        if found["missing"]:
            raise _Refused(f"the user of a session cannot read {found['missing']}, which Python needs")
        if found["read"]:
            raise CourseError(f"a submission could read {found['read']}; chmod -R go= its folder")

    def _scratch(self):
        """Return a folder for a session; in namespaces it has one in a file system of its own."""
        return nullcontext("/tmp/hapticlab-scratch") if self.level == "namespaces" else _Folder(self.user)

    def order(self, do, *descriptors, **settings):
        """Have the zygote do something, and return what it answers."""
        base = {"base": self.size} if do == "session" else {"base": watch.address_space(self.process)}
        own = {"level": self.level, "user": self.user, "limits": asdict(self.limits)}
        socket.send_fds(self.control, [json.dumps({"do": do, **own, **base, **settings}).encode()], descriptors)
        answer = self.control.recv(1 << 16)
        if not answer:
            raise ConnectionError("the process that starts sessions (zygote) has ended")
        return json.loads(answer)

    def session(self, limits):
        """Return a new Session; one that is still open ends."""
        if self.now:
            self.now.close()
        self.sessions += 1
        if self.level == "user":
            self.user = _free_user(self.process, self.sessions)
        try:
            self.now = Session(self, limits)
        except ConnectionError:  # the system had no memory for the zygote
            self.control.close()
            own = Preloaded()
            self.ending.callback(own.close)
            self._take(*own.zygote())
            self.now = Session(self, limits)
        return self.now

    def end(self, grace=0.0):
        """Kill the session and all it started; return how it ended by itself within some seconds, None where it did not."""
        code = None
        with suppress(OSError):  # the process that starts sessions (zygote) has ended, and all it forked ends with it
            code = self.order("end", grace=grace)["code"]
        if self.writable:
            _delete(watch.left_by(self.user, self.writable))
        return code

    def close(self):
        """End the session and the zygote."""
        if self.now:
            self.now.close()
        self.control.close()
        self.ending.close()
        self._remove_group()

    def _remove_group(self):
        if self.group:
            self.group.remove()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class _Folder:
    """A new folder of a user, deleted with whatever was made in it; a context manager."""

    def __init__(self, user):
        self.name = tempfile.mkdtemp(prefix="hapticlab-")
        self._held = os.open(self.name, os.O_PATH)
        if user:
            os.chown(self.name, user, user)

    def __enter__(self):
        return self.name

    def __exit__(self, *_):
        _delete([self.name])


def _delete(places):
    """Delete files and folders, however deep they are nested, where Python's own way has a limit, and whatever their rights."""
    commands = [["rm", "-rf"]] if _is_root() else [["chmod", "-R", "u+rwX"], ["rm", "-rf"]]
    for command in commands if places else ():
        subprocess.run([*command, "--", *places], stderr=subprocess.DEVNULL, check=False)


def seen(programs=False):
    """Folders that sessions read beside their own: Python, its packages, this one, and the system's libraries.

    Parameters
    ----------
    programs : bool
        Whether they may start programs.
    """
    libraries = [f"{prefix}/{folder}" for prefix in (sys.prefix, sys.base_prefix) for folder in ("lib", "lib64")]
    packages = [path for path in sys.path if Path(path).name in ("site-packages", "dist-packages")]
    own = [str(PACKAGE), sysconfig.get_path("stdlib"), sysconfig.get_path("platstdlib"), *packages]
    bins = [*root.PROGRAMS, f"{sys.prefix}/bin", f"{sys.base_prefix}/bin", f"{sys.prefix}/pyvenv.cfg"] if programs else []
    return sorted({path for path in (*root.SYSTEM, *libraries, *own, *bins) if os.path.exists(path)})


def _is_root():
    return hasattr(os, "geteuid") and os.geteuid() == 0


def _free_user(process, session=0):
    """Return the number of a user that nobody has, another for each zygote and session; few in a container without root."""
    first, _, mapped = map(int, Path("/proc/self/uid_map").read_text().split()[:3])
    if mapped < 4 * 10**9:
        return first + mapped - 2 - process % (mapped // 4)
    return 10**9 + process + session % 700 * PROCESSES
