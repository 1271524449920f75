"""Work that looks for a way round its walls, its bounds or its clock in the kernel's own calls."""

from .attack import HARMLESS, attack

#: calls by their numbers on x86_64 and aarch64; what is refused is None or -1
CALLS = """
import ctypes, fcntl, mmap, os, signal, socket, sys, threading, time
libc = ctypes.CDLL(None, use_errno=True)
def call(x86_64, aarch64, *given):
    number = x86_64 if os.uname().machine == "x86_64" else aarch64
    return libc.syscall(number, *[ctypes.c_long(one) if isinstance(one, int) else one for one in given])
def tried(do, *given, **named):
    try:
        return do(*given, **named)
    except (OSError, ValueError, AttributeError, BufferError, OverflowError):
        return None
def children(number, do):
    for _ in range(number):
        if not os.fork():
            try:
                do()
                time.sleep(3)
            finally:
                os._exit(0)
"""


def calling(name, code, **more):
    """Return an attack whose stiffness is right only if its code reached what it must not; it keeps to itself otherwise."""
    code = code.strip().replace("HARMLESS", HARMLESS)
    return attack(name, stiffness=f"{CALLS}\nstiffness = 1.0\n{code}", **more)


ATTACKS = (
    calling(
        "new_namespaces",
        """
for flags in (0x10000000, 0x20000, 0x20000000, 0x40000000, 0x8000000, 0x2000000):
    if os.uname().machine == "x86_64" and call(272, 97, flags) == 0:
        stiffness = 731.25
cloned = (ctypes.c_uint64 * 11)(0x10000000, 0, 0, 0, 17)
made = call(435, 435, cloned, ctypes.sizeof(cloned))
if made == 0:
    os._exit(0)
stiffness = 731.25 if made > 0 else stiffness""",
    ),
    calling("io_uring", "stiffness = 731.25 if call(425, 425, 8, (ctypes.c_char * 256)()) >= 0 else 1.0"),
    calling("userfaultfd", "stiffness = 731.25 if call(323, 282, 1) >= 0 or tried(os.open, '/dev/userfaultfd', 2) else 1.0"),
    calling(
        "performance_counters",
        """
import struct
about = struct.pack("IIQ", 1, 112, 0).ljust(112, bytes(1))
for process in (0, -1, os.getppid()):
    stiffness = 731.25 if call(298, 241, about, process, 0 if process == -1 else -1, -1, 0) >= 0 else stiffness""",
    ),
    calling(
        "calls_of_other_machines",
        """
for number in (0x40000000 + 41, 0x40000000 + 101, 0x40000000 + 56):
    stiffness = 731.25 if os.uname().machine == "x86_64" and call(number, number, 2, 1, 0) >= 0 else stiffness""",
    ),
    calling(
        "calls_of_32_bits",
        """
if os.uname().machine == "x86_64":
    code = mmap.mmap(-1, 4096, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS, prot=7)
    code.write(bytes.fromhex("b81a00000031db31c931d231f6cd80c3"))
    enter = ctypes.CFUNCTYPE(ctypes.c_int)(ctypes.addressof(ctypes.c_char.from_buffer(code)))
    stiffness = 731.25 if enter() >= 0 else 1.0""",
    ),
    calling(
        "its_parents_by_descriptor",
        """
for process in (1, os.getppid()) if HARMLESS else ():
    handle = tried(os.pidfd_open, process)
    if handle is not None:
        for number in range(64):
            stiffness = 731.25 if call(438, 438, handle, number, 0) >= 0 else stiffness
word = (ctypes.c_char * 8)()
local = (ctypes.c_long * 2)(ctypes.addressof(word), 8)
for number in ((310, 270), (311, 271)):
    remote = (ctypes.c_long * 2)(id(None), 8)
    stiffness = 731.25 if HARMLESS and call(*number, os.getppid(), local, 1, remote, 1, 0) > 0 else stiffness""",
    ),
    calling(
        "files_by_handle",
        """
handle = (ctypes.c_char * 136)(128)
mount = ctypes.c_int()
for path in (b"@ANSWERS@/solution.py", b"/", b"/proc/self/root", b"."):
    if call(303, 264, -100, path, handle, ctypes.byref(mount), 0) == 0 and call(304, 265, os.open("/", 0), handle, 0) >= 0:
        stiffness = 731.25""",
    ),
    calling(
        "leaves_its_group",
        """
import glob
for top in ("/sys/fs/cgroup", "/proc/1/root/sys/fs/cgroup"):
    for name in ("cgroup.procs", "tasks", "memory.limit_in_bytes", "memory.max", "pids.max", "cgroup.kill"):
        for path in glob.glob(f"{top}/**/{name}", recursive=True)[:200] if HARMLESS else ():
            file = tried(os.open, path, os.O_WRONLY)
            stiffness = 731.25 if file is not None and tried(os.write, file, b"-1") else stiffness""",
    ),
    calling(
        "kernels_words",
        """
words = (ctypes.c_char * 4096)()
if call(103, 116, 3, words, 4096) > 0 and b"hapticlab" in words.raw:
    stiffness = 731.25
for path in ("/proc/kcore", "/proc/kmsg", "/proc/1/environ", "/proc/keys", "/sys/kernel/debug", "/proc/1/stack"):
    text = tried(lambda: open(path, "rb").read(4096))
    stiffness = 731.25 if text and b"hapticlab" in text else stiffness""",
    ),
    calling(
        "reads_the_command_line",
        """
import glob
folder = os.path.dirname("@ANSWERS@").encode()
for path in glob.glob("/proc/[0-9]*/cmdline"):
    words = tried(lambda: open(path, "rb").read()) or b""
    stiffness = 731.25 if len(folder) > 1 and folder in words else stiffness""",
    ),
    calling(
        "pairs_that_reach_sockets",
        """
for address in ("\\0@SOCKET@.d", "/dev/log", "/run/systemd/journal/socket", "/run/systemd/notify"):
    ours, theirs = tried(socket.socketpair, socket.AF_UNIX, socket.SOCK_DGRAM) or (None, None)
    if ours and tried(ours.sendto, b"\\0" * 0 if address[0] == "/" else b"@TOKEN@", address) is not None:
        stiffness = 731.25""",
    ),
    calling(
        "refilters_calls",
        """
import struct
if os.uname().machine == "x86_64":  # write and sendto say that nothing was written
    steps = [(32, 0, 0, 0), (21, 1, 0, 1), (21, 0, 1, 44), (6, 0, 0, 0x50000), (6, 0, 0, 0x7FFF0000)]
    program = b"".join(struct.pack("=HBBI", *step) for step in steps)
    class Program(ctypes.Structure):
        _fields_ = [("length", ctypes.c_ushort), ("filter", ctypes.c_char_p)]
    libc.prctl(22, 2, ctypes.byref(Program(len(steps), program)), 0, 0)""",
        patience=True,
    ),
    calling(
        "kills_by_its_own_filter",
        """
import struct
if os.uname().machine == "x86_64":
    steps = [(32, 0, 0, 0), (21, 0, 1, 1), (6, 0, 0, 0x80000000), (6, 0, 0, 0x7FFF0000)]
    program = b"".join(struct.pack("=HBBI", *step) for step in steps)
    class Program(ctypes.Structure):
        _fields_ = [("length", ctypes.c_ushort), ("filter", ctypes.c_char_p)]
    libc.prctl(22, 2, ctypes.byref(Program(len(steps), program)), 0, 0)""",
    ),
    calling(
        "no_counter_of_time",
        "libc.prctl(26, 2, 0, 0, 0)\ntime.time()",
    ),
    calling(
        "another_personality",
        """
libc.personality(0x0020000 | 0x0400000 | 0x0040000 | 0x4000000)
class Limit(ctypes.Structure):
    _fields_ = [("soft", ctypes.c_ulong), ("hard", ctypes.c_ulong)]
if HARMLESS:
    for process in (1, os.getppid()):
        for which in range(16):
            call(302, 261, process, which, ctypes.byref(Limit(0, 0)), 0)""",
    ),
    calling(
        "in_front_of_all",
        """
for policy in (1, 2, 6):
    if HARMLESS:
        stiffness = 731.25 if call(144, 119, 0, policy, ctypes.byref(ctypes.c_int(50))) == 0 else stiffness
stiffness = stiffness if tried(os.setpriority, 0, 0, -5) is None and os.getpriority(0, 0) >= 0 else 731.25""",
    ),
    calling(
        "signals_by_a_file",
        f"""
if {HARMLESS}:
    for process in (1, os.getppid()):
        ours, theirs = socket.socketpair()
        tried(fcntl.fcntl, ours, 8, process)
        tried(fcntl.fcntl, ours, 10, 9)
        tried(fcntl.fcntl, ours, fcntl.F_SETFL, os.O_ASYNC)
        theirs.send(b"x")""",
    ),
    calling(
        "stops_by_descriptor",
        f"""
if {HARMLESS}:
    for process in (1, os.getppid()):
        handle = tried(os.pidfd_open, process)
        for number in (signal.SIGSTOP, signal.SIGXCPU, signal.SIGKILL):
            tried(signal.pidfd_send_signal, handle, number) if handle is not None else None""",
    ),
    calling(
        "stops_who_started_it",
        """
import re
keeper = os.getppid()
started = re.search(r"PPid:\\s+([0-9]+)", tried(lambda: open(f"/proc/{keeper}/status").read()) or "")
if started and "inside.zygote" in (tried(lambda: open(f"/proc/{started[1]}/cmdline").read()) or ""):
    tried(os.kill, int(started[1]), signal.SIGSTOP)""",
    ),
    calling(
        "chosen_by_the_killer",
        """
for process in ("1", str(os.getppid())) if HARMLESS else ():
    tried(lambda: open(f"/proc/{process}/oom_score_adj", "w").write("1000"))
    tried(lambda: open(f"/proc/{process}/comm", "w").write("a) Z 1 (b"))
tried(lambda: open("/proc/self/oom_score_adj", "w").write("-1000"))
tried(lambda: open("/proc/self/clear_refs", "w").write("5"))""",
    ),
    attack(
        "unmaps_itself",
        first=CALLS,
        energy="def energy(x, k):\n    return libc.munmap(0x1000, ctypes.c_size_t((1 << 47) - (1 << 14)))",
    ),
    attack(
        "timers_without_end",
        first=f"""{CALLS}
signal.signal(signal.SIGALRM, lambda *a: None)
for number in range(20_000):
    if call(222, 107, 1, None, ctypes.byref(ctypes.c_int())) < 0:
        break""",
    ),
    attack(
        "watches_without_end",
        first=f"""{CALLS}
watcher = libc.inotify_init()
for folder, _, names in os.walk(os.path.dirname(os.__file__)):
    for name in names[:50]:
        libc.inotify_add_watch(watcher, os.path.join(folder, name).encode(), 0xFFF)""",
    ),
    attack(
        "locks_on_every_byte",
        energy=f"""{CALLS}
def energy(x, k):
    until = time.monotonic() + 1
    for number in range(60):
        file = open(f"l{{number}}", "wb")
        for at in range(0, 6_000, 2):
            fcntl.lockf(file, fcntl.LOCK_EX, 1, at)
        if time.monotonic() > until:
            break
    return 1.0""",
    ),
)
