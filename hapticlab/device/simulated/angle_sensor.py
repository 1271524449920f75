"""An angle sensor's reading, which repeats, and which takes a while to go from its last count back to its first."""

import math


class AngleSensor:
    """What a board reads of an angle sensor with an analog output, where the output's own way back is not infinitely fast.

    Parameters
    ----------
    wrap : int
        Counts after which the reading repeats.
    flight : float
        How long the reading takes from one end of its range to the other [s]; in between it is anywhere.

    Examples
    --------
    >>> sensor = AngleSensor(wrap=100, flight=1e-3)
    >>> [sensor.reading(counts, 1e-3 * k) for k, counts in enumerate((98, 101, 104))]   # it begins anew after two thirds
    [98, 66, 4]
    """

    def __init__(self, wrap, flight):
        self.wrap, self.flight = wrap, flight
        self._before, self._left, self._end = None, -math.inf, 0

    def reading(self, counts, t):
        """Return what is read at t [s] of a position in counts, 0 ... wrap - 1; t grows from call to call."""
        turn, place = divmod(counts, self.wrap)
        if self._before is not None:
            before, then = self._before
            last = before // self.wrap
            if turn != last:
                edge = self.wrap * max(turn, last)
                self._left = then + (edge - before) / (counts - before) * (t - then)
                self._end = self.wrap - 1 if turn > last else 0
        self._before = counts, t
        gone = t - self._left
        return place if gone >= self.flight else round(self._end + gone / self.flight * (place - self._end))
