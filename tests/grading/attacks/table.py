"""What each attack earns and costs at a level of walls, measured from outside: ``python table.py --level user [NAME ...]``.

Run it as root. ``--ordinary`` grades as a user without rights. A process of its own grades the attacks one by one; this one
samples its memory group (cgroup v1, or else nothing) and looks at what is left.
"""

import argparse
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from attacks import colluding, holding, kernel, package, python, replies, resubmitting
from attacks.arena import ATTACKS, HONEST, LIMITS, TOKEN, Arena
from hapticlab.grading.grade import Deferred, grade
from hapticlab.grading.handed_in.submission import find_submissions, read
from hapticlab.grading.inside import linux
from hapticlab.grading.sessions.starter import LEVELS, start

NEW = tuple(one for sort in (kernel, holding, python, package, replies, colluding, resubmitting) for one in sort.ATTACKS)
NOBODY, PATIENCE, MOST_MEMORY = 65534, 180, 4 << 30
TOGETHER = {one.name.rpartition("_")[0][:-2] for one in colluding.TOGETHER}
PUBLIC = ("/tmp", "/dev/shm", "/var/tmp", "/run/lock")


class Group:
    """A memory group of version 1 below this process' own, of which all that a grader starts is a part."""

    def __init__(self):
        lines = Path("/proc/self/cgroup").read_text().split()
        own = next((line.split(":")[2] for line in lines if line.split(":")[1] == "memory"), None)
        self.place = Path(f"/sys/fs/cgroup/memory{own}/attacks-{os.getpid()}") if own else None
        try:
            self.place.mkdir()
            (self.place / "memory.limit_in_bytes").write_text(str(MOST_MEMORY))
        except (OSError, AttributeError):
            self.place = None

    def used(self):
        """Return the memory that is no file's in the cache: anonymous, shared, the kernel's, and what only pipes hold [bytes]."""
        if not self.place:
            return 0
        stat = dict(line.split() for line in (self.place / "memory.stat").read_text().splitlines())
        cache = int(stat["total_cache"]) - int(stat.get("total_shmem", 0))
        return int((self.place / "memory.usage_in_bytes").read_text()) - cache

    def processes(self):
        """Return the ids of all of its processes."""
        return {int(line) for line in (self.place / "cgroup.procs").read_text().split()} if self.place else set()

    def enter(self):
        """Move this process into it."""
        if self.place:
            (self.place / "cgroup.procs").write_text(str(os.getpid()))

    def end(self):
        """Kill all that is in it."""
        while left := self.processes():
            for process in left:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
            time.sleep(0.05)


def graded(level, names, ordinary):
    """Grade the attacks of these names, a line of JSON for each; in the process that is watched."""
    if ordinary or level == "user":
        show_python()
    if ordinary:
        os.setgroups([])
        os.setresgid(NOBODY, NOBODY, NOBODY)
        os.setresuid(NOBODY, NOBODY, NOBODY)
        os.environ["HOME"] = "/tmp"
    chosen = [one for one in (*ATTACKS, *(one for one in NEW if one not in ATTACKS)) if one.name in names]
    place = Path(tempfile.mkdtemp(prefix="arena-"))
    with Arena(place, [HONEST[0], *chosen]) as arena, contextlib.ExitStack() as running:
        sources = {source.student: source for source in find_submissions([arena.submissions], arena.lab.name)}
        named = {one.name: sources[student] for student, one in arena.names.items()}
        hidden = (arena.submissions, arena.answers.parent)
        starters = [running.enter_context(start(level, hidden, LIMITS)) for _ in range(1 + any(map(_together, chosen)))]

        def report(name, starter):
            given = read(named[name], arena.assignment.untouched), arena.assignment, starter, LIMITS
            return grade(*given, last=True)

        whole = report(HONEST[0].name, starters[0]).to_json()
        print(json.dumps({"level": starters[0].level}), flush=True)
        for one in chosen:
            print(json.dumps({"begin": one.name}), flush=True)
            with ThreadPoolExecutor(1) as beside:
                other = one.name.replace("2_finds", "1_leaves") if _together(one) and one.name.endswith("finds") else ""
                helps = beside.submit(report, other, starters[1]) if other in named else None
                try:
                    found = report(one.name, starters[0])
                    line = {"deferred": True} if isinstance(found, Deferred) else _line(one, found)
                except BaseException as problem:
                    line = {"grader": f"{type(problem).__name__}: {problem}"[:200]}
                    starters[0] = running.enter_context(start(level, hidden, LIMITS))
                if helps:
                    helps.exception()
            line |= {"reached": arena.reached(), "honest": report(HONEST[0].name, starters[0]).to_json() == whole}
            print(json.dumps({"end": one.name, **line}), flush=True)
            sys.stdin.readline()  # until who watches has looked at what is left


