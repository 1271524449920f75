"""A format of marks: one record, which the command line, the pages and the tests read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

#: words for a person, JSON of all reports, a table for a spreadsheet, the JSON of one submission that its student reads
Kind = Literal["words", "json", "table", "result"]
KINDS: tuple[Kind, ...] = get_args(Kind)


@dataclass(frozen=True)
class Format:
    """A way to write reports; a module of this folder lists its own in ``FORMATS``.

    Attributes
    ----------
    name : str
        As ``--format`` has it.
    write : callable
        ``write(reports, roster, assignment)`` gives the text.
    kind : {"words", "json", "table", "result"}
        Tests ask of a table that no cell is a formula, and of a result that it tells no number of a hidden case.
    needs_roster : bool
        The system knows students by its own ids.
    folder_is_assignment : bool
        Where no assignment is named, the folder of the lab names it.
    """

    name: str
    write: Callable[..., str]
    kind: Kind
    needs_roster: bool = False
    folder_is_assignment: bool = False

    @property
    def rank(self) -> tuple[bool, int, str]:
        """Place in lists: those without a roster first, then by kind."""
        return self.needs_roster, KINDS.index(self.kind), self.name
