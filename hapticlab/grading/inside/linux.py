"""System calls that Python 3.11 does not have; numbers and flags as in the man pages named, section 2."""

import ctypes
import os

PR_SET_DUMPABLE, PR_SET_NO_NEW_PRIVS, PR_SET_CHILD_SUBREAPER, PR_SET_PDEATHSIG = 4, 38, 36, 1  # prctl(2)

_libc = ctypes.CDLL(None, use_errno=True)


def _call(function, *arguments):
    """Call a function of the C library; raise OSError where it says -1."""
    converted = [a.encode() if isinstance(a, str) else ctypes.c_ulong(a) if isinstance(a, int) else a for a in arguments]
    if getattr(_libc, function)(*converted) == -1:
        code = ctypes.get_errno()
        raise OSError(code, f"{function}: {os.strerror(code)}")


def become_subreaper():
    """Let orphans among the descendants become children of this process."""
    _call("prctl", PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def forbid_dumps():
    """Forbid other processes of the user to trace this one and to read its memory."""
    _call("prctl", PR_SET_DUMPABLE, 0, 0, 0, 0)


def forbid_new_privileges():
    """Let no program gain privileges, such as by setuid, here and in all children, for ever."""
    _call("prctl", PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)


def close_all_but(*kept):
    """Close every file descriptor but these."""
    low = 0
    for descriptor in sorted(kept):
        os.closerange(low, descriptor)
        low = descriptor + 1
    os.closerange(low, 1 << 20)
