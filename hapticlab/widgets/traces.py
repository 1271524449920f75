"""From samples as they come to the rows that a front end draws, the energy among them, and the recent second."""

from collections import deque

import numpy as np

from .frame import COLUMNS, THINNED

#: how much is kept in full to say what goes on [s]
RECENT = 1.0
#: what a row can hold: a scene may go beyond
LARGEST = float(np.finfo(np.float32).max)


def rows_apart(T):
    """Return the time between two rows of a frame [s], for a sample every T [s]."""
    return T * max(1, int(np.ceil(THINNED / T - 1e-9)))


class Traces:
    """The rows of frames.

    The energy drawn from the environment is minus the work on it, force and displacement paired as they acted, Fig. 23.6:
    what :func:`hapticlab.energy` gives of the whole record.

    Parameters
    ----------
    T : float
        Time between two samples [s].
    watched : sequence of str
        Channels that have a column after those of every scene.

    Examples
    --------
    >>> traces = Traces(1e-3)
    >>> t, x = np.arange(4) * 1e-3, np.array([0.0, 0.002, 0.0, -0.001])
    >>> traces.add({"t": t, "x": x, "F": np.array([0.0, 0.2, 0.0, 0.0])})[::2, 3].tolist()
    [0.0, 0.00039999998989515007]
    """

    def __init__(self, T, watched=()):
        self.T, self._watched = T, tuple(watched)
        self._step = round(rows_apart(T) / T)
        self._energy, self._last, self._count = 0.0, None, 0
        self._recent, self._length = deque(), 0

    def add(self, samples, contact=None):
        """Take samples, a dict of arrays as a Telemetry names them; return their rows, thinned, as a Frame has them.

        contact: 1 or 0 of each, or nan; None in a scene where nothing can be touched.
        """
        x, F = samples["x"], samples["F"]
        contact = np.full(len(x), np.nan) if contact is None else contact
        first = -self._count % self._step
        known = {"x_true": x, "F_applied": F, "x_switch": samples.get("x_true", x), **samples}
        known |= {"E": self._drawn(samples), "contact": contact}
        found = [*map(known.get, COLUMNS), *map(samples.get, self._watched)]
        rows = np.full((len(range(first, len(x), self._step)), len(found)), np.nan, np.float32)
        for k, column in enumerate(found):
            if column is not None:
                rows[:, k] = np.clip(column[first :: self._step], -LARGEST, LARGEST)
        self._count += len(x)
        self._keep(x, F, contact)
        return rows

    def recent(self):
        """Return x [m], F [N] and the contact, 1 or 0 or nan, of the last second."""
        if not self._recent:
            return np.zeros(0), np.zeros(0), np.zeros(0)
        return tuple(np.concatenate(part) for part in zip(*self._recent, strict=True))

    def _keep(self, x, F, contact):
        self._recent.append((x, F, contact))
        self._length += len(x)
        while self._length - len(self._recent[0][0]) >= RECENT / self.T:
            self._length -= len(self._recent.popleft()[0])

    def _drawn(self, samples):
        """Return the energy drawn from the environment at each sample [J]."""
        x = samples.get("x_true", samples["x"]).astype(float)
        held = samples.get("F_applied", samples["F"]).astype(float)
        switch = samples.get("x_switch")
        switch = x if switch is None else switch
        last = self._last or {"x": x[0], "held": held[0], "before": 0.0, "switch": switch[0]}
        places = np.concatenate(([last["x"]], x))
        forces = np.concatenate(([last["before"], last["held"]], held))
        at = np.concatenate(([last["switch"]], switch[:-1]))
        work = forces[:-2] * (at - places[:-1]) + forces[1:-1] * (places[1:] - at)
        if self._last is None:
            work[0] = 0.0
        found = self._energy - np.cumsum(work)
        self._energy = float(found[-1])
        self._last = {"x": x[-1], "held": held[-1], "before": forces[-2], "switch": switch[-1]}
        return found
