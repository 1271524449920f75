"""A control group that bounds the memory of a session, with all that the kernel holds for it, where one is to be had.

cgroups(7). Version 2: where the group of this process is its user's to divide, and nobody else is in it, as in
``systemd-run --user --scope -p Delegate=yes hapticlab grade ...`` and in a service with ``Delegate=yes``. Version 1: where
this process is root.
"""

import os
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

ROOT = Path("/sys/fs/cgroup")
OWN = Path("/proc/self/cgroup")
#: what a limit is written to, and where it stands how often it ended a process
LIMIT = {1: "memory.limit_in_bytes", 2: "memory.max"}
EVENTS = {1: "memory.oom_control", 2: "memory.events"}
#: where version 2 has the graders: a group that is divided may hold no process itself
GRADERS = "hapticlab-graders"


@dataclass
class MemoryGroup:
    """A control group of a zygote, with one session at a time.

    Parameters
    ----------
    folder : Path
    version : {1, 2}
    """

    folder: Path
    version: int

    def add(self, process):
        """Bound a process and all that it forks from now on; what it holds already counts elsewhere."""
        (self.folder / "cgroup.procs").write_text(str(process))

    def ended(self):
        """Number of processes that were ended for their memory."""
        lines = (self.folder / EVENTS[self.version]).read_text().split("\n")
        return sum(int(line.split()[1]) for line in lines if line.startswith("oom_kill "))

    def remove(self):
        """Delete it, as its processes have ended."""
        with suppress(OSError):
            self.folder.rmdir()


def make(most, root=ROOT, own=OWN):
    """Return a group of at most so many bytes, and why there is none.

    Parameters
    ----------
    most : int
        Of all its processes together [bytes].
    root, own : Path
        Where the system shows its groups, and the one of this process.

    Returns
    -------
    (MemoryGroup or None, str)
    """
    try:
        lines = [line.split(":", 2) for line in own.read_text().splitlines()]
        first = next((path for _, names, path in lines if "memory" in names.split(",")), None)
        if first is not None:
            return _made(root / "memory" / first.lstrip("/"), most, 1), ""
        second = next(path for number, _, path in lines if number == "0")
        return _made(_divided(root / second.lstrip("/")), most, 2), ""
    except (OSError, StopIteration, ValueError) as problem:
        return None, getattr(problem, "strerror", None) or str(problem) or "the system has none"


def _divided(folder):
    """Return a group of version 2 whose parts may be given memory, and move this process into one of them."""
    if folder.name == GRADERS:
        return folder.parent
    if "memory" not in (folder / "cgroup.controllers").read_text().split():
        raise OSError(0, "the group of this process has no control of memory")
    others = {int(line) for line in (folder / "cgroup.procs").read_text().split()} - {os.getpid()}
    if others:
        begin = "systemd-run --user --scope -p Delegate=yes hapticlab grade ..."
        raise OSError(0, f"{len(others)} other processes are in the group of this process; start it with {begin}")
    (folder / GRADERS).mkdir(exist_ok=True)
    (folder / GRADERS / "cgroup.procs").write_text(str(os.getpid()))
    (folder / "cgroup.subtree_control").write_text("+memory")
    return folder


def _made(within, most, version):
    folder = Path(tempfile.mkdtemp(prefix="hapticlab-", dir=within))
    group = MemoryGroup(folder, version)
    try:
        (folder / LIMIT[version]).write_text(str(most))
        if version == 2:
            with suppress(OSError):  # where there is no swap
                (folder / "memory.swap.max").write_text("0")
        group.ended()
    except BaseException:
        group.remove()
        raise
    return group
