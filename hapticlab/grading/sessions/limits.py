"""What a submission may use: time, memory, processes, files and output."""

import math
from dataclasses import dataclass

from ...errors import CourseError

MIB = 1 << 20


@dataclass(frozen=True)
class Limits:
    """Bounds on one submission, all enforced from outside its processes.

    Parameters
    ----------
    seconds : float
        Of one step, which is a cell, or an exercise's cases: its processor time, or the wall clock without what it waited for
        a processor that others had, whichever is more [s]. On macOS and Windows it is the wall clock.
    total : float
        Of a whole submission, counted alike [s].
    memory : int
        Of all its processes together, looked at 20 times a second; on Linux also what a process may reserve at all [bytes].
    processes : int
        At one time. On Linux one can start no other, and no program.
    scratch, files : int
        What it may write to files [bytes], and how many files and folders.
    answer : int
        Of the plain values of one exercise, as JSON [bytes].
    printed : int
        Characters kept of what an exercise prints.

    Examples
    --------
    >>> Limits(seconds=2.5).total
    120.0
    >>> Limits(seconds=0)
    Traceback (most recent call last):
        ...
    hapticlab.errors.CourseError: seconds = 0; a limit needs a finite number > 0
    """

    seconds: float = 10.0
    total: float = 120.0
    memory: int = 1024 * MIB
    processes: int = 1
    scratch: int = 64 * MIB
    files: int = 10_000
    answer: int = 32 * MIB
    printed: int = 4096

    def __post_init__(self):
        for name, value in vars(self).items():
            if isinstance(value, bool) or not isinstance(value, int | float) or not (math.isfinite(value) and value > 0):
                raise CourseError(f"{name} = {value!r}; a limit needs a finite number > 0")
