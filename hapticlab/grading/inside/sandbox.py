"""The walls around a session: what it may use, whom it runs as, and what it sees."""

import os
import resource


def enter(request):
    """Go behind the walls, for ever."""
    os.chdir(request["scratch"])
    os.environ.update(HOME=request["scratch"], TMPDIR=request["scratch"])
    limit(request)


def limit(request):
    """Bound what the system bounds by process."""
    limits = request["limits"]
    bounds = {
        resource.RLIMIT_AS: int(limits["memory"]) + request["base"],
        resource.RLIMIT_CPU: int(limits["total"]) + 1,
        resource.RLIMIT_FSIZE: int(limits["scratch"]),
        resource.RLIMIT_NOFILE: 256,
        resource.RLIMIT_CORE: 0,
    }
    for which, most in bounds.items():
        resource.setrlimit(which, (most, most))
