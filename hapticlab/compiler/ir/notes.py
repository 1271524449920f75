"""Notes of a program: sentences that print as they are, and whose class says what they are about.

>>> note = ParameterNote("k", "at most 400 N/m")
>>> print(note); note.parameter
k: at most 400 N/m
'k'
"""

from __future__ import annotations

from collections.abc import Iterable


class UnstableNote(str):
    """Why the steps of a program are unstable with the values that are bound."""

    why: str

    def __new__(cls, why: str) -> UnstableNote:
        self = super().__new__(cls, f"unstable as bound: {why}")
        self.why = why
        return self

    def __getnewargs__(self) -> tuple[str]:
        return (self.why,)


class UndefinedForceNote(str):
    """Where the force of a program is not a number: ``where`` completes the sentence."""

    where: str

    def __new__(cls, where: str) -> UndefinedForceNote:
        self = super().__new__(cls, f"F is nan where {where}")
        self.where = where
        return self

    def __getnewargs__(self) -> tuple[str]:
        return (self.where,)


class ParameterNote(str):
    """What holds for one parameter, such as why it is a constant."""

    parameter: str
    words: str

    def __new__(cls, parameter: str, words: str) -> ParameterNote:
        self = super().__new__(cls, f"{parameter}: {words}")
        self.parameter, self.words = parameter, words
        return self

    def __getnewargs__(self) -> tuple[str, str]:  # type: ignore[override]
        return self.parameter, self.words


def why_of(notes: Iterable[str], parameter: str) -> str:
    """What the first note on a parameter says, in brackets and with a blank before; "" where there is none."""
    return next((f" ({note})" for note in notes if isinstance(note, ParameterNote) and note.parameter == parameter), "")
