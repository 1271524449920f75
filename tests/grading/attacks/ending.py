"""Work that ends its process, its parent, everything in reach, or whatever cleans up after it."""

from .attack import WALLED, attack

_WRONG = {"force": "def force(x, k):\n    return 1.0"}
ATTACKS = (
    attack("exit_in_a_cell", first="import os\nos._exit(0)"),
    attack("exit_in_a_cell_and_wrong", first="import os\nos._exit(0)", **_WRONG),
    attack(
        "exit_in_every_cell",
        first="import os\nos._exit(1)",
        last="import os\nos._exit(2)",
        **_WRONG,
        guess="import os\nos._exit(3)",
    ),
    attack("exit_in_a_call", force="import os\ndef force(x, k):\n    os._exit(0)", ended={"force": "exit"}),
    attack(
        "exit_in_all_calls",
        first="import os",
        force="def force(x, k):\n    os._exit(0)",
        energy="def energy(x, k):\n    os._exit(1)",
        forces="def forces(x, k):\n    os._exit(2)",
    ),
    attack("system_exit", first="import sys\nsys.exit(0)", force="import sys\ndef force(x, k):\n    sys.exit(0)"),
    attack("quit", first="quit()", last="exit()", force="def force(x, k):\n    quit()"),
    attack("raise_system_exit", first="raise SystemExit", force="def force(x, k):\n    raise SystemExit"),
    attack(
        "raise_keyboard_interrupt",
        first="raise KeyboardInterrupt",
        force="def force(x, k):\n    raise KeyboardInterrupt",
    ),
    attack("raise_generator_exit", first="raise GeneratorExit", force="def force(x, k):\n    raise GeneratorExit"),
    attack(
        "abort",
        first="import os\nos.abort()",
        force="import os\ndef force(x, k):\n    os.abort()",
        ended={"force": "signal 6"},
    ),
    attack(
        "segmentation_fault",
        first="import ctypes\nctypes.string_at(0)",
        force="import ctypes\ndef force(x, k):\n    ctypes.string_at(0)",
        ended={"force": "signal 11"},
    ),
    attack(
        "kill_itself",
        first="import os\nos.kill(os.getpid(), 9)",
        force="import os\ndef force(x, k):\n    os.kill(os.getpid(), 9)",
    ),
    attack(
        "kill_its_parent",
        first="import os\nos.kill(os.getppid(), 9)",
        force="import os\ndef force(x, k):\n    os.kill(os.getppid(), 9)\n    return 1.0",
    ),
    attack(
        "kill_all",
        first=f"import os\nif {WALLED}:\n    os.kill(-1, 9)",
        force=f"import os\ndef force(x, k):\n    if {WALLED}:\n        os.kill(-1, 9)\n    return 1.0",
    ),
    attack("kill_its_group", first="import os\nos.killpg(0, 9)", force="import os\ndef force(x, k):\n    os.killpg(0, 9)"),
    attack(
        "kill_every_number",
        first=f"""
        import os
        for pid in range(1, 70_000):
            if pid != os.getpid() and {WALLED}:
                try:
                    os.kill(pid, 9)
                except OSError:
                    pass""",
        **_WRONG,
    ),
    attack(
        "stop_its_parent",
        force="import os, signal\ndef force(x, k):\n    os.kill(os.getppid(), signal.SIGSTOP)\n    return 1.0",
        patience=True,
    ),
    attack(
        "at_exit",
        first="""
        import atexit, os
        @atexit.register
        def last_word():
            while True: pass""",
        **_WRONG,
    ),
    attack(
        "handlers",
        first="""
        import signal, sys
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGCHLD, signal.SIGALRM, signal.SIGPIPE, signal.SIGXCPU):
            signal.signal(number, lambda *a: sys.exit(0))
        signal.setitimer(signal.ITIMER_REAL, 0.001, 0.001)""",
        **_WRONG,
        lost=("force",),
    ),
    attack(
        "dying_objects",
        first="""
        class Dying:
            def __del__(self):
                import os
                os._exit(0)
        dying = Dying()""",
        force="""
        def force(x, k):
            Dying()
            return 1.0""",
    ),
    attack(
        "excepthook",
        first="import sys, os\nsys.excepthook = sys.unraisablehook = lambda *a: os._exit(0)\n1/0",
        **_WRONG,
    ),
    attack("trace", first="import sys, os\nsys.settrace(lambda *a: os._exit(0))", **_WRONG),
    attack(
        "closes_all",
        first="import os\nos.closerange(0, 4096)",
        force="import os\ndef force(x, k):\n    os.closerange(0, 4096)\n    return 1.0",
    ),
    attack(
        "closes_its_output",
        first="import sys\nsys.stdout.close()\nsys.stderr.close()",
        force="import sys\ndef force(x, k):\n    sys.stdout.close()\n    return 1.0",
    ),
    attack(
        "deletes_its_folder",
        first="import shutil, os\nshutil.rmtree(os.getcwd(), ignore_errors=True)\nos.chdir('/')",
        **_WRONG,
    ),
    attack(
        "deletes_the_others",
        first="import shutil\nshutil.rmtree('@OTHERS@', ignore_errors=True)",
        force="import os\ndef force(x, k):\n    os.remove('@CANARY@')\n    return 1.0",
    ),
    attack(
        "execs_another",
        first="import os\nos.execvp('true', ['true'])",
        force="import os\ndef force(x, k):\n    os.execvp('yes', ['yes'])",
    ),
    attack(
        "limits_of_its_own",
        first="""
        import contextlib, resource
        for limit in range(10):
            with contextlib.suppress(OSError, ValueError):
                resource.setrlimit(limit, (1, 1))""",
        **_WRONG,
    ),
)
