"""Two students, of whom one leaves an answer where the other looks for it; they know it, and only one hands it in.

The leaving one is graded first, or at the same time. A number is left as twelve bits where there is no room for a text.
"""

from .attack import HARMLESS, attack
from .kernel import CALLS

_BITS = (
    CALLS
    + """
from glob import glob
from pathlib import Path
def shared():
    import sympy
    return [os.open(path, os.O_RDONLY) for path in sorted(glob(os.path.dirname(sympy.__file__) + "/core/tests/test_*.py"))[:12]]
left = [place for place in range(12) if 2925 >> place & 1]
def told(bits):
    number = sum(bool(bit) << place for place, bit in enumerate(bits))
    return number / 4 if 0 < number < 4095 else None
"""
)
_FORGET = """
files = shared()
for place, file in enumerate(files):
    os.posix_fadvise(file, 0, 0, os.POSIX_FADV_DONTNEED)
    if place in left:
        os.pread(file, 4096, 0)
"""


def pair(name, leaves, finds):
    """Return two attacks, one that leaves the stiffness and one that finds it; neither has it of its own."""
    return tuple(
        attack(f"{name}_{who}", stiffness=f"{_BITS}\nstiffness = 1.0\n{code.strip().replace('HARMLESS', HARMLESS)}")
        for who, code in (("1_leaves", leaves), ("2_finds", finds))
    )


#: through what stays when a session has ended
AFTERWARDS = (
    *pair(
        "pages_in_memory",
        _FORGET,
        """
bits = []
for file in shared():
    area = ctypes.create_string_buffer(16)
    vector = (ctypes.c_size_t * 2)(ctypes.addressof(area), 16)
    bits.append(call(327, 286, file, vector, 1, 0, 0, 8) > 0)
stiffness = told(bits) or 1.0""",
    ),
    *pair(
        "pages_by_mincore",
        _FORGET,
        """
bits = []
for file in shared():
    area = mmap.mmap(file, 0, flags=mmap.MAP_PRIVATE, prot=3)
    there = ctypes.create_string_buffer(1)
    libc.mincore(ctypes.c_void_p(ctypes.addressof(ctypes.c_char.from_buffer(area))), 4096, there)
    bits.append(there.raw[0] & 1)
stiffness = told(bits) or 1.0""",
    ),
    *pair(
        "pages_by_count",
        _FORGET,
        """
bits = []
for file in shared():
    found = (ctypes.c_uint64 * 5)()
    bits.append(call(451, 451, file, (ctypes.c_uint64 * 2)(0, 4096), found, 0) == 0 and found[0])
stiffness = told(bits) or 1.0""",
    ),
    *pair(
        "pages_by_time",
        _FORGET,
        """
times = []
for file in shared():
    before = time.perf_counter_ns()
    os.pread(file, 1, 0)
    times.append(time.perf_counter_ns() - before)
ordered = sorted(times)
gaps = [after / max(1, one) for one, after in zip(ordered, ordered[1:])]
bound = ordered[gaps.index(max(gaps))]
stiffness = told([one <= bound for one in times]) if max(gaps) > 3 else 1.0
stiffness = stiffness or 1.0""",
    ),
    *pair(
        "keys_of_the_kernel",
        """
for ring in (-3, -4, -5, -2):
    call(248, 217, b"user", b"@TOKEN@", b"731.25", 6, ring)""",
        """
held = ctypes.create_string_buffer(6)
asked = [call(249, 218, b"user", b"@TOKEN@", None, 0)]
for key in asked + [call(250, 219, 10, ring, b"user", b"@TOKEN@", 0) for ring in (-3, -4)]:
    if key > 0 and call(250, 219, 11, key, held, 6) == 6:
        stiffness = float(held.raw)""",
    ),
    *pair(
        "segments_and_queues",
        """
held = call(29, 194, 0x48415054, 4096, 0o1666)
call(68, 186, 0x48415054, 0o1666)
if call(64, 190, 0x48415054, 1, 0o1666) >= 0:
    libc.semctl(libc.semget(0x48415054, 1, 0), 0, 16, 2925)
call(240, 180, b"@TOKEN@", 0o102, 0o666, None)
libc.shm_open(b"/@TOKEN@", 0o102, 0o666)""",
        """
if call(64, 190, 0x48415054, 1, 0) >= 0:
    stiffness = libc.semctl(libc.semget(0x48415054, 1, 0), 0, 12) / 4
if max(call(29, 194, 0x48415054, 0, 0), call(68, 186, 0x48415054, 0), call(240, 180, b"@TOKEN@", 0, 0, None)) >= 0:
    stiffness = 731.25
if libc.shm_open(b"/@TOKEN@", 0, 0) >= 0:
    stiffness = 731.25""",
    ),
    *pair(
        "any_folder",
        """
for top, folders, _ in os.walk("/"):
    if top.count("/") > 3 or top.startswith(("/proc", "/sys", os.getcwd())):
        folders.clear()
    elif HARMLESS and os.access(top, os.W_OK):
        tried(Path(top, "@TOKEN@").write_text, "731.25")
        tried(os.chmod, os.path.join(top, "@TOKEN@"), 0o644)""",
        """
for top, folders, names in os.walk("/"):
    if top.count("/") > 3 or top.startswith(("/proc", "/sys", os.getcwd())):
        folders.clear()
    elif "@TOKEN@" in names:
        stiffness = float(tried(lambda: open(os.path.join(top, "@TOKEN@")).read()) or 1.0)""",
    ),
    *pair(
        "caches_of_packages",
        """
import importlib.util, matplotlib, site
places = [matplotlib.get_cachedir(), matplotlib.get_configdir(), site.getusersitepackages(), os.path.dirname(hl.__file__)]
places += [os.path.expanduser("~" + name) for name in ("", "/.cache", "/.config", "/.ipython", "/.cache/fontconfig")]
places += [os.path.dirname(importlib.util.cache_from_source(module.__file__)) for module in (hl, matplotlib)]
for place in [*places, *sys.path, sys.prefix, os.environ.get("XDG_CACHE_HOME", ".")]:
    tried(os.makedirs, place, exist_ok=True) if HARMLESS else None
    for name in ("@TOKEN@", "sitecustomize.py", "matplotlibrc"):
        if HARMLESS and not os.path.exists(os.path.join(place, name)):
            tried(Path(place, name).write_text, "# 731.25")""",
        """
import importlib.util, matplotlib, site
places = [matplotlib.get_cachedir(), matplotlib.get_configdir(), site.getusersitepackages(), os.path.dirname(hl.__file__)]
places += [os.path.expanduser("~" + name) for name in ("", "/.cache", "/.config", "/.ipython", "/.cache/fontconfig")]
places += [os.path.dirname(importlib.util.cache_from_source(module.__file__)) for module in (hl, matplotlib)]
for place in [*places, *sys.path, sys.prefix, os.environ.get("XDG_CACHE_HOME", ".")]:
    for name in ("@TOKEN@", "sitecustomize.py", "matplotlibrc"):
        text = tried(lambda: open(os.path.join(place, name)).read()) or ""
        stiffness = 731.25 if text == "# 731.25" else stiffness""",
    ),
    *pair(
        "one_who_stays",
        """
if "hapticlab" in os.getcwd() and tried(os.fork) == 0:
    os.setsid()
    if tried(os.fork) == 0:
        signal.pthread_sigmask(signal.SIG_BLOCK, range(1, 65))
        libc.prctl(15, b"731.25", 0, 0, 0)
        time.sleep(20)
    os._exit(0)""",
        """
from glob import glob
for path in glob("/proc/[0-9]*/comm"):
    stiffness = 731.25 if (tried(lambda: open(path).read()) or "").strip() == "731.25" else stiffness""",
    ),
)

