"""Work for the latest value only: while one is under way, newer ones replace each other, and no queue piles up."""

import threading


class Latest:
    """A function run in a thread, for the newest value asked for.

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
        self._wanted, self._busy = [], False
        self._changed = threading.Condition()

    def ask(self, value):
        """Ask for a value; one that is waiting to be worked on is dropped."""
        with self._changed:
            self._wanted = [value]
            if not self._busy:
                self._busy = True
                threading.Thread(target=self._loop, daemon=True).start()

    def wait(self, timeout=None):
        """Wait until nothing is left to do; return whether that came to pass in time [s]."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._busy, timeout)

    def _loop(self):
        while True:
            with self._changed:
                if not self._wanted:
                    self._busy = False
                    self._changed.notify_all()
                    return
                value = self._wanted.pop()
            try:
                self._work(value)
            except Exception as error:  # shown where the sliders are; a thread has nobody else to tell
                self._failed(error)
