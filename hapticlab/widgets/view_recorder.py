"""What is recorded in a live view, and played again."""

import numpy as np

from ..device.live_parameters import named_values

#: a recording ends by itself after so many samples
LONGEST = 600_000


class Recorder:
    """Samples from one moment on, every one of them.

    Parameters
    ----------
    source : Stepping or Streaming
        Where they come from.
    """

    def __init__(self, source):
        self._source, self._values = source, named_values(source.program)
        self._rows, self._changes, self.samples = [], [], 0

    @property
    def full(self):
        return self.samples >= LONGEST

    def add(self, samples):
        """Take samples, a dict of arrays."""
        self._rows.append(samples)
        self.samples += len(samples["t"])

    def changed(self, t, numbers):
        """Note parameters that hold from the time t on [s]."""
        self._changes.append((t, dict(numbers)))

    def log(self):
        """Return the Telemetry."""
        rows = {name: np.concatenate([some[name] for some in self._rows]) for name in self._rows[0]}
        if "intent" in rows and np.isnan(rows["intent"]).all():
            del rows["intent"]
        return self._source.telemetry(rows, values=self._values, changes=self._changes)


class Replay:
    """A log, played by the clock.

    Parameters
    ----------
    log : Telemetry
    speed : float
    now : float
        The clock [s].
    """

    def __init__(self, log, speed, now):
        self.parameters = dict(log.parameters)
        self._columns = {name: np.asarray(getattr(log, name), float) for name in log.columns}
        self._columns.setdefault("intent", np.full(len(log), np.nan))
        for since, name, value in ((t, name, value) for t, numbers in log.changes for name, value in numbers.items()):
            if name not in log.columns:  # a parameter that was changed is a column
                column = self._columns.setdefault(name, np.full(len(log), self.parameters.get(name, np.nan)))
                column[log.t >= since - log.T / 2] = value
        self._speed, self._begun, self._seen, self._shown = speed, now, now, 0

    @property
    def done(self):
        return self._shown >= len(self._columns["t"])

    def pass_at(self, speed, now):
        """Play on at another speed."""
        self._begun = now - (now - self._begun) * self._speed / speed
        self._speed = speed

    def go_on(self, now):
        """Play on from here: what passed since the last look is not made up for."""
        self._begun += now - self._seen
        self._seen = now

    def take(self, now):
        """Return the samples since the last look, with parameters that were changed meanwhile; or None."""
        t, self._seen = self._columns["t"], now
        until = int(np.searchsorted(t - t[0], (now - self._begun) * self._speed, side="right"))
        if until <= self._shown:
            return None
        some = {name: column[self._shown : until] for name, column in self._columns.items()}
        self._shown = until
        return some
