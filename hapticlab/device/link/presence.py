"""Whether this program ran all the time: to a board, a laptop that slept or a process that was stopped is a silent host."""

import time
from contextlib import suppress

from .messages import HOST_SILENCE_MS

#: s; a board that has heard nothing for so long has switched its motor off
LONGEST_PAUSE = HOST_SILENCE_MS / 1000


def _clocks():
    """Clocks of the system that go on while the computer sleeps, best first; Linux stops its CLOCK_MONOTONIC then."""
    for name in ("CLOCK_BOOTTIME", "CLOCK_MONOTONIC"):
        with suppress(AttributeError, OSError):  # the second in a browser, which has a number for it and no such clock
            time.clock_gettime(getattr(time, name))
            yield getattr(time, name)


_CLOCKS = [*_clocks()]


def sleepless():
    """A time [s] that only grows, also while the computer sleeps."""
    return time.clock_gettime(_CLOCKS[0]) if _CLOCKS else time.monotonic()  # Windows' monotonic clock does not stop


class Presence:
    """Notices pauses, as long as somebody calls :meth:`note` again and again.

    Parameters
    ----------
    clock : callable
        Gives a time [s]; it is the attribute ``now``.

    Examples
    --------
    >>> from hapticlab.device.link.presence import Presence
    >>> instants = iter([0.0, 0.01, 7.5, 7.51])
    >>> presence = Presence(lambda: next(instants))
    >>> presence.note(), presence.note()
    (None, None)
    >>> presence.absent()
    7.49
    """

    def __init__(self, clock=sleepless):
        self.now, self._longest = clock, 0.0
        self._last = clock()

    def note(self):
        """Say that the program runs now."""
        now = self.now()
        if now - self._last > LONGEST_PAUSE:
            self._longest = max(self._longest, now - self._last)
        self._last = now

    def end(self):
        """Nobody calls note any more."""
        self._last = float("inf")

    def absent(self):
        """Return the longest time for which the program did not run [s], 0 where it always did."""
        since = self.now() - self._last
        return round(max(self._longest, since if since > LONGEST_PAUSE else 0.0), 3)

    def forget(self):
        """Begin anew."""
        self._longest, self._last = 0.0, self.now()
