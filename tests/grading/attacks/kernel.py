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


def eating(name, code, **more):
    """Return an attack whose energy holds far more memory, or files, than it may, for as long as anybody needs to see it."""
    body = "\n".join(f"    {line}" for line in code.strip().split("\n"))
    return attack(name, first=CALLS, energy=f"def energy(x, k):\n{body}\n    time.sleep(1)\n    return 1.0", **more)


def harming(name, code, **more):
    """Return an attack that leaves its folder so that whoever counts or deletes it stumbles."""
    return eating(name, f"os.makedirs('in', exist_ok=True)\n{code.strip()}", **more)


#: so much in all: far above the bound of the tests, far below what a computer has
_SIX_HUNDRED = "held = b'x' * (150 << 20)"
#: pieces of 4 kB of large pages, each of which keeps all of its 2 MB
_PIECES = """
def pages(file, sink, pieces, piece=2 << 20):
    size = os.fstat(file).st_size
    return sum(tried(os.sendfile, sink, file, at, 4096) or 0 for at in range(0, min(size, pieces * piece), piece))
"""
#: writes a file of 32 MB, hands its pages on, and cuts it to nothing
_AGAIN = """
file = os.open("pages", os.O_RDWR | os.O_CREAT)
kept = []
for _ in range({times}):
    for _ in range(4):
        os.write(file, bytes(8 << 20))
    {sink}
    os.ftruncate(file, 0)
    os.lseek(file, 0, 0)"""

LOOKING = (
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
    stiffness = 731.25 if HARMLESS and call(*number, os.getppid(), local, 1, (ctypes.c_long * 2)(id(None), 8), 1, 0) > 0 else stiffness""",
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
    attack("unmaps_itself", first=CALLS, energy="def energy(x, k):\n    return libc.munmap(ctypes.c_void_p(0x1000), 1 << 46)"),
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
        for at in range(0, 20_000, 2):
            fcntl.lockf(file, fcntl.LOCK_EX, 1, at)
        if time.monotonic() > until:
            break
    return 1.0""",
    ),
)

MEMORY = (
    attack(
        "first_thread_ends",
        first=CALLS,
        energy="""
        def energy(x, k):
            threading.Thread(target=time.sleep, args=(60,)).start()
            call(60, 93, 0)""",
        ended={"energy": "time"},
        patience=True,
    ),
    attack(
        "first_thread_of_a_child_ends",
        first=CALLS,
        energy="""
        def energy(x, k):
            if not os.fork():
                os.setsid()
                threading.Thread(target=time.sleep, args=(60,)).start()
                call(60, 93, 0)
            return 1.0""",
    ),
    eating(
        "memory_of_dead_threads",
        f"""
def hold():
    {_SIX_HUNDRED}
    time.sleep(3)
    os._exit(0)
def leave():
    threading.Thread(target=hold).start()
    call(60, 93, 0)
children(6, leave)
time.sleep(1)""",
    ),
    eating(
        "memory_of_other_programs",
        """
import subprocess
program = "import time; held = b'x' * (110 << 20); time.sleep(3)"
for _ in range(8):
    subprocess.Popen([sys.executable, "-I", "-S", "-c", program])
time.sleep(1)""",
    ),
    eating(
        "memory_in_pairs",
        """
def fill():
    held = []
    while pair := tried(socket.socketpair):
        held.append(pair)
        for one in pair:
            one.setblocking(False)
            one.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 22)
            while tried(one.send, bytes(1 << 16)):
                pass
    time.sleep(3)
children(4, fill)""",
    ),
    eating(
        "memory_in_its_own_pairs",
        """
held = []
while len(held) < 230 and (pair := tried(socket.socketpair)):
    held.append(pair)
    for one in pair:
        one.setblocking(False)
        one.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 22)
        while tried(one.send, bytes(1 << 16)):
            pass""",
    ),
    eating(
        "memory_in_flight",
        """
carrier, other = socket.socketpair()
for _ in range(200):
    ours, theirs = socket.socketpair()
    ours.setblocking(False)
    ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 22)
    while tried(ours.send, bytes(1 << 16)):
        pass
    carrier.setblocking(False)
    if tried(socket.send_fds, carrier, [b"x"], [ours.fileno(), theirs.fileno()]) is None:
        break
    ours.close()
    theirs.close()""",
    ),
    eating(
        "memory_in_pipes",
        """
held = []
while pipe := tried(os.pipe):
    held.append(pipe)
    tried(fcntl.fcntl, pipe[1], 1031, 1 << 20)
    os.set_blocking(pipe[1], False)
    while tried(os.write, pipe[1], bytes(1 << 16)):
        pass""",
    ),
    eating(
        "memory_spliced_away",
        """
held = [os.pipe() for _ in range(100)]
for _, sink in held[:3]:
    tried(fcntl.fcntl, sink, 1031, 1 << 20)
    os.set_blocking(sink, False)
area = mmap.mmap(-1, 4 << 20, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
area.madvise(14)
start = -(-ctypes.addressof(ctypes.c_char.from_buffer(area)) // (2 << 20)) * (2 << 20)
for _, sink in held[:3]:
    for _ in range(200):
        ctypes.memset(start, 1, 2 << 20)
        if call(278, 75, sink, (ctypes.c_long * 2)(start, 4096), 1, 2) < 0:
            break
        libc.madvise(ctypes.c_void_p(start), 2 << 20, 4)""",
    ),
    eating(
        "memory_of_a_file_that_was_cut",
        _PIECES
        + "held = [os.pipe() for _ in range(40)]\nfor _, sink in held:\n    os.set_blocking(sink, False)\n"
        + _AGAIN.format(times=40, sink="pages(file, held.pop()[1], 16)").strip(),
    ),
    eating(
        "memory_of_a_file_in_a_pair",
        _PIECES
        + "held = [socket.socketpair() for _ in range(80)]\nfor one, _ in held:\n    one.setblocking(False)\n"
        + _AGAIN.format(times=40, sink="pages(file, held.pop()[0].fileno(), 16)").strip().replace("held.pop()", "held[_]"),
    ),
    eating(
        "memory_of_zeros",
        """
zero = os.open("/dev/zero", os.O_RDWR)
areas = [mmap.mmap(zero, 100 << 20) for _ in range(4)]
for area in areas:
    area.write(b"x" * len(area))
    area.madvise(4)
def fill():
    area = mmap.mmap(zero, 200 << 20)
    area.write(b"x" * len(area))
    area.madvise(4)
    time.sleep(2)
children(3, fill)""",
    ),
    eating(
        "memory_under_a_false_name",
        f"""
def hold():
    libc.prctl(15, b"a) Z 1 (b\\nRssAnon:", 0, 0, 0)
    {_SIX_HUNDRED}
    time.sleep(3)
children(6, hold)""",
    ),
    eating(
        "memory_by_many_threads",
        """
def hold():
    held = b"x" * (60 << 20)
    time.sleep(2)
for _ in range(16):
    threading.Thread(target=hold).start()""",
    ),
)

