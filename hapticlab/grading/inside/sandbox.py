"""The walls around a session: what it may use, whom it runs as, and what it sees."""

import os
import platform
import resource
import signal

from . import callfilter, linux, root

#: of a grader, and of each of its sessions
SHARED, NAMESPACES = linux.NEWNS | linux.NEWNET | linux.NEWIPC | linux.NEWUTS, linux.NEWNS | linux.NEWPID
#: in namespaces each session has a file system of its own here
TMP, SCRATCH = "/tmp", "/tmp/hapticlab-scratch"
#: threads of a session beside its processes
THREADS = 64
#: what a session reads and writes beside its own files, where Landlock keeps it to them
SYSTEM_FILES, NULL = ("/dev/urandom", "/dev/random", "/dev/full", "/proc/cpuinfo", "/proc/meminfo", "/proc/self"), "/dev/null"


def move(new, seen, hidden):
    """Move the zygote, with all its sessions, into a root of its own; where it is not root, in a user namespace.

    Parameters
    ----------
    new : str
        An empty folder.
    seen, hidden : sequence of str
    """
    user, group = os.geteuid(), os.getegid()
    linux.unshare(SHARED | (linux.NEWUSER if user else 0))
    if user:
        for file, line in {"setgroups": "deny", "uid_map": f"{user} {user} 1", "gid_map": f"{group} {group} 1"}.items():
            with open(f"/proc/self/{file}", "w") as out:  # user_namespaces(7)
                out.write(line)
    root.move(new, seen, hidden)


def furnish(request):
    """Give a session's namespaces, from inside, a /tmp and a /proc of their own."""
    clear_tmp(int(request["limits"]["scratch"]), int(request["limits"]["files"]))
    os.mkdir(SCRATCH)
    if request["user"]:
        os.chown(SCRATCH, request["user"], request["user"])
    try:
        linux.mount("proc", "/proc", "proc", linux.NOSUID | linux.NODEV | linux.NOEXEC)
    except OSError:  # a container that hides parts of its own
        linux.mount("proc", "/proc", "tmpfs", linux.NOSUID | linux.NODEV, "mode=555,size=4k")


def clear_tmp(size, files):
    """Lay an empty /tmp over the one there is; what is seen of that, a Python or this package, is seen again."""
    held = os.open(TMP, os.O_PATH | os.O_DIRECTORY)
    linux.mount("tmp", TMP, "tmpfs", linux.NOSUID | linux.NODEV, f"mode=1777,size={size},nr_inodes={files}")
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
    if request["readable"]:
        system = [os.path.realpath(path) for path in SYSTEM_FILES if os.path.exists(path)]
        linux.keep_to([*request["readable"], *system], [request["scratch"], NULL])
    if request["level"] != "namespaces":  # there the parent has gone on, and process 1 ends with its namespace's
        linux.die_with_parent()
    calls = callfilter.program(processes=request["limits"]["processes"] > 1)
    if calls:
        linux.filter_calls(calls)
    elif request["level"] != "none":
        raise OSError(f"the numbers of system calls of {platform.machine()} are not known, so none can be blocked")


def limit(request):
    """Bound what the system bounds by process, and the number of threads by user."""
    limits = request["limits"]
    bounds = {
        resource.RLIMIT_AS: int(limits["memory"]) + request["base"],
        resource.RLIMIT_CPU: int(limits["total"]) + 1,
        resource.RLIMIT_FSIZE: int(limits["scratch"]),
        resource.RLIMIT_NOFILE: 128,
        resource.RLIMIT_CORE: 0,
        resource.RLIMIT_MEMLOCK: 0,
        # of a user who does nothing else, or is counted in a namespace of its own
        **({resource.RLIMIT_NPROC: int(limits["processes"]) + THREADS} if request["user"] or limits["processes"] > 1 else {}),
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
    missing = [path for path in (os.__file__, linux.__file__) if not read(path)]
    files = (file for path in request["hidden"] for file in files_of(path) if read(file))
    return {"read": next(files, ""), "missing": "".join(missing[:1])}


def files_of(path):
    """Yield a file, or the files of a folder, however deep they lie."""
    left = [path]
    while left:
        place = left.pop()
        try:
            left += sorted(entry.path for entry in os.scandir(place))
        except NotADirectoryError:
            yield place
        except OSError:  # it cannot be looked into, or is gone
            continue


def read(file):
    """Whether this process can read a file; one that is masked is the null device."""
    try:
        with open(file, "rb") as opened:
            return not os.path.samestat(os.fstat(opened.fileno()), os.stat(os.devnull))
    except OSError:
        return False
