"""A design as plain data: what may be chosen, and why a choice is none."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...compiler.methods.method_table import METHODS
from ...compiler.tick.handle_samples import HOLDS
from ...scene.laws.taps import SPRING_LAWS
from .task import PERIOD_STEP

if TYPE_CHECKING:
    from .task import Task

#: the words that a design may choose from
WORDS = {
    "method": (*METHODS, "exact", "taylor"),
    "hold": tuple(HOLDS),
    "law": tuple(SPRING_LAWS),
    "velocity": ("backward", "filtered", "window", "kalman"),
}
#: the shortest and the longest period [s], most substeps, the longest filter [s]
SHORTEST, LONGEST, MOST_SUBSTEPS, SLOWEST = 2.5e-4, 1e-2, 8, 0.05
#: characters of a strange word that are told again
TOLD = 30


@dataclass(frozen=True)
class Design:
    """One way to render a task; only the names that the task takes have a meaning.

    Attributes
    ----------
    T : float
        Period [s].
    method, hold : str
    substeps : int
    law, velocity : str
    tau : float
        Time constant of a filtered velocity [s].
    """

    T: float
    method: str = "semi_implicit_euler"
    substeps: int = 1
    hold: str = "soh"
    law: str = "zoh"
    velocity: str = "backward"
    tau: float = 0.0


class NoDesign(ValueError):
    """Why plain data is no design, in a sentence."""


def design_of(task: Task, given: Any) -> Design:
    """Return the Design that plain data names; NoDesign says exactly what is wrong with it.

    Examples
    --------
    >>> import hapticlab as hl
    >>> design_of(hl.design.task("mass"), {"method": "rk4", "hold": "soh", "T": 2e-3}).T
    0.002
    """
    if not isinstance(given, Mapping):
        raise NoDesign(f"a design is a dict of names and values, such as {{'T': 0.001, ...}}; this is {_kind(given)}")
    needed = [name for name in task.takes if name not in ("substeps", "tau")]
    for name in given:
        if name not in task.takes:
            raise NoDesign(f"{str(name)[:TOLD]!r} is not chosen in the task {task.name}; its names are {', '.join(task.takes)}")
    for name in needed:
        if name not in given:
            raise NoDesign(f"{name} is missing; a design of the task {task.name} gives {', '.join(needed)}")
    found = Design(**{name: _word(name, value) if name in WORDS else _number(name, value) for name, value in given.items()})
    if found.velocity == "filtered" and not 0 < found.tau <= SLOWEST:
        raise NoDesign(f"tau = {found.tau:g} s; a filtered velocity needs 0 < tau <= {SLOWEST:g} s")
    return found


def _word(name, value):
    if not isinstance(value, str) or value not in WORDS[name]:
        told = repr(str(value)[:TOLD]) if isinstance(value, str) else _kind(value)
        raise NoDesign(f"{name} is {told}; it needs one of {', '.join(map(repr, WORDS[name]))}")
    return str.__str__(value)


def _number(name, value):
    """Return a number in its range, or raise NoDesign: T a whole number of PERIOD_STEP, substeps a whole number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise NoDesign(f"{name} is {_kind(value)}; it needs a number")
    number = float(value) if abs(value) < 1e300 else math.inf
    if not math.isfinite(number):
        raise NoDesign(f"{name} is not a finite number; it needs one")
    if name == "substeps":
        if number not in range(1, MOST_SUBSTEPS + 1):
            raise NoDesign(f"substeps = {number:g}; it needs a whole number from 1 to {MOST_SUBSTEPS}")
        return int(number)
    if name == "T":
        whole = round(number / PERIOD_STEP)
        if not SHORTEST - 1e-12 <= number <= LONGEST + 1e-12 or abs(whole * PERIOD_STEP - number) > 1e-9:
            raise NoDesign(
                f"T = {number:g} s; it needs a whole number of {1e3 * PERIOD_STEP:g} ms from {1e3 * SHORTEST:g} to "
                f"{1e3 * LONGEST:g} ms, in seconds: 1 ms is 0.001"
            )
        return whole * PERIOD_STEP
    return number


def _kind(value):
    kinds = {bool: "True or False", str: "a text", dict: "a dict", list: "a list", type(None): "None"}
    return kinds.get(type(value), "a number" if isinstance(value, int | float) else f"an object of {type(value).__name__[:TOLD]}")
