"""Work for the latest value only: while one is under way, newer ones replace each other, and no queue piles up."""

import threading

from ..device.turns import begin


class Latest:
    """A function run beside everything else, for the newest value asked for.

    Parameters
    ----------
    work : callable
        Of one value; its exceptions go to ``failed``.
    failed : callable
        Of an exception.

    Examples
    --------
    >>> done = []
    >>> latest = Latest(done.append, print)
    >>> latest.ask(7)
    >>> latest.wait(5)
    True
    >>> done
    [7]
    """

    def __init__(self, work, failed):
        self._work, self._failed = work, failed
        self._wanted, self._turns = [], None
        self._door = threading.Lock()

    def ask(self, value):
        """Ask for a value; one that is waiting to be worked on is dropped."""
        with self._door:
            self._wanted = [value]
            if self._turns is None:
                self._turns = begin(self._work_off(), "hapticlab picture")

    def wait(self, timeout=None):
        """Wait until nothing is left to do; return whether that came to pass in time [s]."""
        turns = self._turns
        return turns is None or turns.join(timeout)

    def _work_off(self):
        while True:
            with self._door:
                if not self._wanted:
                    self._turns = None
                    return
                value = self._wanted.pop()
            try:
                self._work(value)
            except Exception as error:  # shown where the sliders are; nobody else can be told
                self._failed(error)
            yield 0.0
