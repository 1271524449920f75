"""What a result says where it is asked for an attribute that it does not have: the one that was meant."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any, ClassVar


class Guessed:
    """A result whose wrong attributes name the right ones; ``MEANT`` has the words that people try."""

    MEANT: ClassVar[dict[str, str]] = {}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        known = [one for one in dir(self) if not one.startswith("_") and one != "MEANT"]
        near = [self.MEANT[name]] if name in self.MEANT else get_close_matches(name, known, 1)
        meant = f"take .{near[0]}; " if near else ""
        raise AttributeError(f"{type(self).__name__} has no {name}; {meant}it has {', '.join(known)}")
