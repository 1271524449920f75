"""What a bench found: rows of predicted beside found, and one report of them, to read and as data."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ...base.shows_itself import ShowsItself

VERDICTS = ("as predicted", "differs", "found", "skipped")
MEANS = (
    "A board ceases to be untried when this report is whole, no row differs or is skipped, and a person with a hand on the "
    "switch was there. The report speaks of this board, this wiring and this image: after a change of one of them, measure "
    "again. Stop times in ticks are the board's own account of its motor's pins; an oscilloscope at the driver's input is the "
    "independent one."
)
REHEARSAL = "A simulated board: this is a rehearsal, and says nothing of a real one."


@dataclass(frozen=True)
class Finding:
    """One quantity: predicted low ... high with its source, and found.

    Attributes
    ----------
    step, quantity, unit : str
    found : float, str or None
        None where the step was skipped; ``note`` then says why.
    low, high : float or None
        What was predicted; None where nothing was, or where words were.
    source : str
        Of the prediction.
    verdict : str
        One of VERDICTS.
    note : str

    Examples
    --------
    >>> Finding.of("host silent", "stop time", 0.101, "s", 0.1, 0.102, "HOST_SILENCE_MS of messages.py").verdict
    'as predicted'
    """

    step: str
    quantity: str
    unit: str = ""
    found: float | str | None = None
    low: float | None = None
    high: float | None = None
    source: str = ""
    verdict: str = "found"
    note: str = ""

    @classmethod
    def of(
        cls, step: str, quantity: str, found: float, unit: str, low: float, high: float, source: str, note: str = ""
    ) -> Finding:
        """Compare a number with an interval; a number that is not finite differs from everything."""
        fits = math.isfinite(found) and low <= found <= high
        return cls(step, quantity, unit, found, low, high, source, "as predicted" if fits else "differs", note)

    @classmethod
    def seen(cls, step: str, quantity: str, good: bool, said: str, source: str) -> Finding:
        """What a person saw, or a board said, in words."""
        return cls(step, quantity, "", said, None, None, source, "as predicted" if good else "differs")

    @classmethod
    def skipped(cls, step: str, why: str) -> Finding:
        """A step that was not done, and why."""
        return cls(step, "the whole step", verdict="skipped", note=why)

    @property
    def predicted(self) -> str:
        """The interval in words; empty where nothing was predicted."""
        if self.low is None or self.high is None:
            return ""
        if self.high == math.inf:
            return f"{self.low:.4g} {self.unit} or more"
        return f"{self.low:.4g} to {self.high:.4g} {self.unit}" if self.low else f"{self.high:.4g} {self.unit} at most"

    def __str__(self) -> str:
        found = self.note if self.found is None else self._found()
        return f"{self.verdict:<13} {self.step}: {self.quantity}: {found}" + (f" ({self.predicted})" if self.predicted else "")

    def row(self) -> str:
        """A row of the report's table."""
        note = f" ({self.note})" if self.note and self.found is not None else ""
        found = self.note if self.found is None else self._found() + note
        cells = (self.step, self.quantity, self.predicted, found, self.verdict, self.source)
        return "| " + " | ".join(" ".join(cell.split()).replace("|", "\\|") for cell in cells) + " |"

    def _found(self):
        return f"{self.found} {self.unit}".strip() if isinstance(self.found, str) else f"{self.found:.4g} {self.unit}"


@dataclass(frozen=True)
class BenchReport(ShowsItself):
    """What a bench found, in order; ``save`` writes it to read and as data. It names no person, and no computer.

    Attributes
    ----------
    about : dict
        Versions, board, image, settings, reset cause, by name.
    findings : tuple of Finding
    ended : str
        "whole", or the step at which it ended early and why.
    """

    about: dict[str, Any]
    findings: tuple[Finding, ...]
    ended: str

    @property
    def is_whole(self) -> bool:
        """Whether every step was done and found as predicted."""
        return self.ended == "whole" and not any(f.verdict in ("skipped", "differs") for f in self.findings)

    @property
    def sentence(self) -> str:
        """How many findings there are of each kind, and whether the board is tried."""
        counts = {verdict: sum(f.verdict == verdict for f in self.findings) for verdict in VERDICTS}
        words = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count) or "nothing was measured"
        early = "" if self.ended == "whole" else f"PARTIAL: {self.ended}. "
        tried = REHEARSAL if self.about["simulated"] else f"The board is {'tried' if self.is_whole else 'still untried'}."
        return f"{early}{words}. {tried}"

    def __getitem__(self, place: tuple[str, str]) -> Finding:
        """Return the finding of a (step, quantity)."""
        return {(f.step, f.quantity): f for f in self.findings}[place]

    def save(self, path: str | Path) -> tuple[Path, Path]:
        """Write FILE.md and FILE.json; return both paths."""
        page, data = Path(path).with_suffix(".md"), Path(path).with_suffix(".json")
        page.write_text(self.page(), "utf-8")
        rows = [{k: _plain(v) for k, v in asdict(f).items()} for f in self.findings]
        facts = {"about": self.about, "ended": self.ended, "whole": self.is_whole, "findings": rows}
        data.write_text(json.dumps(facts, indent=1, allow_nan=False) + "\n", "utf-8")
        return page, data

    def page(self) -> str:
        """Return the report as Markdown."""
        head = [f"# Bench report of paddle {self.about['paddle']}", "", f"**{self.sentence}**", "", MEANS, "", "## About", ""]
        facts = [f"* {name}: {value}" for name, value in self.about.items() if not name.startswith("settings")]
        kept = ["", "```text", *self.about.get("settings", "none").splitlines(), "```"]
        table = ["", "## Predicted and found", "", "| step | quantity | predicted | found | verdict | prediction from |"]
        rows = ["| --- | --- | --- | --- | --- | --- |", *(f.row() for f in self.findings)]
        return "\n".join([*head, *facts, *kept, *table, *rows]) + "\n"

    def _sentence(self):
        return self.sentence

    def __str__(self) -> str:
        return "\n".join([*map(str, self.findings), self.sentence])


def _plain(value):
    """JSON has no infinity."""
    return None if isinstance(value, float) and not math.isfinite(value) else value
