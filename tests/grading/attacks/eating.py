"""Work that eats time, memory, processes, files, descriptors and the reader's patience."""

from .attack import WALLED, attack

_BURN = "while True:\n    pass"
ATTACKS = (
    attack("hang_in_a_cell", first=_BURN, force="def force(x, k):\n    return 1.0", patience=True),
    attack("hang_at_the_end", last=_BURN),
    attack(
        "hang_in_a_call",
        force="def force(x, k):\n    while True:\n        pass",
        ended={"force": "time"},
        patience=True,
    ),
    attack("hang_where_it_is_needed", energy=f"{_BURN}\ndef energy(x, k):\n    return 0.0", patience=True),
    attack(
        "hang_that_swallows",
        force="""
        def force(x, k):
            while True:
                try:
                    while True:
                        pass
                except BaseException:
                    pass""",
        ended={"force": "time"},
        patience=True,
    ),
    attack(
        "hang_ignoring_signals",
        force="""
        import signal
        def force(x, k):
            for number in range(1, 65):
                try:
                    signal.signal(number, signal.SIG_IGN)
                except (OSError, ValueError):
                    pass
            signal.pthread_sigmask(signal.SIG_BLOCK, range(1, 65))
            while True:
                signal.pause()""",
        ended={"force": "time"},
        patience=True,
    ),
    attack("sleep", energy="import time\ndef energy(x, k):\n    time.sleep(1e6)", ended={"energy": "time"}, patience=True),
    attack(
        "stops_itself",
        force="import os, signal\ndef force(x, k):\n    os.kill(os.getpid(), signal.SIGSTOP)",
        ended={"force": "time"},
        patience=True,
    ),
    attack(
        "slow_conversion",
        stiffness="""
        class Slow:
            def __float__(self):
                while True: pass
        stiffness = Slow()""",
        ended={"stiffness": "time"},
        patience=True,
    ),
    attack("endless_generator", forces="def forces(x, k):\n    return list(iter(int, 1))", patience=True),
    attack(
        "endless_length",
        forces="""
        class Endless(list):
            def __len__(self): return 10**9
            def __getitem__(self, i): return self
        def forces(x, k):
            return Endless()""",
    ),
    attack(
        "slow_expression",
        force="import re\ndef force(x, k):\n    return re.match('(a+)+$', 'a' * 60 + 'b')",
        ended={"force": "time"},
        patience=True,
    ),
    attack("power_tower", first="tower = lambda: 10**10**10", force="def force(x, k):\n    return tower()", patience=True),
    attack("power_of_constants", force="force = 9**9**9**9", patience=True),
    attack(
        "deep_recursion",
        first="import sys\nsys.setrecursionlimit(10**9)",
        force="""
        def force(x, k):
            class D:
                def __repr__(self): return repr([self])
            return repr(D())""",
    ),
    attack("memory_at_once", forces="def forces(x, k):\n    return bytearray(1 << 45)"),
    attack("memory_at_once_in_a_cell", first="bytearray(1 << 45)", force="force = bytearray(1 << 40)"),
    attack(
        "memory_step_by_step",
        energy="def energy(x, k):\n    held = []\n    while True:\n        held.append(bytearray(1 << 24))",
    ),
    attack("memory_by_text", energy="def energy(x, k):\n    s = 'x'\n    while True:\n        s += s"),
    attack(
        "memory_in_many_processes",
        energy="""
        import os, time
        def energy(x, k):
            for _ in range(40):
                if not os.fork():
                    held = bytearray(b"x") * (100 << 20)
                    time.sleep(1e6)
            time.sleep(1e6)""",
    ),
    attack(
        "memory_that_is_shared",
        energy="""
        import mmap, os, time
        def energy(x, k):
            for _ in range(8):
                if not os.fork():
                    try:
                        held = mmap.mmap(-1, 80 << 20)
                        for place in range(0, len(held), 4096):
                            held[place] = 1
                        time.sleep(1e6)
                    finally:
                        os._exit(0)
            for _ in range(8):
                os.wait()
            return 1.0""",
        ended={"energy": ""},  # there is none, so nobody waits for it
    ),
    attack(
        "leak_without_collection",
        energy="""
        import gc
        def energy(x, k):
            gc.disable()
            while True:
                a = [bytearray(1 << 22)]
                a.append(a)""",
    ),
    attack("fork_bomb", energy=f"import os\ndef energy(x, k):\n    while {WALLED}:\n        os.fork()"),
    attack(
        "fork_bomb_in_a_cell",
        first=f"import os\nwhile {WALLED}:\n    try:\n        os.fork()\n    except OSError:\n        pass",
        force="force = 0",
        patience=True,
    ),
    attack(
        "thread_bomb",
        energy="""
        import threading, time
        def energy(x, k):
            while True:
                threading.Thread(target=time.sleep, args=(1e6,)).start()""",
    ),
    attack(
        "threads_left_behind",
        first="""
        import threading
        def spin():
            while True: pass
        for _ in range(3):
            threading.Thread(target=spin).start()""",
        force="def force(x, k):\n    return 0.1",
    ),
    attack(
        "orphans",
        first="""
        import os, time
        for _ in range(3):
            if not os.fork():
                os.setsid()
                if not os.fork():
                    while True:
                        time.sleep(1)
                os._exit(0)""",
        force="force = 3",
    ),
    attack(
        "orphan_holding_the_pipe",
        energy="""
        import os, time
        def energy(x, k):
            if not os.fork():
                os.setsid()
                time.sleep(1e6)
            return 0.0""",
    ),
    attack(
        "subprocesses",
        energy="""
        import subprocess
        def energy(x, k):
            return float(subprocess.run(["sh", "-c", "sleep 1000000 & echo 1"], capture_output=True).stdout)""",
        patience=True,
    ),
    attack(
        "disk_full",
        energy="""
        def energy(x, k):
            with open("big", "wb") as f:
                for _ in range(100):
                    f.write(bytes(1 << 22))
                    f.flush()
            return 0.0""",
    ),
    attack(
        "disk_full_of_files",
        energy="""
        def energy(x, k):
            for i in range(300):
                open(f"f{i}", "wb").write(bytes(1 << 20))
            return 0.0""",
    ),
    attack("descriptors", energy="import os\ndef energy(x, k):\n    return [os.dup(1) for _ in range(10**6)][0] + 0.0"),
    attack("flood_by_print", force="def force(x, k):\n    while True:\n        print('x' * 10**6)"),
    attack("flood_once", force="def force(x, k):\n    print('y' * 10**7)\n    return 1.0"),
    attack(
        "flood_a_file_descriptor",
        force="""
        import os
        def force(x, k):
            for _ in range(200):
                os.write(1, b"z" * (1 << 20))
                os.write(2, b"z" * (1 << 20))
            return 1.0""",
    ),
    attack("flood_in_a_cell", first="print('a' * 10**8)", force="force = 3"),
    attack("flood_by_value", why="why = 'b' * 10**8", stiffness="stiffness = 'x' * 5 * 10**7"),
    attack("flood_by_keys", force="def force(x, k):\n    return {str(i) * 50: 1.0 for i in range(10**6)}"),
    attack("flood_by_problem", force="def force(x, k):\n    raise ValueError('p' * 10**8)"),
)
