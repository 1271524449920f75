"""Attacks on the walls of a session, each an expression of text: what it came to, or the error it met.

``python walls.py LEVEL [USER [REFUSED...]]`` tries them and prints what each came to as JSON; with a USER, as that one in a root
where anybody can read Python. REFUSED are calls that this system refuses, as a container does it: unshare, landlock.
"""

import json
import os
import socket
import struct
import sys
import tempfile
from pathlib import Path

import numpy as np

from hapticlab.errors import CourseError
from hapticlab.grading.inside import callfilter, linux, root, sandbox
from hapticlab.grading.sessions.limits import MIB, Limits
from hapticlab.grading.sessions.starter import PACKAGE, seen, start

LIMITS = Limits(memory=300 * MIB, scratch=4 * MIB)
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
    "parents_memory": ("open(f'/proc/{os.getppid()}/mem', 'rb')", "FileNotFoundError"),
    "parents_environment": ("open(f'/proc/{os.getppid()}/environ').read()", "FileNotFoundError"),
    "grader": ("os.kill(GRADER, signal.SIGKILL)", "PermissionError"),
    "descriptors": ("[n for n in range(3, 300) if os.path.exists(f'/proc/self/fd/{n}')].__len__()", "1"),
    "secret": ("os.environ.get('SECRET')", "None"),
    "ptrace": ("called(101 if os.uname().machine == 'x86_64' else 117, 0, 0, 0, 0)", "Operation not permitted"),
    "unshare": ("called(272 if os.uname().machine == 'x86_64' else 97, 0x10000000)", "Operation not permitted"),
    "fork": ("os.fork()", "PermissionError"),
    "program": ("subprocess.run(['true'])", "PermissionError"),
    "by_its_name": ("os.execv('/usr/bin/true', ['true'])", "PermissionError"),
    "datagrams": ("socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)", "PermissionError"),
    "vmsplice": ("called(278 if os.uname().machine == 'x86_64' else 75, 1, 0, 0, 0)", "Operation not permitted"),
    "in_memory": ("called(327 if os.uname().machine == 'x86_64' else 286, 0, 0, 0, 0, 0, 8)", "Operation not permitted"),
    "locks": ("__import__('fcntl').flock(open(os.__file__), 1)", "PermissionError"),
    "watches": ("called(294 if os.uname().machine == 'x86_64' else 26, 0)", "Operation not permitted"),
    "local_files": ("os.path.exists('/usr/local/share') and open(LOCAL).read()", "False"),
    "programs": ("os.path.exists('/usr/bin/env')", "False"),
    "shared_memory": ("mmap.mmap(-1, 4096)", "PermissionError"),
    "zeros": ("open('/dev/zero')", "FileNotFoundError"),
    "memory_file": ("os.memfd_create('m')", "PermissionError"),
    "site_packages": ("open(f'{os.path.dirname(np.__file__)}/new.py', 'w')", "OSError"),
    "system": ("open('/usr/lib/new', 'w')", "OSError"),
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


def tried(starter, paths):
    """Return what each attack came to; where there are no namespaces, files are counted from outside, and end a session."""
    left_out = () if starter.level == "namespaces" else ("many_files",)
    attacks = {name: attack for name, (attack, _) in ATTACKS.items() if name not in left_out}
    listener, neighbour = socket.create_server(("127.0.0.1", 0)), socket.socket(socket.AF_UNIX)
    name = f"hapticlab-{os.getpid()}"
    neighbour.bind("\0" + name)
    neighbour.listen()
    given = {"PORT": listener.getsockname()[1], "NAME": name, "GRADER": os.getpid()}
    given |= {"LABS": str(PACKAGE / "labs"), "LEFT": f"/tmp/{name}", "LOCAL": "/usr/local/share/none"}
    given |= dict(zip(("ANSWERS", "MASKED", "MASKED_FOLDER"), map(str, paths), strict=True))
    cell = BEFORE + "".join(f"{key} = {value!r}\n" for key, value in given.items())
    cell += "".join(f"{key} = attempt(lambda: {attack})\n" for key, attack in attacks.items())
    leave = f"import os\nopen('/tmp/{name}', 'w').write('4')\nos.chmod('/tmp/{name}', 0o666)"
    with starter.session(LIMITS) as session:
        session.ask({"do": "load", "cells": [leave], "files": {}}, 20)
        session.ask({"do": "run", "cell": 0}, 20)
    with listener, neighbour, starter.session(LIMITS) as session:
        session.ask({"do": "load", "cells": [cell], "files": {}}, 20)
        problem = session.ask({"do": "run", "cell": 0}, 20)["problem"]
        return {"problem": problem} | {key: value(session, key) for key in attacks}


def value(session, name):
    """Return the text under a name."""
    (outcome,) = session.ask({"do": "evaluate", "name": name, "kind": "value", "givens": [{}]}, 20)["outcomes"]
    return outcome["value"] or outcome["problem"]


def refuse(*names):
    """Have the kernel refuse calls, in this process and all that it starts."""
    numbers = {"unshare": (272, 97), "landlock": (444, 444)}
    column = list(callfilter.AUDIT_ARCH).index(os.uname().machine)
    code = [(callfilter.LOAD, 0, 0, callfilter.NUMBER)]
    for name in names:
        code += [(callfilter.EQUAL, 0, 1, numbers[name][column]), callfilter.REFUSE]
    linux.filter_calls(b"".join(struct.pack("=HBBI", *step) for step in (*code, callfilter.PASS)))


if __name__ == "__main__":
    level, user, without = sys.argv[1], int([*sys.argv, 0][2]), sys.argv[3:]
    if len(sys.argv) > 2:
        linux.unshare(linux.NEWNS)
        with tempfile.TemporaryDirectory() as new:
            system = ("/usr", "/bin", "/lib", "/lib64", sys.prefix, sys.base_prefix, *seen(), str(Path(__file__).parent))
            root.move(new, [path for path in system if os.path.exists(path)], ())
        sandbox.clear_tmp(64 * MIB, 10_000)
    if user:
        os.setgroups([])
        os.setresgid(user, user, user)
        os.setresuid(user, user, user)
    os.environ.update(SECRET="seen", HOME="/tmp")
    paths = hidden(Path(tempfile.mkdtemp()))
    said = {}
    if without:
        linux._call("prctl", linux.SET_NO_NEW_PRIVS, 1, 0, 0, 0)
        refuse(*without)
        paths[0].parent.chmod(0o755)
        try:
            start(level, hidden=paths[:1]).close()
        except CourseError as refusal:
            said = {"refused": str(refusal)}
    paths[0].chmod(0o600)
    with start(level, hidden=paths[:1] if "landlock" in without else paths) as starter:
        print(json.dumps({"level": starter.level} | said | starter.walls.refused | tried(starter, paths)))
