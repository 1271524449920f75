"""What a check can find, and how it says so."""

from dataclasses import dataclass

#: from best to worst
OK, ATTENTION, FAULT = "ok", "attention", "fault"


class Attention(Exception):
    """Something is missing or slow here that hapticlab can do without."""


class Fault(Exception):
    """Something does not work here that should."""


@dataclass(frozen=True)
class Outcome:
    """What one check found: its name, what it shows, the state, the finding in words, and how long it took [s]."""

    name: str
    shows: str
    state: str
    found: str
    seconds: float = 0.0

    def __str__(self):
        return f"{self.state:<10} {self.name:<10} {self.found.splitlines()[0] if self.found else ''}"


def need(condition, words):
    """Raise Fault with these words unless the condition holds."""
    if not condition:
        raise Fault(words)
