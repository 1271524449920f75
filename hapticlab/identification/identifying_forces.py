"""Forces that make a free handle tell its constants: a kick and coasting, steps, a chirp, each within a stated travel."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import sympy as sp

from ..errors import AnalysisError
from ..measurement.leash import leashed
from ..scene.laws.chapter_laws import virtual_damper
from ..scene.notation.parameters import parameters
from ..scene.notation.symbols import n, when, x
from ..scene.scene import Scene
from .held_force_motion import positions

if TYPE_CHECKING:
    from ..base.annotations import Array

#: samples of rest before a force begins
LEAD = 20
#: of steps: where the force changes, in steps' lengths, and by how much, in its size; it ends at rest where it began
CHANGES = ((0, 1), (1, -2), (3, 2), (5, -2), (7, 2), (8, -1))
#: of a chirp: last frequency over first, and swings of the first
SWEEP, SWINGS = 8.0, 6.0
#: of the travel that the motion may fill, as the constants known so far tell it
FILLS = 0.6
#: samples that a kick, a step, or a chirp's first swing lasts
SHORTEST, LONGEST_PART = 4, 400
#: a coasting handle rests after so many of b and friction's times, at most this many samples
LONGEST = 4000


@dataclass(frozen=True)
class Excitation:
    """A force over samples: ``kind`` is "kick", "steps" or "chirp", ``size`` [N], ``length`` [samples] of its first part.

    Examples
    --------
    >>> Excitation("steps", 0.2, 10, 120).forces(1e-3)[[19, 20, 30, 49, 50, 99, 100]].tolist()
    [0.0, 0.2, -0.2, -0.2, 0.2, 0.2, 0.0]
    """

    kind: Literal["kick", "steps", "chirp"]
    size: float
    length: int
    samples: int

    def forces(self, T: float) -> Array:
        """The force at each sample, without the guard of :meth:`scene` [N]."""
        at = np.arange(self.samples) - LEAD
        if self.kind == "chirp":
            return np.where(at >= 0, self.size * np.cos(self._phase(np.maximum(at, 0))), 0.0)
        return self.size * sum(by * (at >= start * self.length) for start, by in self._changes())

    def scene(self, travel: float) -> Scene:
        """A scene whose force is this, and ends for good further than ``travel`` [m] from where the handle began."""
        A = parameters("A", units="N", values=self.size)
        at = n - LEAD
        if self.kind == "chirp":
            force = when(at >= 0, A * sp.cos(self._phase(at, sp.Float)), 0)
        else:
            force = A * sp.Add(*(when(at >= start * self.length, by, 0) for start, by in self._changes()))
        return leashed(Scene(force, name=self.kind), travel)

    def _changes(self):
        return ((0, 1), (1, -1)) if self.kind == "kick" else CHANGES

    def _phase(self, at, number=float):
        """The angle of a chirp: ``length`` samples are its first period, SWEEP times as fast at the end."""
        rate = 2 * np.pi / self.length
        bend = rate * (SWEEP - 1) / (2 * (self.samples - LEAD))
        return at * (number(rate) + number(bend) * at)


def designed(kind, size, T, travel, constants):
    """The longest excitation of a size [N] whose motion fills FILLS of +-travel [m], by the constants known so far.

    A handle that coasts too far even after the shortest kick gets half the size, and so on.

    Raises
    ------
    AnalysisError
        If no force above friction keeps within the travel.
    """
    lengths = np.unique(np.geomspace(SHORTEST, LONGEST_PART, 60).astype(int))

    def made(length):
        return Excitation(kind, size, int(length), _samples(kind, int(length), size, T, constants))

    def leaves(length):
        moved = positions(made(length).forces(T), T, push=0.0, x0=0.0, v0=0.0, scale=1.0, **constants)
        return bool(np.abs(moved).max() > FILLS * travel)

    fitting = bisect_left(lengths, True, key=leaves)  # longer ones move the handle further
    if fitting:
        return made(lengths[fitting - 1])
    if size / 2 <= constants["coulomb"]:
        raise AnalysisError(
            f"{kind} of {size:g} N: {SHORTEST} samples of {T:g} s already move the handle beyond {1e3 * FILLS * travel:.3g} "
            "mm, and half the force is below friction. Give a smaller T or a larger travel="
        )
    return designed(kind, size / 2, T, travel, constants)


def _samples(kind, length, size, T, constants):
    """Samples of an excitation: steps end, a chirp has its swings, a kicked handle comes to rest."""
    if kind == "steps":
        return LEAD + 8 * length + LEAD
    if kind == "chirp":
        return LEAD + int(SWINGS * length)
    m, b, coulomb = (max(constants[name], 0.0) for name in ("m", "b", "coulomb"))
    speed = max(size - coulomb, 0.0) * length * T / m
    slows = b / m + coulomb / (m * speed) if speed else 1.0
    return LEAD + length + int(min(5 / max(slows * T, 1e-9), LONGEST))


def centring(stiffness, damping):
    """A scene that leads the handle back to the middle."""
    K = parameters("K", units="N/m", values=stiffness)
    damper = virtual_damper()(B=damping)
    return Scene(K * x(n) + damper.force, name="centring", values=damper.values)
