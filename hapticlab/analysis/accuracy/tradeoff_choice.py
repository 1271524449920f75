"""Choose from a trade-off the least load that is good enough, or say what to relax."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...base.shows_itself import ShowsItself
from ...errors import AnalysisError
from .tradeoff_rows import NOT_TRIED, REFUSED, TOO_LARGE, UNSURE, Row, percent

#: a margin of stability from which a setting is chosen; from 1 to 2 it may still be unstable where a scene is not linear
MARGIN = 2.0
#: steps that a contact takes at least where its instants are not located
STEPS_PER_CONTACT = 10.0
#: measured times that differ by less are the same
NOISE = 1.2
#: part of the greatest force up to which an encoder's own error raises the tolerance
COARSEST = 0.1


@dataclass(frozen=True)
class Configuration(ShowsItself):
    """What was chosen: ``hl.compile(scene, **configuration.options)``.

    Attributes
    ----------
    row : Row
    options : dict
        Of :func:`hapticlab.compile`.
    tolerance : float
        What the error was compared with: what was asked, or half the sensor's floor where that is more.
    notes : tuple of str
        What was raised, and what is not known.
    """

    row: Row
    options: dict[str, Any]
    tolerance: float
    notes: tuple[str, ...] = ()

    def facts(self) -> dict[str, Any]:
        """The choice as a dictionary for JSON."""
        row = self.row
        told = {name: getattr(row, name) for name in ("err_max", "err_hold", "load")}
        told |= {"tolerance": self.tolerance, "notes": list(self.notes)}
        return {"feasible": True, "options": {**self.options, "live": _listed(self.options["live"])}, **told}

    def __str__(self) -> str:
        row = self.row
        given = ", ".join(f"{name}={value!r}" for name, value in self.options.items())
        lines = [
            f"{row.target}: {row.name}: error {percent(row.err_max)} at the samples, allowed {percent(self.tolerance)}; "
            f"held over the period {percent(row.err_hold)}; load {percent(row.load)}"
        ]
        return "\n".join([*lines, f"  hl.compile(scene, {given})", *(f"  {note}" for note in self.notes)])


@dataclass(frozen=True)
class NotFeasible(ShowsItself):
    """Nothing meets what was asked; false where a truth is asked of it.

    Attributes
    ----------
    target : str
    nearest : Row or None
        What misses least; None where nothing ran.
    relax : tuple of str
        Single changes that are enough, each; else all that the nearest misses.
    """

    target: str
    nearest: Row | None
    relax: tuple[str, ...]

    def __bool__(self) -> bool:
        return False

    def facts(self) -> dict[str, Any]:
        """The shortfall as a dictionary for JSON."""
        return {"feasible": False, "nearest": self.nearest and self.nearest.name, "relax": list(self.relax)}

    def __str__(self) -> str:
        near = f"; nearest is {self.nearest.name}" if self.nearest else ""
        return "\n".join(
            [f"{self.target}: no configuration meets the requirements{near}", *(f"  {words}" for words in self.relax)]
        )


@dataclass(frozen=True)
class Asked:
    """What a configuration has to meet; ``held`` is the error of the force held over each period, None for any."""

    tolerance: float
    load: float
    passive: bool
    margin: float = MARGIN
    held: float | None = None

    def __post_init__(self) -> None:
        for name in ("tolerance", "load", "margin", "held"):
            given = getattr(self, name)
            if given is not None and not given > 0:
                raise AnalysisError(f"{name} = {given}; needs a number > 0, such as {name}={2 if name == 'margin' else 0.1}")

    def allowed(self, row):
        """Return the error that is allowed of a row: no sensor is worth more than half its own error, up to COARSEST."""
        sensor = row.sensor_floor / 2
        return max(self.tolerance, min(sensor, COARSEST)) if math.isfinite(sensor) else self.tolerance

    def excess(self, row):
        """Return by which factor a row misses each thing, in the order of importance; without what it meets."""
        found = {
            "margin": 0.0 if row.margin is None else _ratio(self.margin, row.margin),
            "contact": STEPS_PER_CONTACT / row.steps_per_contact if row.steps_per_contact else 0.0,
            "passive": _ratio(row.b_req, row.b_device) if self.passive and row.passive is False else 0.0,
            "encoder": row.sensor_floor / 2 / max(COARSEST, self.tolerance),
            "doubt": row.doubt / self.allowed(row),
            "tolerance": (row.err_max + (row.doubt if row.doubt < self.allowed(row) else 0.0)) / self.allowed(row),
            "held": row.err_hold / self.held if self.held else 0.0,
            "load": max(row.load / self.load, 1.001 if row.status == TOO_LARGE else 0.0),
        }
        return {name: factor for name, factor in found.items() if factor > 1}


def _listed(live):
    return live if live is None or isinstance(live, str) else [str(one) for one in live]


def _ratio(needed, there):
    return needed / there if there else math.inf


def chosen(rows, target, asked, options_of):
    """Return the Configuration of least load among the rows of a target, or NotFeasible.

    Parameters
    ----------
    rows : sequence of Row
        Of every target: another one may do.
    target : str
    asked : Asked
    options_of : callable ``(row) -> dict``
        Of :func:`hapticlab.compile`.
    """
    ran = [row for row in rows if row.ran]
    good = [row for row in ran if not asked.excess(row)]
    here = [row for row in good if row.target == target]
    if here:
        row = _least(here)
        return Configuration(row, options_of(row), asked.allowed(row), tuple(_notes(row, asked)))
    mine = [row for row in ran if row.target == target]
    if not mine:
        return NotFeasible(target, None, tuple(_reasons([row for row in rows if row.target == target])))
    nearest = min(mine, key=lambda row: (len(asked.excess(row)), sum(map(math.log, asked.excess(row).values()))))
    relax = [*_single(mine, asked), *_elsewhere(good)]
    return NotFeasible(target, nearest, tuple(relax or _each(nearest, asked)))


def _least(rows):
    """Return the row of least load; of times that were measured, those within NOISE of it go by their error."""
    row = min(rows, key=lambda row: (row.load, row.err_max))
    if row.cycles is not None:
        return row
    return min((one for one in rows if one.load <= NOISE * row.load), key=lambda one: one.err_max)


def _reasons(rows):
    """Return why nothing ran: what those did that were tried; of what cannot be compiled only where there is nothing else."""
    tried = [row for row in rows if row.status not in (REFUSED, NOT_TRIED)]
    return dict.fromkeys(row.why for row in tried or rows if row.why)


def _notes(row, asked):
    if asked.allowed(row) > asked.tolerance:
        yield (
            f"tolerance raised from {percent(asked.tolerance)} to {percent(asked.allowed(row))}: half the error that the "
            f"encoder alone causes, {percent(row.sensor_floor)}"
        )
    if row.passive is None and asked.passive:
        yield "passivity is not known"
    if row.margin is None:
        yield "the margin of stability is not known"
    if row.b_where and asked.passive:
        yield f"passive for small motions only, because the scene is not linear; it needs the most damping at {row.b_where}"
    if row.status.name in UNSURE:
        yield f"{row.status}: {row.why}"


def _single(rows, asked):
    """Yield for each thing the least change of it alone that is enough."""
    best = {}
    for row in rows:
        excess = asked.excess(row)
        if len(excess) == 1:
            ((name, factor),) = excess.items()
            if name not in best or factor < best[name][0]:
                best[name] = factor, row
    for name, (_, row) in best.items():
        yield f"{_words(name, row, asked)}: {row.name}"


def _elsewhere(good):
    """Yield the targets that do it, each with its least load."""
    for target in dict.fromkeys(row.target for row in good):
        row = min((row for row in good if row.target == target), key=lambda row: row.load)
        yield f"another board: {target} needs {percent(row.load)} of the period with {row.name}"


def _each(row, asked):
    return ["all of these together:", *(f"  {_words(name, row, asked)}" for name in asked.excess(row))]


def _words(name, row, asked):
    """Say what to relax, and to what, for a row to pass."""
    if name == "tolerance":
        return f"tolerance {percent(row.err_max + row.doubt)} instead of {percent(asked.allowed(row))}"
    if name == "held":
        return f"held error {percent(row.err_hold)} instead of {percent(asked.held)}, or a shorter T (try it)"
    if name == "encoder":
        return f"a finer encoder: this one alone causes an error of {percent(row.sensor_floor)} of the greatest force"
    if name == "doubt":
        apart = "only one of the two solved it" if row.doubt == math.inf else f"they differ by {percent(row.doubt)}"
        return f"other motions, on which the two solvers of the reference agree; here {apart}, so no error is certain"
    if name == "load":
        longer = f"T = {row.T * row.load / asked.load * 1e3:.3g} ms or longer (try it)"
        if row.status == TOO_LARGE or not row.load < math.inf:
            return row.why or "a board that can run it"
        return f"load {percent(row.load)} instead of {percent(asked.load)}, or {longer}"
    if name == "passive":
        if row.b_req == math.inf:
            return "damping in the scene itself, because no device has enough, or passive=False (then not stable in every hand)"
        part = f", or its stiffness, damping and mass all times {row.b_device / row.b_req:.2g}" if row.b_device else ""
        asks = f"a device with b >= {row.b_req:.3g} N s/m (this one has {row.b_device:.3g} N s/m)"
        return f"{asks}{part}, or passive=False (then not stable in every hand)"
    if name == "margin":
        if not row.margin:
            return "a different method, because with this one every step is too long"
        softer = f"stiffness {(row.margin / asked.margin) ** 2:.2g} times as large"
        return f"margin {row.margin:.2g} instead of {asked.margin:g}, or {softer}"
    return f"contacts that last {STEPS_PER_CONTACT / row.steps_per_contact:.2g} times as long, softer or heavier"
