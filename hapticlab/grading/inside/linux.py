"""System calls that Python 3.11 does not have; numbers and flags as in the man pages named, of section 2."""

import ctypes
import os
import struct
import sys

# unshare(2)
NEWNS, NEWUTS, NEWIPC, NEWUSER, NEWPID, NEWNET = 0x20000, 0x4000000, 0x8000000, 0x10000000, 0x20000000, 0x40000000
# mount(2), umount2(2)
NOSUID, NODEV, NOEXEC, BIND, RECURSIVE, PRIVATE, DETACH = 2, 4, 8, 4096, 16384, 1 << 18, 2
# mount_setattr(2)
MOUNT_SETATTR, AT_FDCWD, AT_RECURSIVE, ATTR_RDONLY, ATTR_NOSUID, ATTR_NODEV = 442, -100, 0x8000, 1, 2, 4
# prctl(2)
SET_PDEATHSIG, SET_SECCOMP, CAPBSET_DROP, SET_CHILD_SUBREAPER, SET_NO_NEW_PRIVS = 1, 22, 24, 36, 38
CAPABILITY_VERSION_3 = 0x20080522  # capget(2)
# landlock(7), numbers of its calls from asm-generic/unistd.h, flags from linux/landlock.h
LANDLOCK_CREATE, LANDLOCK_ADD, LANDLOCK_RESTRICT = 444, 445, 446
EXECUTE, WRITE_FILE, READ_FILE, READ_DIR, REFER, TRUNCATE, IOCTL = 1, 2, 4, 8, 1 << 13, 1 << 14, 1 << 15
OF_FILES = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | IOCTL

_libc = ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None


def _call(function, *arguments):
    """Result of a function of the C library; OSError where it is -1."""
    converted = [a.encode() if isinstance(a, str) else ctypes.c_long(a) if isinstance(a, int) else a for a in arguments]
    found = getattr(_libc, function)(*converted)
    if found == -1:
        code = ctypes.get_errno()
        raise OSError(code, f"{function}: {os.strerror(code)}")
    return found


def unshare(flags):
    """Leave the namespaces named for new ones; for NEWPID, the children do."""
    _call("unshare", flags)


def mount(source, target, kind=None, flags=0, options=None):
    """Mount a file system, or with BIND a folder or file at a second place."""
    try:
        _call("mount", source, target, kind, flags, options)
    except OSError as problem:
        raise OSError(problem.errno, f"{problem.strerror} ({target})") from None


def make_read_only(target, recursive=True):
    """Make a mount, and all below it, read-only, without devices and without setuid; needs Linux 5.12."""
    attributes = (ctypes.c_uint64 * 4)(ATTR_RDONLY | ATTR_NOSUID | ATTR_NODEV)
    how = AT_RECURSIVE if recursive else 0
    _call("syscall", MOUNT_SETATTR, AT_FDCWD, target, how, ctypes.byref(attributes), ctypes.sizeof(attributes))


def move_root(new):
    """Make a mount the root of all paths, and let go of the old root; pivot_root(2), "pivot_root(".", ".")"."""
    os.chdir(new)
    _call("pivot_root", ".", ".")
    _call("umount2", ".", DETACH)
    os.chdir("/")


def become_subreaper():
    """Let orphans among the descendants become children of this process."""
    _call("prctl", SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def die_with_parent():
    """Be killed where the parent ends; a change of the user forgets it."""
    _call("prctl", SET_PDEATHSIG, 9, 0, 0, 0)


def drop_privileges():
    """Give up every capability, and every way to gain one, here and in all children, for ever."""
    _call("prctl", SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    for capability in range(64):
        try:
            _call("prctl", CAPBSET_DROP, capability, 0, 0, 0)
        except OSError:
            break  # past the last one, or none held to drop it with
    header = (ctypes.c_uint32 * 2)(CAPABILITY_VERSION_3, 0)
    _call("capset", ctypes.byref(header), ctypes.byref((ctypes.c_uint32 * 6)()))


def filter_calls(program):
    """Have the kernel ask a BPF program before each system call; needs no_new_privs.

    Parameters
    ----------
    program : bytes
        Of struct sock_filter, 8 bytes an instruction.
    """

    class Program(ctypes.Structure):  # struct sock_fprog, seccomp(2)
        _fields_ = [("length", ctypes.c_ushort), ("filter", ctypes.c_char_p)]

    _call("prctl", SET_SECCOMP, 2, ctypes.byref(Program(len(program) // 8, program)), 0, 0)


def landlock_version():
    """Version of the kernel's Landlock: 0 where there is none, 1 since Linux 5.13."""
    return max(0, _libc.syscall(LANDLOCK_CREATE, None, ctypes.c_long(0), 1)) if _libc else 0


def keep_to(readable, writable):
    """Have the kernel refuse this process every file but these, for ever; needs no_new_privs and Landlock.

    From version 6 on also signals and abstract sockets to processes outside.

    Parameters
    ----------
    readable, writable : sequence of str
        Files, or folders with all that is in them; what a link leads to is not meant.
    """
    version = landlock_version()
    handled = (1 << 13) - 1 | (REFER if version >= 2 else 0) | (TRUNCATE if version >= 3 else 0) | (IOCTL if version >= 5 else 0)
    net, scoped = (3 if version >= 4 else 0), (3 if version >= 6 else 0)
    size = 24 if version >= 6 else 16 if version >= 4 else 8
    ruleset = _call("syscall", LANDLOCK_CREATE, ctypes.byref((ctypes.c_uint64 * 3)(handled, net, scoped)), size, 0)
    for paths, access in ((readable, READ_FILE | READ_DIR), (writable, handled & ~EXECUTE)):
        for path in paths:
            if os.path.islink(path):
                continue
            try:
                place = os.open(path, os.O_PATH | os.O_CLOEXEC)
            except OSError:  # nor can this process read it
                continue
            allowed = access if os.path.isdir(path) else access & OF_FILES
            rule = struct.pack("=Qi", allowed, place)
            _call("syscall", LANDLOCK_ADD, ruleset, 1, ctypes.c_char_p(rule), 0)
            os.close(place)
    _call("syscall", LANDLOCK_RESTRICT, ruleset, 0)
    os.close(ruleset)


def close_all_but(*kept):
    """Close every file descriptor but these."""
    low = 0
    for descriptor in sorted(kept):
        if low < descriptor:  # closerange(0, 0) closes all
            os.closerange(low, descriptor)
        low = descriptor + 1
    os.closerange(low, 1 << 20)
