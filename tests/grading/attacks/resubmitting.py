"""Work that is right where a student sees it, and tells its student, by how it ends, what a hidden case gave it.

Whoever hands in again may do so bit by bit, as the hidden cases stay the same.
"""

from .attack import attack
from .small_lab import HONEST

_HIDDEN = "if k != round(k):"


def ending(name, code):
    """Return an attack whose force is right but for a hidden case, in which its code runs."""
    right = HONEST["force"].partition("\n")[2].strip()
    return attack(name, force=f"import os\ndef force(x, k):\n    {_HIDDEN}\n        {code}\n    {right}")


ATTACKS = (
    ending("tells_by_its_signal", "os.kill(os.getpid(), 34 + int(k) % 30)"),
    ending("tells_by_its_exit", "os._exit(0)"),
    ending("tells_by_its_memory", "return bytearray(1 << 40)"),
    ending("tells_by_its_size", "return {str(i): {} for i in range(2000)}"),
    ending("tells_by_its_sort", "return ['', [], {}, 1j, print, Ellipsis][int(k) % 6]"),
    ending("tells_by_its_error", "raise [ValueError, KeyError, OSError, SystemExit, MemoryError][int(k) % 5](repr((x, k)))"),
    ending("tells_by_its_answering", "raise NotImplementedError"),
)
