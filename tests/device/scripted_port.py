"""A port in virtual time whose far end is a script, for tests of the link."""


class ScriptedPort:
    """Reads wait in virtual time; subclasses say in ``write`` what comes back, by adding to ``heard``."""

    lockstep, port, is_open, timeout = True, "script://", True, 0.01

    def __init__(self):
        self.time, self.heard = 0.0, b""

    def now(self):
        return self.time

    @property
    def in_waiting(self):
        return len(self.heard)

    def read(self, size):
        self.time += 0 if self.heard else self.timeout
        data, self.heard = self.heard[:size], self.heard[size:]
        return data
