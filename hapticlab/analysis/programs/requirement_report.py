"""The report of what a scene requires, as text and as a table for a notebook."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...base.grid import Grid
from ...base.shows_itself import ShowsItself
from ...compiler.ir.program import Program
from ...scene.scene import Scene

#: kind of a row that is part of the one above it
PART = "of these"


@dataclass(frozen=True)
class Item(ShowsItself):
    """One thing that is kept, left out or offered.

    Attributes
    ----------
    kind : str
        state, signal, parameter, mode, pair, velocity, linear, view; :data:`PART` of a row above, which its savings are in;
        shared, what makes the rows add up
    name : str
    why : str
    saves : int or None
        Instructions a tick, as the difference of two compiled programs; None where nothing is saved.
    """

    kind: str
    name: str
    why: str
    saves: int | None = None


@dataclass(frozen=True)
class Requirements(ShowsItself):
    """What a scene requires of a board; printing it says what was left out, why, and what it saves.

    Attributes
    ----------
    program : Program
        As compiled.
    kept, dropped, offered : tuple of Item
        ``dropped`` is left out of the program already; ``offered`` asks for a word of the user.
    everything : int
        Instructions with nothing left out: every parameter live, every state and every mode kept.
    felt : Scene
        What the board has to run: without the islands that only feed a view.
    view : Scene or None
        Those islands, for :func:`~hapticlab.analysis.programs.replay.replay`.
    made_of : str
        What the states of the program are.
    declined : str or None
        Why ``method="exact"`` is not offered.
    """

    program: Program = field(repr=False)
    kept: tuple[Item, ...]
    dropped: tuple[Item, ...]
    offered: tuple[Item, ...]
    everything: int
    felt: Scene = field(repr=False)
    view: Scene | None = field(repr=False)
    made_of: str = ""
    declined: str | None = None

    def _groups(self):
        yield "kept", "", self.kept
        yield "left out", "saves", self.dropped
        yield "offered", "saves", self.offered

    def _tables(self):
        yield from ((title, Grid.of(group, "name", "kind", "saves", "why")) for title, _, group in self._groups())

    @property
    def _head(self):
        p = self.program
        method = f", {p.facts['method']}" if "method" in p.facts else ""
        states = f"{len(p.states)} states" + (f" ({self.made_of})" if p.states else "")
        return (
            f"{p.name} at T = {p.T:g} s{method}: {len(p)} instructions per tick and {states}; "
            f"{self.everything} with nothing left out"
        )

    @property
    def _declined(self):
        nothing = "" if self.offered else "offered: nothing; "
        return [f"{nothing}exact is not offered: {self.declined}"] if self.declined else []

    def __str__(self) -> str:
        lines = [self._head]
        items = [i for _, _, group in self._groups() for i in group]
        wide = max([len(i.name) for i in items], default=0)
        for title, column, group in self._groups():
            if group:
                lines.append(f"{title:<{wide + 14}} {column:>6}")
                for i in group:
                    saves = "" if i.saves is None else f"{i.saves:>6}"
                    lines.append(f"  {i.name:<{wide}}  {i.kind:<10}{saves:>6}  {i.why}")
        return "\n".join([*lines, *self._declined])
