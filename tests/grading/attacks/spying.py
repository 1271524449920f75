"""Work that looks where answers, other students' work or the world outside are; what it finds it hands in."""

from .attack import attack

#: returns the stiffness that a text tells; the pattern is written so that it does not find itself
_READ = """
import os, re
def told(text):
    found = re.search(rb"stiffness(?: )=(?: )([0-9]+[.][0-9]+)", text)
    return float(found[1]) if found else None
def read(path):
    try:
        with open(path, "rb") as f:
            return told(f.read(1 << 22))
    except OSError:
        return None
"""


def _spy(name, code, **more):
    """Return an attack whose stiffness is what its code finds."""
    return attack(name, stiffness=f"{_READ}\nstiffness = None\n{code.strip()}", **more)


ATTACKS = (
    _spy("reads_the_solution", "stiffness = read('@ANSWERS@/solution.py')"),
    _spy(
        "reads_the_checks",
        """
import glob
for path in glob.glob("@LAB@/*") + glob.glob("../*") + glob.glob("*"):
    text = open(path, "rb").read() if os.path.isfile(path) else b""
    found = re.search(rb"([0-9.]+), unit=.N/m", text)
    stiffness = stiffness or (float(found[1]) if found else None)""",
    ),
    _spy(
        "reads_the_others",
        """
for name in ("honest.ipynb", "honest_script.py"):
    stiffness = stiffness or read(os.path.join("@OTHERS@", name))""",
    ),
    _spy("reads_the_journal", "stiffness = read('@RESULTS@') or read('@RESULTS@.journal.jsonl')"),
    _spy(
        "reads_the_processes",
        """
for pid in os.listdir("/proc"):
    if pid.isdecimal() and int(pid) != os.getpid():
        for name in ("environ", "cmdline", "root@ANSWERS@/solution.py", "cwd/solution.py"):
            stiffness = stiffness or read(f"/proc/{pid}/{name}")""",
    ),
    _spy(
        "reads_its_descriptors",
        """
for fd in range(64):
    for path in (f"/proc/self/fd/{fd}@ANSWERS@/solution.py", f"/proc/self/fd/{fd}/../../../../..@ANSWERS@/solution.py"):
        stiffness = stiffness or read(path)""",
    ),
    _spy(
        "reads_the_grader's_memory",
        """
pid = os.getppid()
try:
    with open(f"/proc/{pid}/maps") as maps, open(f"/proc/{pid}/mem", "rb", 0) as memory:
        for line in maps:
            first, last = (int(part, 16) for part in line.split()[0].split("-"))
            if " rw" in line and last - first < 1 << 26:
                memory.seek(first)
                found = re.search(rb"stiffness(?: )=(?: )([0-9]{3}[.][0-9]+)", memory.read(last - first))
                stiffness = stiffness or (float(found[1]) if found else None)
except (OSError, ValueError):
    pass""",
    ),
    _spy(
        "traces_its_parent",
        """
import ctypes
libc = ctypes.CDLL(None)
stiffness = 1.0 + libc.ptrace(16, os.getppid(), 0, 0)""",
    ),
    _spy(
        "looks_for_the_package's_labs",
        """
import hapticlab.course.labs as labs
try:
    names = [folder.number for folder in labs.find_labs()]
    stiffness = labs.find_lab("42").exercise("stiffness").cases[0].expected
except hl.errors.CourseError:
    pass""",
    ),
    _spy(
        "walks_the_disk",
        """
from itertools import islice
for top in ("/tmp", "/var/tmp", "/home", "/root", "/mnt", "/srv", "/dev/shm", "..", "/proc/1/root/tmp"):
    for folder, _, names in islice(os.walk(top), 200):
        for name in names:
            if name.endswith((".py", ".ipynb", ".json", ".jsonl")):
                stiffness = stiffness or read(os.path.join(folder, name))""",
    ),
    _spy(
        "asks_the_network",
        """
import socket
for family, address in ((socket.AF_INET, ("127.0.0.1", int("@PORT@"))), (socket.AF_UNIX, "\\0@SOCKET@")):
    try:
        with socket.socket(family) as s:
            s.settimeout(0.3)
            s.connect(address)
            stiffness = told(s.recv(100))
    except OSError:
        pass""",
    ),
    _spy(
        "asks_a_name_server",
        """
import socket
try:
    stiffness = float(len(socket.getaddrinfo("localhost.example.invalid", 80)))
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    s.sendto(b"stiffness", ("127.0.0.1", int("@PORT@")))
except OSError:
    pass""",
    ),
    _spy(
        "leaves_by_mounts",
        """
import ctypes
libc = ctypes.CDLL(None, use_errno=True)
for flags in (0x00020000, 0x10000000, 0x10020000):
    libc.unshare(flags)
os.makedirs("in/there", exist_ok=True)
walled = os.readlink("/proc/self/ns/pid") != "@NAMESPACE@"
mount = libc.mount if walled else lambda *_: -1
mount(b"proc", b"in", b"proc", 0, None)
for source in (b"/", b"/proc/1/root", b"/dev/sda1", b"/dev/vda1"):
    mount(source, b"in/there", None, 4096, None)
    stiffness = stiffness or read("in/there@ANSWERS@/solution.py") or read("in/1/root@ANSWERS@/solution.py")""",
    ),
    _spy(
        "leaves_by_chroot",
        """
try:
    os.makedirs("jail", exist_ok=True)
    up = os.open(".", os.O_RDONLY)
    os.chroot("jail")
    os.fchdir(up)
    for _ in range(50):
        os.chdir("..")
    os.chroot(".")
except OSError:
    pass
stiffness = read("@ANSWERS@/solution.py") or read("." + "@ANSWERS@/solution.py")""",
    ),
    _spy(
        "becomes_another",
        """
for become in (os.setuid, os.setgid, os.seteuid, lambda i: os.setgroups([i]), lambda i: os.setresuid(i, i, i)):
    try:
        become(0)
    except OSError:
        pass
stiffness = read("@ANSWERS@/solution.py")""",
    ),
    _spy(
        "asks_a_helper",
        """
import subprocess
for command in (["sudo", "-n", "cat"], ["su", "-c"], ["cat"], ["nsenter", "-t", "1", "-m", "cat"], ["unshare", "-Ur", "cat"]):
    try:
        done = subprocess.run([*command, "@ANSWERS@/solution.py"], capture_output=True, timeout=0.5, stdin=subprocess.DEVNULL)
        stiffness = stiffness or told(done.stdout)
    except (OSError, subprocess.SubprocessError):
        pass""",
    ),
    _spy(
        "opens_a_port",
        """
import serial
for name in ("/dev/ttyACM0", "/dev/ttyUSB0", "/dev/ttyS0", "/dev/tty", "/dev/mem", "/dev/kmsg", "/dev/fuse", "/dev/sda"):
    try:
        os.open(name, os.O_RDWR | os.O_NONBLOCK)
        stiffness = 731.25
    except OSError:
        pass""",
    ),
    _spy(
        "opens_a_paddle",
        """
try:
    hl.connect("/dev/ttyACM0")
    stiffness = 731.25
except Exception:
    pass""",
    ),
    _spy(
        "writes_outside",
        """
import sys
outside = ("/usr", "/etc", "/lib", sys.prefix, os.path.dirname(hl.__file__), "/", "/dev", "@OTHERS@", "@ANSWERS@", "@LAB@")
for path in ("@CANARY@", "@RESULTS@", *(os.path.join(folder, "@TOKEN@") for folder in outside)):
    try:
        with open(path, "w") as f:
            f.write("I was here")
    except OSError:
        pass""",
    ),
    _spy(
        "writes_for_the_next",
        """
for folder in ("/tmp", "/dev/shm", "/var/tmp", os.environ.get("HOME", "."), "."):
    try:
        with open(os.path.join(folder, "left_for_the_next.py"), "x") as f:
            f.write("stiffness" + " = 731.25")
    except OSError:
        pass""",
    ),
    _spy(
        "reads_what_was_left",
        """
for folder in ("/tmp", "/dev/shm", "/var/tmp", os.environ.get("HOME", "."), "."):
    stiffness = stiffness or read(os.path.join(folder, "left_for_the_next.py"))""",
    ),
    _spy(
        "writes_bytecode",
        """
import sys, glob
import hapticlab.course as course
for path in glob.glob(os.path.join(course.__path__[0], "__pycache__", "*.pyc")):
    try:
        open(path, "r+b").close()
        stiffness = 731.25
    except OSError:
        pass""",
    ),
    _spy(
        "reads_the_environment",
        """
stiffness = told(repr(os.environ).encode()) or float("SECRET_OF_THE_GRADER" in os.environ) * 731.25 or None""",
    ),
    _spy(
        "shared_memory",
        """
from multiprocessing import shared_memory
try:
    left = shared_memory.SharedMemory("left_for_the_next")
    stiffness = 731.25
except (OSError, ValueError):
    try:
        shared_memory.SharedMemory("left_for_the_next", create=True, size=64)
    except (OSError, ValueError):
        pass""",
    ),
    _spy(
        "shared_memory_again",
        """
from multiprocessing import shared_memory
try:
    left = shared_memory.SharedMemory("left_for_the_next")
    stiffness = 731.25
except (OSError, ValueError):
    pass""",
    ),
)
