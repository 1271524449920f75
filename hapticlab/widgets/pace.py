"""Ticks that are due by the clock, counted from where it began so that nothing drifts; and cells that take the time of turns."""

import math
from collections import deque

#: at most so much of the clock is made up for at once [s]; what is more is dropped, and told
LONGEST = 0.05
#: one turn may compute for so long [s], that inputs and pictures go on where the computer is slow
WORK = 0.02
#: what was dropped is told for so long [s]
TOLD = 1.0
#: a turn that comes so late waited for a cell that computed [s]
COMPUTED = 1.0
#: where turns come in time, but a page was not heard for so long, a cell awaits [s]
QUIET = 1.5
#: a turn later than that, or one that took longer itself, kept the page's words waiting [s]
IN_TIME = 0.3


class Pace:
    """How many ticks are due.

    Parameters
    ----------
    T : float
        Period [s].
    speed : float
        Scene time over the clock's time.

    Examples
    --------
    >>> pace = Pace(1e-3)
    >>> pace.start(7.0)
    >>> pace.due(7.0165), pace.due(7.0175), pace.due(7.3)    # 233 ms late: 50 are made up for
    (16, 1, 50)
    >>> round(pace.behind(7.3), 4)
    0.233
    """

    def __init__(self, T, speed=1.0):
        self.T, self.speed = T, speed
        self._dropped, self._cost = deque(), 0.0
        self.start(0.0)

    def start(self, now):
        """Count from here on [s]."""
        self._begun, self._done = now, 0

    def pass_at(self, speed):
        """Go on at another speed from the last tick that was due."""
        self._begun += self._done * self.T / self.speed
        self._done, self.speed = 0, speed

    def due(self, now):
        """Return the ticks to do now."""
        wanted = int((now - self._begun) * self.speed / self.T + 1e-6) - self._done
        most = LONGEST * self.speed / self.T
        if self._cost:
            most = min(most, WORK / self._cost)
        most = max(1, int(most + 1e-6))
        if wanted > most:
            late = (wanted - most) * self.T / self.speed
            self._begun += late
            self._dropped.append((now, late))
            wanted = most
        self._done += max(wanted, 0)
        return max(wanted, 0)

    def spent(self, ticks, seconds):
        """Note how long ticks took to compute."""
        if ticks:
            self._cost += 0.2 * (seconds / ticks - self._cost)

    def behind(self, now):
        """Time of the clock that was dropped within the last second [s]."""
        while self._dropped and self._dropped[0][0] < now - TOLD:
            self._dropped.popleft()
        return sum(late for _, late in self._dropped)


class CellsBetween:
    """Cells that run between the turns of a view, where both take turns in one thread: told by turns, and by a page's words.

    Examples
    --------
    >>> cells = CellsBetween()
    >>> cells.turn_begins(10.0, heard=10.0)    # how long a cell computed before it, and whether one awaits
    (0.0, False)
    >>> cells.turn_ended(10.0)
    >>> cells.turn_begins(15.0, heard=10.0)
    (5.0, False)
    """

    def __init__(self):
        self._began = self._ended = math.inf  # of the last turn
        self._in_time = -math.inf  # since when turns come in time

    def turn_begins(self, now, heard):
        """Return for how long a cell computed since the last turn [s], or 0, and whether one awaits.

        Parameters
        ----------
        now, heard : float
            Now, and when the page was heard last [s].
        """
        late, before, self._began = now - self._ended, self._began, now
        if now - before > IN_TIME:
            self._in_time = now
        return late if late > COMPUTED else 0.0, now - max(heard, self._in_time) > QUIET

    def turn_ended(self, now):
        """Note when the turn ended [s]; infinity where no other is due."""
        self._ended = now
