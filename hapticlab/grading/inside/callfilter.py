"""The system calls that an answer needs; the kernel refuses every other one.

Files, memory, threads, time and the process itself. Not among them: other processes and programs, sockets to anybody else,
timers that send signals, pipes spliced into each other, memory that no process seems to hold, other views of the system, and
whatever a later kernel adds.

Numbers on x86_64 and aarch64 from the kernel's asm/unistd_64.h and asm-generic/unistd.h; struct seccomp_data and the BPF
instructions from linux/seccomp.h and linux/filter.h.
"""

import errno
import platform
import struct

#: calls that are allowed whatever their arguments are
ALLOWED = {
    # open files
    "read": (0, 63), "write": (1, 64), "readv": (19, 65), "writev": (20, 66), "pread64": (17, 67), "pwrite64": (18, 68),
    "preadv": (295, 69), "pwritev": (296, 70), "lseek": (8, 62), "close": (3, 57), "close_range": (436, 436),
    "fstat": (5, 80), "ftruncate": (77, 46), "fallocate": (285, 47), "fsync": (74, 82), "fdatasync": (75, 83),
    "dup": (32, 23), "dup2": (33, None), "dup3": (292, 24),
    "copy_file_range": (326, 285), "fstatfs": (138, 44), "fgetxattr": (193, 10), "flistxattr": (196, 13),
    "fchmod": (91, 52), "fchdir": (81, 50), "getdents": (78, None), "getdents64": (217, 61),
    # files by their paths
    "open": (2, None), "openat": (257, 56), "stat": (4, None), "lstat": (6, None), "newfstatat": (262, 79),
    "statx": (332, 291), "access": (21, None), "faccessat": (269, 48), "faccessat2": (439, 439), "getcwd": (79, 17),
    "chdir": (80, 49), "mkdir": (83, None), "mkdirat": (258, 34), "rmdir": (84, None), "unlink": (87, None),
    "unlinkat": (263, 35), "rename": (82, None), "renameat": (264, 38), "renameat2": (316, 276), "readlink": (89, None),
    "readlinkat": (267, 78), "chmod": (90, None), "fchmodat": (268, 53), "umask": (95, 166), "truncate": (76, 45),
    "utimensat": (280, 88), "statfs": (137, 43), "getxattr": (191, 8), "lgetxattr": (192, 9), "listxattr": (194, 11),
    "llistxattr": (195, 12),
    # what an event loop waits with
    "pipe": (22, None), "pipe2": (293, 59), "eventfd2": (290, 19), "epoll_create1": (291, 20), "epoll_ctl": (233, 21),
    "epoll_wait": (232, None), "epoll_pwait": (281, 22), "epoll_pwait2": (441, 441), "poll": (7, None), "ppoll": (271, 73),
    "select": (23, None), "pselect6": (270, 72), "sendto": (44, 206), "recvfrom": (45, 207), "shutdown": (48, 210),
    "getsockname": (51, 204), "getsockopt": (55, 209),
    # memory and threads
    "munmap": (11, 215), "mprotect": (10, 226), "mremap": (25, 216), "madvise": (28, 233), "brk": (12, 214),
    "msync": (26, 227), "membarrier": (324, 283), "futex": (202, 98), "futex_waitv": (449, 449),
    "set_tid_address": (218, 96), "set_robust_list": (273, 99), "get_robust_list": (274, 100), "rseq": (334, 293),
    "arch_prctl": (158, None), "sched_yield": (24, 124), "sched_getaffinity": (204, 123), "getcpu": (309, 168),
    # the process itself
    "getpid": (39, 172), "gettid": (186, 178), "getppid": (110, 173), "getuid": (102, 174), "geteuid": (107, 175),
    "getgid": (104, 176), "getegid": (108, 177), "getresuid": (118, 148), "getresgid": (120, 150), "getgroups": (115, 158),
    "getpgrp": (111, None), "getpgid": (121, 155), "getsid": (124, 156), "getpriority": (140, 141), "exit": (60, 93),
    "exit_group": (231, 94), "getrlimit": (97, 163), "getrusage": (98, 165), "times": (100, 153), "sysinfo": (99, 179),
    "uname": (63, 160), "getrandom": (318, 278), "wait4": (61, 260), "waitid": (247, 95),
    # signals and time
    "rt_sigaction": (13, 134), "rt_sigprocmask": (14, 135), "rt_sigreturn": (15, 139), "rt_sigpending": (127, 136),
    "rt_sigtimedwait": (128, 137), "rt_sigsuspend": (130, 133), "sigaltstack": (131, 132), "pause": (34, None),
    "getitimer": (36, 102), "nanosleep": (35, 101),
    "clock_nanosleep": (230, 115), "clock_gettime": (228, 113), "clock_getres": (229, 114), "gettimeofday": (96, 169),
    "time": (201, None), "restart_syscall": (219, 128),
}  # fmt: skip
#: what starts processes and programs, allowed where a session may have more than one
PROCESSES = {
    "fork": (57, None), "vfork": (58, None), "execve": (59, 221), "setsid": (112, 157), "setpgid": (109, 154),
    "kill": (62, 129), "tgkill": (234, 131),
}  # fmt: skip
#: a clone that is a thread; one that makes namespaces
CLONE, THREAD, NEW_NAMESPACES = (56, 220), 0x10000, 0x7E020000
#: its flags are behind a pointer, which no filter reads; the C library then takes clone
CLONE3 = 435
#: shared memory without a file is still there when a process has let go of its pages, and no count of them finds it
MMAP, SHARED, ANONYMOUS = (9, 222), 1, 0x20
#: (numbers, which argument, values that are allowed); fcntl(2): no leases, locks and signals, no larger pipes; ioctl(2): what
#: open() asks; prctl(2): names of threads and of memory
BY_ARGUMENT = (
    ((72, 25), 1, (0, 1, 2, 3, 4, 1030)),
    ((16, 29), 1, (0x5401, 0x5413, 0x541B, 0x5421, 0x5450, 0x5451)),
    ((157, 167), 0, (15, 16, 0x53564D41)),
)
#: streams of AF_UNIX, with and without SOCK_NONBLOCK and SOCK_CLOEXEC: a datagram could be sent to somebody else
SOCKETPAIR, AF_UNIX, STREAMS = (53, 199), 1, (1, 0x801, 0x80001, 0x80801)
#: prlimit(2) where its third argument is no new limit
PRLIMIT = (302, 261)
#: calls after these came with kernels that this list does not know: a library that tries one takes an older one instead
LAST_KNOWN = 451
AUDIT_ARCH = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
X32 = 0x40000000
NUMBER, ARCHITECTURE, ARGUMENTS = 0, 4, 16
LOAD, EQUAL, AT_LEAST, ANY_BIT, RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
ALLOW, ERRNO = 0x7FFF0000, 0x00050000
REFUSE, UNKNOWN = (RETURN, 0, 0, ERRNO | errno.EPERM), (RETURN, 0, 0, ERRNO | errno.ENOSYS)
PASS = (RETURN, 0, 0, ALLOW)


