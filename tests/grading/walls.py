"""Attacks on the walls of a session, each an expression of text: what it came to, or the error it met.

``python walls.py LEVEL [USER [LEFT_OUT...]]`` tries them and prints what each came to as JSON; with a USER, as that one in a root
where anybody can read Python. At level auto there are no namespaces.
"""

import json
import os
import socket
import sys
import tempfile
from pathlib import Path

import numpy as np

from hapticlab.errors import CourseError
from hapticlab.grading.inside import callfilter, linux, root, sandbox
from hapticlab.grading.limits import MIB, Limits
from hapticlab.grading.starter import PACKAGE, seen, start

LIMITS = Limits(memory=300 * MIB, processes=16, scratch=4 * MIB)
BEFORE = """
import ctypes, mmap, os, pathlib, signal, socket, stat, subprocess, sys
import numpy as np
libc = ctypes.CDLL(None, use_errno=True)
def called(number, *arguments):
    return "done" if libc.syscall(number, *arguments) != -1 else os.strerror(ctypes.get_errno())
def contents(file):  # a masked file is the null device, which opens only where devices do
    try:
        return open(file).read() or "nothing"
    except PermissionError:
        return "nothing"
def grow(folder):
    for k in range(100):
        with open(f"{folder}/{k}", "wb") as file:
            file.write(bytes(1 << 20))
    return "grown"
def attempt(attack):
    try:
        return str(attack())
    except BaseException as problem:
        return type(problem).__name__
"""
#: name: (expression, what it comes to in namespaces)
ATTACKS = {
    "network": ("socket.create_connection(('127.0.0.1', PORT))", "PermissionError"),
    "name_service": ("socket.gethostbyname('example.org')", "gaierror"),
    "abstract_socket": ("socket.socket(socket.AF_UNIX).connect('\\0' + NAME)", "PermissionError"),
    "answers": ("open(ANSWERS).read()", "FileNotFoundError"),
    "masked_file": ("contents(MASKED)", "nothing"),
    "masked_folder": ("os.listdir(MASKED_FOLDER)", "PermissionError"),
    "left_by_another": ("open(LEFT).read()", "FileNotFoundError"),
    "labs": ("os.path.exists(LABS + '/02_virtual_wall')", "False"),
    "other_processes": ("len([p for p in os.listdir('/proc') if p.isdigit()]) < 5", "True"),
    "parents_memory": ("open('/proc/1/mem', 'rb')", "PermissionError"),
    "parents_environment": ("open('/proc/1/environ').read()", "PermissionError"),
    "grader": ("os.kill(GRADER, signal.SIGKILL)", "ProcessLookupError"),
    "descriptors": ("[n for n in range(3, 300) if os.path.exists(f'/proc/self/fd/{n}')].__len__()", "1"),
    "secret": ("os.environ.get('SECRET')", "None"),
    "ptrace": ("called(101 if os.uname().machine == 'x86_64' else 117, 0, 0, 0, 0)", "Operation not permitted"),
    "unshare": ("subprocess.run(['unshare', '-r', 'true'], stderr=subprocess.DEVNULL).returncode", "1"),
    "shared_memory": ("mmap.mmap(-1, 4096)", "PermissionError"),
    "zeros": ("open('/dev/zero')", "FileNotFoundError"),
    "memory_file": ("os.memfd_create('m')", "PermissionError"),
    "site_packages": ("open(f'{os.path.dirname(np.__file__)}/new.py', 'w')", "OSError"),
    "system": ("open('/usr/bin/new', 'w')", "OSError"),
    "device": ("os.mknod('/tmp/disk', 0o600 | stat.S_IFBLK, os.makedev(254, 0))", "PermissionError"),
    "become_root": ("attempt(lambda: os.setuid(0)) in ('PermissionError', 'OSError')", "True"),
    "many_files": ("grow('.')", "OSError"),
    "large_file": ("open('large', 'wb').write(bytes(8 << 20))", "OSError"),
    "memory": ("len(bytes(1 << 30))", "MemoryError"),
    "open_files": ("[open('/dev/null') for _ in range(1000)]", "OSError"),
}


def hidden(folder):
    """Return paths to hide: one elsewhere, and a file and a folder where Python is."""
    (folder / "answers.py").write_text("K = 150\n")
    numpy = Path(np.__file__).parent
    return [folder / "answers.py", numpy / "version.py", numpy / "ma"]


def tried(starter, paths, left_out=()):
    """Return what each attack came to."""
    attacks = {name: attack for name, (attack, _) in ATTACKS.items() if name not in left_out}
    listener, neighbour = socket.create_server(("127.0.0.1", 0)), socket.socket(socket.AF_UNIX)
    name = f"hapticlab-{os.getpid()}"
    neighbour.bind("\0" + name)
    neighbour.listen()
    given = {"PORT": listener.getsockname()[1], "NAME": name, "GRADER": os.getpid()}
    given |= {"LABS": str(PACKAGE / "labs"), "LEFT": f"/tmp/{name}"}
    given |= dict(zip(("ANSWERS", "MASKED", "MASKED_FOLDER"), map(str, paths), strict=True))
    cell = BEFORE + "".join(f"{key} = {value!r}\n" for key, value in given.items())
    cell += "".join(f"{key} = attempt(lambda: {attack})\n" for key, attack in attacks.items())
    leave = f"import os\nopen('/tmp/{name}', 'w').write('4')\nos.chmod('/tmp/{name}', 0o666)"
    with starter.session(LIMITS) as session:
        session.ask({"do": "load", "cells": [leave], "files": {}}, 20)
        assert session.ask({"do": "run", "cell": 0}, 20) == {"problem": ""}
    with listener, neighbour, starter.session(LIMITS) as session:
        session.ask({"do": "load", "cells": [cell], "files": {}}, 20)
        problem = session.ask({"do": "run", "cell": 0}, 20)["problem"]
        return {"problem": problem} | {key: value(session, key) for key in attacks}


def value(session, name):
    """Return the text under a name."""
    (outcome,) = session.ask({"do": "evaluate", "name": name, "kind": "value", "givens": [{}]}, 20)["outcomes"]
    return outcome["value"] or outcome["problem"]


if __name__ == "__main__":
    level, user, left_out = sys.argv[1], int([*sys.argv, 0][2]), sys.argv[3:]
    if len(sys.argv) > 2:
        linux.unshare(linux.NEWNS)
        with tempfile.TemporaryDirectory() as new:
            root.move(new, (sys.prefix, sys.base_prefix, *seen(), str(Path(__file__).parent)), ())
        sandbox.clear_tmp(64 * MIB)
    if user:
        os.setgroups([])
        os.setresgid(user, user, user)
        os.setresuid(user, user, user)
    os.environ.update(SECRET="seen", HOME="/tmp")
    paths = hidden(Path(tempfile.mkdtemp()))
    refused = {}
    if level == "auto":  # as a container without privileges does it
        callfilter.REFUSED = {"unshare": callfilter.REFUSED["unshare"]}
        linux.filter_calls(callfilter.program())
        paths[0].parent.chmod(0o755)
        try:
            start(level, hidden=paths[:1]).close()
        except CourseError as refusal:
            refused = {"refused": str(refusal)}
    paths[0].chmod(0o600)
    with start(level, hidden=paths[:1] if level == "auto" else paths) as starter:
        print(json.dumps(refused | starter.refused | tried(starter, paths, left_out)))
