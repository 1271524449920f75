"""The process that loads what notebooks need, once for all workers, and forks a zygote for each."""

import json
import os
import socket
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2]
#: one thread, as a zygote forks; no port but a simulated one; the same order of sets in every run
ENVIRONMENT = {
    "PATH": "/usr/local/bin:/usr/bin:/bin",
    "LANG": "C.UTF-8",
    "PYTHONHASHSEED": "0",
    "PYTHONDONTWRITEBYTECODE": "1",
    "MPLBACKEND": "Agg",
    "HAPTICLAB_PORTS": "sim",
    # large pages, of which a fork copies fewer: 3 ms instead of 14 where 130 MB are loaded
    "PYTHONMALLOC": "malloc",
    "GLIBC_TUNABLES": "glibc.malloc.hugetlb=1",
    **{f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL", "NUMEXPR", "VECLIB")},
}
#: never the working folder, which may hold what students handed in; this package's own, after the standard library's
FLAGS = ("-P", "-s")
FIND_PACKAGE = (
    "import sys; libraries = [k for k, path in enumerate(sys.path) if path.endswith('-packages')]; "
    "sys.path.insert((libraries or [len(sys.path)])[0], sys.argv.pop(1)); "
)
PROGRAM = FIND_PACKAGE + "from hapticlab.grading.inside.zygote import main; main(int(sys.argv[1]))"


class Preloaded:
    """An interpreter that begins to load at once, before its first zygote is asked for; a context manager."""

    def __init__(self):
        self._control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        cache = {name: os.environ[name] for name in ("HOME", "XDG_CACHE_HOME") if name in os.environ}
        # a session of its own: an interrupt at the keyboard is for the grader, which then ends it in order
        self._process = subprocess.Popen(
            [sys.executable, *FLAGS, "-c", PROGRAM, str(PACKAGE.parent), str(theirs.fileno())],
            cwd="/",
            env={**cache, **ENVIRONMENT},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            pass_fds=[theirs.fileno()],
            start_new_session=True,
        )
        theirs.close()
        self._asked = False

    def zygote(self):
        """Return a socket to a new zygote, and its process id.

        Raises
        ------
        ConnectionError
            Where this process is gone.
        """
        self._asked = True
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
        with theirs:
            socket.send_fds(self._control, [b"{}"], [theirs.fileno()])
        answer = self._control.recv(1 << 16)
        if not answer:
            raise ConnectionError("the process that loads for all sessions ended")
        return ours, json.loads(answer)["process"]

    def processor(self):
        """Return the processor time of this process, its zygotes and their sessions [s], once all zygotes' sockets are closed."""
        if not self._asked:
            return 0.0
        self._control.send(b"{}")
        return json.loads(self._control.recv(1 << 16) or '{"processor": 0.0}')["processor"]

    def close(self):
        """Wait until its zygotes have ended, as each does with its socket, and it with them."""
        self._control.close()
        if not self._asked:
            self._process.kill()
        self._process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