def program(processes=False, machine=None):
    """Return the filter as BPF; empty on a machine whose numbers are not listed.

    Parameters
    ----------
    processes : bool
        Whether it may start other processes.
    machine : str, optional
        As ``platform.machine()`` names it.

    Examples
    --------
    >>> len(program(machine="x86_64")) % 8, program(machine="riscv64")
    (0, b'')
    """
    machine = machine or platform.machine()
    if machine not in AUDIT_ARCH:
        return b""
    column = list(AUDIT_ARCH).index(machine)
    code = [(LOAD, 0, 0, ARCHITECTURE), (EQUAL, 1, 0, AUDIT_ARCH[machine]), REFUSE]
    code += [(LOAD, 0, 0, NUMBER), (AT_LEAST, 0, 1, X32), REFUSE, (EQUAL, 0, 1, CLONE3), UNKNOWN]
    allowed = ALLOWED | (PROCESSES if processes else {})
    code += [step for n in allowed.values() if n[column] is not None for step in ((EQUAL, 0, 1, n[column]), PASS)]
    mask, when = (NEW_NAMESPACES, [REFUSE, PASS]) if processes else (THREAD, [PASS, REFUSE])
    code += _asked(CLONE[column], 0, [(ANY_BIT, 0, 1, mask), *when])
    code += _asked(MMAP[column], 3, [(ANY_BIT, 0, 2, ANONYMOUS), (ANY_BIT, 0, 1, SHARED), REFUSE, PASS])
    of_unix = [(EQUAL, 1, 0, AF_UNIX), REFUSE, (LOAD, 0, 0, ARGUMENTS + 8)]
    code += _asked(SOCKETPAIR[column], 0, [*of_unix, *_one_of(STREAMS)])
    other_half = [(EQUAL, 1, 0, 0), REFUSE, (LOAD, 0, 0, ARGUMENTS + 8 * 2 + 4)]
    code += _asked(PRLIMIT[column], 2, [*other_half, *_one_of((0,))])
    for numbers, which, values in BY_ARGUMENT:
        code += _asked(numbers[column], which, _one_of(values))
    code += [(AT_LEAST, 0, 1, LAST_KNOWN + 1), UNKNOWN, REFUSE]
    return b"".join(struct.pack("=HBBI", *instruction) for instruction in code)


def _asked(number, which, steps):
    """Instructions that decide on a call by one of its arguments; each path of them ends."""
    return [(EQUAL, 0, 1 + len(steps), number), (LOAD, 0, 0, ARGUMENTS + 8 * which), *steps]


def _one_of(values):
    """Instructions that allow a call where the value loaded is one of these, and else refuse it."""
    return [*(step for value in values for step in ((EQUAL, 0, 1, value), PASS)), REFUSE]
