"""What an answer gave for one case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Outcome:
    """What an answer gave for one case: a plain value; or why there is none, in words; or nothing, where unanswered.

    Beside a value ``problem`` is a remark, told where the value is wrong. ``printed`` is what its code printed meanwhile.
    """

    value: Any = None
    problem: str = ""
    printed: str = ""

    @property
    def answered(self) -> bool:
        """Whether anything was answered at all."""
        return self.value is not None or bool(self.problem)