FILES = (
    harming("nested_folders", "for _ in range(3000):\n    os.mkdir('d')\n    os.chdir('d')"),
    harming(
        "its_folder_is_a_link",
        """
place = os.getcwd()
if "hapticlab" in place:
    os.rename(place, place + "-moved")
    os.symlink("/usr/lib", place)""",
        patience=True,
    ),
    harming(
        "a_folder_that_nobody_lists",
        """
files = [open(f"in/{k}", "wb") for k in range(12)]
os.chmod("in", 0)
for file in files:
    for _ in range(10):
        file.write(bytes(1 << 20))
    file.flush()""",
    ),
    eating(
        "files_without_a_name",
        """
files = []
for number in range(20):
    files.append(open(f"u{number}", "wb", 0))
    os.unlink(f"u{number}")
    files[-1].write(bytes(12 << 20))""",
    ),
    eating("forty_thousand_files", "for number in range(40_000):\n    os.close(os.open(f'e{number}', os.O_CREAT | os.O_WRONLY))"),
    eating(
        "files_elsewhere",
        """
for top in ("/dev/shm", "/tmp", "/var/tmp", "/run/lock", "/var/lock", "/run/user"):
    for number in range(4):
        file = tried(open, f"{top}/@TOKEN@-{os.getpid()}-{number}", "wb", 0)
        file and file.write(bytes(20 << 20))""",
    ),
    harming(
        "folders_without_end_of_links",
        """
os.symlink(".", "in/loop")
os.symlink("/", "in/all")
os.symlink("/proc/self/root", "in/root")
os.mkfifo("in/fifo")
os.link("in/fifo", "in/fifo2")
tried(os.link, "@CANARY@", "in/canary")
tried(os.symlink, "@CANARY@", "in/canary")
tried(os.symlink, "@OTHERS@", "in/others")
tried(os.mknod, "in/device", 0o60600, os.makedev(254, 0))""",
    ),
    harming("a_file_of_holes", "for k in range(3):\n    os.truncate(os.open(f'in/{k}', os.O_CREAT | os.O_RDWR), 60 << 20)"),
    harming("names_of_any_bytes", "for k in range(1, 256):\n    tried(os.mkdir, b'in/' + bytes([k]) * 200)"),
)

ATTACKS = (*LOOKING, *MEMORY, *FILES)
