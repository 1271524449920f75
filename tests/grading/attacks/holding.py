"""Work that holds memory or files where nobody counts them, or leaves them so that whoever counts or deletes them stumbles."""

from .attack import attack
from .kernel import CALLS


def eating(name, code, **more):
    """Return an attack whose energy holds far more memory, or files, than it may, for as long as anybody needs to see it."""
    body = "\n".join(f"    {line}" for line in code.strip().split("\n"))
    return attack(name, first=CALLS, energy=f"def energy(x, k):\n{body}\n    time.sleep(0.5)\n    return 1.0", **more)


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
    while len(held) < 20 and (pair := tried(socket.socketpair)):
        held.append(pair)
        for one in pair:
            one.setblocking(False)
            one.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 22)
            while tried(one.send, bytes(1 << 16)):
                pass
    time.sleep(3)
children(3, fill)""",
    ),
    eating(
        "memory_in_its_own_pairs",
        """
held = []
while len(held) < 50 and (pair := tried(socket.socketpair)):
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
for _ in range(100):
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
for _, sink in held[:2]:
    tried(fcntl.fcntl, sink, 1031, 1 << 20)
    os.set_blocking(sink, False)
area = mmap.mmap(-1, 4 << 20, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
area.madvise(14)
start = -(-ctypes.addressof(ctypes.c_char.from_buffer(area)) // (2 << 20)) * (2 << 20)
for _, sink in held[:2]:
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
        + _AGAIN.format(times=16, sink="pages(file, held.pop()[1], 16)").strip(),
    ),
    eating(
        "memory_of_a_file_in_a_pair",
        _PIECES
        + "held = [socket.socketpair() for _ in range(80)]\nfor one, _ in held:\n    one.setblocking(False)\n"
        + _AGAIN.format(times=16, sink="kept.append(held.pop())\n    pages(file, kept[-1][0].fileno(), 16)").strip(),
    ),
    eating(
        "memory_of_zeros",
        """
zero = os.open("/dev/zero", os.O_RDWR)
def fill():
    area = mmap.mmap(zero, 240 << 20)
    for _ in range(12):
        area.write(bytes([1]) * (20 << 20))
    area.madvise(4)
    time.sleep(2)
children(4, fill)""",
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

ATTACKS = (*MEMORY, *FILES)
