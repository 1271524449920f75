"""The walls around a session: what it may use, whom it runs as, and what it sees."""

import os
import resource
import signal
import sys

from . import callfilter, linux, root

NAMESPACES = linux.NEWNS | linux.NEWPID | linux.NEWNET | linux.NEWIPC | linux.NEWUTS
#: in namespaces each session has a file system of its own here
TMP, SCRATCH = "/tmp", "/tmp/hapticlab-scratch"
#: of a session beside the student's processes: its zygote, the one between, its keeper
OWN = 3


def move(new, seen, hidden):
    """Move the zygote, with all its sessions, into a root of its own; where it is not root, in a user namespace.

    Parameters
    ----------
    new : str
        An empty folder.
    seen, hidden : sequence of str
    """
    user, group = os.geteuid(), os.getegid()
    linux.unshare(linux.NEWNS | (linux.NEWUSER if user else 0))
    if user:
        for file, line in {"setgroups": "deny", "uid_map": f"{user} {user} 1", "gid_map": f"{group} {group} 1"}.items():
            with open(f"/proc/self/{file}", "w") as out:  # user_namespaces(7)
                out.write(line)
    root.move(new, (sys.prefix, sys.base_prefix, *seen), hidden)


def furnish(request):
    """Give a session's namespaces, from inside, a /tmp and a /proc of their own."""
    clear_tmp(int(request["limits"]["scratch"]))
    os.mkdir(SCRATCH)
    if request["user"]:
        os.chown(SCRATCH, request["user"], request["user"])
    try:
        linux.mount("proc", "/proc", "proc", linux.NOSUID | linux.NODEV | linux.NOEXEC)
    except OSError:  # a container that hides parts of its own
        linux.mount("proc", "/proc", "tmpfs", linux.NOSUID | linux.NODEV, "mode=555,size=4k")


def clear_tmp(size):
    """Lay an empty /tmp over the one there is; what is seen of that, a Python or this package, is seen again."""
    held = os.open(TMP, os.O_PATH | os.O_DIRECTORY)
    linux.mount("tmp", TMP, "tmpfs", linux.NOSUID | linux.NODEV, f"mode=1777,size={size},nr_inodes=10000")
    before = f"/proc/self/fd/{held}"
    for name in os.listdir(before):
        root.show(f"{before}/{name}", f"{TMP}/{name}")
    os.close(held)


def enter(request):
    """Go behind the walls, for ever."""
    os.chdir(request["scratch"])
    os.umask(0o077)
    os.environ.pop("XDG_CACHE_HOME", None)
    os.environ.update(HOME=request["scratch"], TMPDIR=request["scratch"])
    limit(request)
    if request["user"]:
        os.setgroups([])
        os.setresgid(*[request["user"]] * 3)
        os.setresuid(*[request["user"]] * 3)
    linux.drop_privileges()
    linux.filter_calls(callfilter.program())


def limit(request):
    """Bound what the system bounds by process, and the number of processes by user."""
    limits = request["limits"]
    bounds = {
        resource.RLIMIT_AS: int(limits["memory"]) + request["base"],
        resource.RLIMIT_CPU: int(limits["total"]) + 1,
        resource.RLIMIT_FSIZE: int(limits["scratch"]),
        resource.RLIMIT_NPROC: int(limits["processes"]) + OWN + request["others"],
        resource.RLIMIT_NOFILE: 256,
        resource.RLIMIT_CORE: 0,
    }
    for which, most in bounds.items():
        hard = resource.getrlimit(which)[1]
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(which, (most, most))


def kill_user(user):
    """Kill all processes of a user at one stroke, kill(2): nothing can be started between."""
    killer = os.fork()
    if killer == 0:
        os.setresuid(user, user, user)
        try:
            os.kill(-1, signal.SIGKILL)
        finally:
            os._exit(0)
    os.waitpid(killer, 0)


def findings(request):
    """Return the first file that this process reads and must not, and the first that it must and does not."""
    missing = [path for path in (os.__file__, linux.__file__, sys.executable) if not read(path)]
    files = (file for path in request["hidden"] for file in files_of(path) if read(file))
    return {"read": next(files, ""), "missing": "".join(missing[:1])}


def files_of(path):
    """Return a file, or the files of a folder."""
    if not os.path.isdir(path):
        return [path]
    return (os.path.join(folder, name) for folder, _, names in os.walk(path) for name in names)


def read(file):
    """Whether this process can read a file; one that is masked is the null device."""
    try:
        with open(file, "rb") as opened:
            return not os.path.samestat(os.fstat(opened.fileno()), os.stat(os.devnull))
    except OSError:
        return False