def show_python():
    """Let anybody read Python where it lies in root's own folder, for this process and those it starts."""
    linux.unshare(linux.NEWNS)
    linux.mount(None, "/", None, linux.RECURSIVE | linux.PRIVATE)
    for path in {sys.prefix, sys.base_prefix}:
        closed = next((one for one in reversed(Path(path).parents) if not one.stat().st_mode & 1), None)
        if closed:
            held = os.open(path, os.O_PATH)
            linux.mount("closed", str(closed), "tmpfs", 0, "mode=755")
            os.makedirs(path)
            linux.mount(f"/proc/self/fd/{held}", path, None, linux.BIND | linux.RECURSIVE)


def _together(one):
    return any(one.name.startswith(f"{name}_") for name in TOGETHER)


def _line(one, found):
    lost = {each.name for each in found.exercises if each.earned != each.points}
    words = {each.name: (each.words, each.ended) for each in found.exercises if each.name in lost}
    return {
        "earned": found.earned,
        "expected": one.earned,
        "gained": sorted(set(one.lost) - lost),
        "missing": sorted(lost - set(one.lost)),
        "stopped": "; ".join(sorted({ended or said for said, ended in words.values()}))[:120],
        "cells": [said for _, said in found.cells][:2],
    }


def measured(level, names, ordinary):
    """Yield a line for each attack, with what was seen from outside."""
    group, left = Group(), list(names)
    while left:
        place = tempfile.mkdtemp(prefix="attacks-", dir="/tmp")
        os.chmod(place, 0o1777)
        child = subprocess.Popen(
            [sys.executable, __file__, "--graded", "--level", level, *["--ordinary"] * ordinary, *left],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, env={**os.environ, "TMPDIR": place}, preexec_fn=group.enter,
        )  # fmt: skip
        try:
            yield from _watched(child, group, left, Path(place))
        finally:
            group.end()
            child.wait()
            subprocess.run(["rm", "-rf", place], check=False)  # which goes deeper than Python does
    if group.place:
        group.place.rmdir()


def _watched(child, group, left, place):
    lines, seen_now = [], {"peak": 0, "disk": 0, "began": time.monotonic()}

    def listen():
        for line in child.stdout:
            lines.append(json.loads(line))

    threading.Thread(target=listen, daemon=True).start()
    now, rest, quiet, free = "", 0, set(), 0
    while True:
        while lines:
            said = lines.pop(0)
            if "begin" in said:
                now, quiet, rest, free = said["begin"], group.processes(), group.used(), _free(place)
                seen_now.update(peak=0, disk=0, began=time.monotonic(), before=_left(place))
            elif "end" in said:
                left.remove(now)
                yield _row(said, seen_now, rest, quiet, group, place)
                now = ""
                child.stdin.write(b"\n")
                child.stdin.flush()
            else:
                yield said
        seen_now["peak"] = max(seen_now["peak"], group.used() - rest)
        seen_now["disk"] = max(seen_now["disk"], free - _free(place))
        over = time.monotonic() - seen_now["began"] > PATIENCE
        if (child.poll() is not None and not lines) or over:
            if now:
                left.remove(now)
                how = {"end": now, "grader": "hangs" if over else f"ends with {child.poll()}"}
                yield _row(how, seen_now, rest, quiet, group, place)
            elif left and not over:
                raise RuntimeError(f"the grader ended with {child.poll()} before {left[0]}")
            return
        time.sleep(0.01)


def _row(said, seen_now, rest, quiet, group, place):
    """Return what an attack came to, once more processes than before had a moment to end."""
    until = time.monotonic() + 0.5
    while (more := group.processes() - quiet) and time.monotonic() < until:
        time.sleep(0.05)
    files = sorted(_left(place) - seen_now["before"])
    return said | {
        "seconds": round(time.monotonic() - seen_now["began"], 1), "memory": seen_now["peak"] >> 20,
        "disk": seen_now["disk"] >> 20, "processes": len(more), "files": [str(path) for path in files][:5],
    }  # fmt: skip


def _free(place):
    return sum(stat.f_bfree * stat.f_frsize for stat in map(os.statvfs, (place, "/dev/shm")))


def _left(place):
    """Return what lies where anybody may write, and is a grader's folder of this run or what an attack writes."""
    found = set(place.glob("hapticlab-*"))
    for folder in PUBLIC:
        found |= set(Path(folder).glob(f"{TOKEN}*"))
    return found


def main():
    """Print a line of JSON for each attack, or a table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", help="attacks; all new ones where none is named")
    parser.add_argument("--level", default="namespaces", choices=LEVELS)
    parser.add_argument("--ordinary", action="store_true", help="grade as a user without rights")
    parser.add_argument("--graded", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.graded:
        return graded(given.level, given.names, given.ordinary)
    for row in measured(given.level, given.names or [one.name for one in NEW], given.ordinary):
        print(json.dumps(row), flush=True)


if __name__ == "__main__":
    main()
