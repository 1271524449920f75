"""Work that goes on beside the cells of a notebook: in a thread, or on the event loop where there are no threads.

The work is a generator: it does a turn whenever it is asked to go on, and yields how long to wait for the next one [s]. So
the same work runs in both forms. On an event loop a turn comes only while nothing else computes: a cell that awaits lets
turns through, a cell that computes does not.
"""

import math
import threading
import time

from ..base.in_notebook import is_in_browser


def has_threads():
    """Whether this Python starts threads; in a browser it does not."""
    return not is_in_browser()


def begin(turns, name):
    """Start work that takes turns until it ends, and return it.

    Parameters
    ----------
    turns : generator
        Yields the time to the next turn [s]; 0 lets others go first.
    name : str

    Returns
    -------
    InThread or OnLoop
        With ``wake``, ``is_current``, ``is_alive`` and ``join``.

    Examples
    --------
    >>> done = []
    >>> def counting():
    ...     for k in range(3):
    ...         done.append(k)
    ...         yield 0.0
    >>> begin(counting(), "count to three").join(5), done
    (True, [0, 1, 2])
    """
    work = (InThread if has_threads() else OnLoop)(turns, name)
    work.start()
    return work


class InThread(threading.Thread):
    """Turns in a thread of their own, which does not keep the program from ending."""

    def __init__(self, turns, name):
        super().__init__(name=name, daemon=True)
        self._turns, self._woken = turns, threading.Event()

    def run(self):
        for seconds in self._turns:
            if seconds > 0:
                self._woken.wait(seconds)
            self._woken.clear()

    def wake(self):
        """End the wait for the next turn, from whatever thread."""
        self._woken.set()

    def is_current(self):
        """Whether one of these turns asks."""
        return threading.current_thread() is self

    def join(self, timeout=None):
        """Wait until the work has ended; return whether it has within so many seconds."""
        super().join(timeout)
        return not self.is_alive()


class OnLoop:
    """Turns as a task of the event loop that runs; every method is called from the thread of that loop."""

    def __init__(self, turns, name):
        self._turns, self._name = turns, name

    def start(self):
        """Let the first turn come when the loop is free."""
        import asyncio

        self._woken = asyncio.Event()
        # kept, since a loop has only weak references to its tasks
        self._task = asyncio.get_running_loop().create_task(self._run(), name=self._name)

    async def _run(self):
        import asyncio  # where it is needed: it takes longer to import than all else here

        loop = asyncio.get_running_loop()
        try:
            for seconds in self._turns:
                if seconds > 0:
                    timer = loop.call_later(seconds, self._woken.set)
                    await self._woken.wait()
                    timer.cancel()
                else:
                    await asyncio.sleep(0)
                self._woken.clear()
        finally:  # also where a loop ends before its tasks: what the turns hold, such as a motor, is let go
            self._turns.close()

    def wake(self):
        """End the wait for the next turn."""
        self._woken.set()

    def is_current(self):
        """Whether one of these turns asks."""
        return self._turns.gi_running

    def is_alive(self):
        """Whether there are turns to come."""
        return self._turns.gi_frame is not None

    def join(self, timeout=None):
        """Do the turns that are left, for nobody else can; return whether the work has ended within so many seconds."""
        until = math.inf if timeout is None else time.monotonic() + timeout
        while self.is_alive() and time.monotonic() < until:
            time.sleep(min(max(next(self._turns, 0.0), 0.0), max(until - time.monotonic(), 0.0)))
        return not self.is_alive()