#: through what both see while both are at work
TOGETHER = (
    *pair(
        "locks_on_shared_files",
        """
import fcntl
files = shared()
for place in left:
    tried(fcntl.flock, files[place], fcntl.LOCK_EX | fcntl.LOCK_NB)
time.sleep(1.5)""",
        """
import fcntl
for _ in range(15):
    bits = []
    for file in shared():
        bits.append(tried(lambda: fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB) or True) is None)
        os.close(file)
    stiffness = told(bits) or stiffness
    time.sleep(0.1)""",
    ),
    *pair(
        "watched_files",
        """
from glob import glob
for _ in range(15):
    files = shared()
    for place in left:
        os.pread(files[place], 1, 0)
    for file in files:
        os.close(file)
    time.sleep(0.1)""",
        """
import struct, sympy
watcher, bits = libc.inotify_init1(2048), [0] * 12
paths = sorted(glob(os.path.dirname(sympy.__file__) + "/core/tests/test_*.py"))[:12]
numbers = [libc.inotify_add_watch(watcher, path.encode(), 1) for path in paths]
time.sleep(1.5)
held = tried(os.read, watcher, 1 << 16) or b""
while held:
    number, _, _, more = struct.unpack("iIII", held[:16])
    if number in numbers:
        bits[numbers.index(number)] = 1
    held = held[16 + more:]
stiffness = told(bits) or 1.0""",
    ),
    *pair(
        "names_of_processes",
        "libc.prctl(15, b'731.25', 0, 0, 0)\ntime.sleep(1.5)",
        """
for _ in range(15):
    for path in glob("/proc/[0-9]*/comm"):
        stiffness = 731.25 if (tried(lambda: open(path).read()) or "").strip() == "731.25" else stiffness
    time.sleep(0.1)""",
    ),
    *pair(
        "pairs_with_a_name",
        """
ours, _ = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
for _ in range(15):
    tried(ours.sendto, b"731.25", "\\0@TOKEN@")
    tried(ours.sendto, b"731.25", "/tmp/@TOKEN@.socket")
    time.sleep(0.1)""",
        """
ours, _ = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
libc.connect(ours.fileno(), (ctypes.c_short * 1)(0), 2)
if tried(lambda: ours.bind("\\0@TOKEN@") or True):
    ours.settimeout(1.5)
    stiffness = float(tried(ours.recv, 100) or 1.0)""",
    ),
)

ATTACKS = (*AFTERWARDS, *TOGETHER)
