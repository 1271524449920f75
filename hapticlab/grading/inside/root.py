"""The root of a session: what Python needs, read-only, and nothing else of the machine."""

import os
from contextlib import suppress
from pathlib import Path

from . import linux

#: what libraries are read from, time zones and fonts; nothing of it is written by people
SYSTEM = ("/lib", "/lib32", "/lib64", "/libx32", "/usr/lib", "/usr/lib32", "/usr/lib64", "/usr/libx32", "/nix/store",
    "/usr/share/fonts", "/usr/share/zoneinfo", "/etc/fonts", "/etc/ld.so.cache", "/etc/localtime")  # fmt: skip
#: where a session may start programs, beside these
PROGRAMS = ("/bin", "/usr/bin", "/etc/alternatives")
#: not zero, of which a shared mapping is memory that no file and no process seems to hold
DEVICES = ("null", "full", "random", "urandom")


def move(new, seen, hidden):
    """Move this process into a root of its own.

    Parameters
    ----------
    new : str
        An empty folder.
    seen : sequence of str
        Folders and files to be seen.
    hidden : sequence of str
        Paths inside of these that must not be.
    """
    linux.mount(None, "/", None, linux.RECURSIVE | linux.PRIVATE)
    linux.mount("root", new, "tmpfs", linux.NOSUID | linux.NODEV, "mode=755,size=1m")
    seen = outermost(path for path in seen if os.path.exists(path))
    for path in seen:
        show(path, new + path)
    for path in hidden:
        mask(new, path, seen)
    for device in DEVICES:
        show_at(f"/dev/{device}", f"{new}/dev/{device}")
    for link, target in {"shm": "/tmp", "fd": "/proc/self/fd"}.items():
        with suppress(FileExistsError):  # what is seen lies in /dev/shm
            os.symlink(target, f"{new}/dev/{link}")
    for folder in ("tmp", "proc"):
        os.makedirs(f"{new}/{folder}", exist_ok=True)  # what is seen may lie in /tmp
    # a new /proc may only be mounted where a whole one is seen, mount_namespaces(7)
    linux.mount("/proc", f"{new}/proc", None, linux.BIND | linux.RECURSIVE)
    linux.move_root(new)
    linux.make_read_only("/", recursive=False)


def outermost(paths):
    """Return absolute paths and what they resolve to, without those inside of another.

    Examples
    --------
    >>> outermost(["/usr/share", "/usr"])
    ['/usr']
    """
    found = []
    places = {resolve(path) for path in paths for resolve in (os.path.abspath, os.path.realpath)}
    for path in sorted(places):
        if not any(inside(path, outer) and not os.path.islink(outer) for outer in found):
            found.append(path)
    return found


def inside(path, outer):
    """Whether a path is another, or inside of it."""
    return Path(path).is_relative_to(outer)


def without(paths, hidden):
    """Return paths that hold all of others but what is hidden: a folder with something hidden in it becomes its entries.

    Examples
    --------
    >>> without(["/nowhere/lib"], ["/elsewhere"]), without(["/nowhere/lib"], ["/nowhere"])
    (['/nowhere/lib'], [])
    """
    found = []
    for path in paths:
        if any(inside(path, one) for one in hidden):
            continue
        if any(inside(one, path) for one in hidden):
            found += without([os.path.join(path, name) for name in sorted(os.listdir(path))], hidden)
        else:
            found.append(path)
    return found


def show(path, target):
    """Show a file or folder at a place, read-only; a link as a link."""
    if os.path.islink(path):
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.symlink(os.readlink(path), target)
        return
    show_at(path, target)
    linux.make_read_only(target)


def show_at(path, target):
    """Bind a file or folder at a place, which is made."""
    os.makedirs(os.path.dirname(target), exist_ok=True)
    if os.path.isdir(path):
        os.mkdir(target)
    else:
        Path(target).touch()
    linux.mount(path, target, None, linux.BIND | linux.RECURSIVE)


def mask(new, path, seen):
    """Lay something empty over a path that would be seen."""
    for place in {os.path.abspath(path), os.path.realpath(path)}:
        if not os.path.exists(place) or not any(inside(place, outer) for outer in seen):
            continue
        if os.path.isdir(place):
            linux.mount("hidden", new + place, "tmpfs", linux.NOSUID | linux.NODEV, "mode=000,size=4k")
            linux.make_read_only(new + place)
        else:
            linux.mount("/dev/null", new + place, None, linux.BIND)
