"""Messages under way from one paddle to the other: late by a chosen delay, a jitter and losses that are drawn with a seed."""

import heapq
from itertools import count

import numpy as np


class Relay:
    """One direction of the link.

    Parameters
    ----------
    delay, jitter : float
        Each message is late by delay, and by up to jitter more, in whatever unit the clock has that is given below.
    loss : float
        Part of the messages that never arrive, 0 ... 1.
    seed : sequence of int

    Examples
    --------
    >>> relay = Relay(delay=2, jitter=0, loss=0.0, seed=[0])
    >>> relay.send({"beat": 1.0}, now=0)
    >>> relay.arrived(now=1), relay.arrived(now=2)
    (None, {'beat': 1.0})
    """

    def __init__(self, delay, jitter, loss, seed):
        self.delay, self.jitter, self.loss, self._draw = delay, jitter, loss, np.random.default_rng(seed)
        self._under_way, self._order, self._newest = [], count(), -1

    def send(self, message, now):
        """Take a message; one that is lost is forgotten here."""
        number = next(self._order)
        late, dropped = self._draw.random(2)
        if dropped >= self.loss:
            heapq.heappush(self._under_way, (now + self.delay + late * self.jitter, number, message))

    def arrived(self, now):
        """Return the newest message that has arrived, or None; one that a newer one has overtaken is forgotten."""
        found = None
        while self._under_way and self._under_way[0][0] <= now:
            _, number, message = heapq.heappop(self._under_way)
            if number > self._newest:
                self._newest, found = number, message
        return found
