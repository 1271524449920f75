"""What a tick asks of a device at each operating point: sampled over a travel, told where it asks for the most."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...base.shows_itself import ShowsItself
from ...compiler.methods.step_matrix import rising
from ...errors import AnalysisError
from ...limits.port import POINTS, negative, required, static_stiffness, unstable_pole
from .linearization import motion_at
from .operating_points import TRAVEL, borders, kind_of, operating_points, probes_of, telling

if TYPE_CHECKING:
    from ...base.annotations import Array

#: why a mode asks for what it asks, unless it is worse
WORST = "worst frequency"
#: a force jumps that differs by more than this part of itself, and this many newtons
JUMP = 1e-6


@dataclass(frozen=True, eq=False)
class PortLimit(ShowsItself):
    """One operating point in one mode.

    Attributes
    ----------
    mode, point : str
        The conditions that hold, and where that was looked at.
    b_req : float
        Least damping of a device [N s/m] with which the sampled scene is passive; inf where none is enough, nan where
        the scene falls from there by itself, or pushes the handle away ever more: negative stiffness.
    floor : float
        What the force asks for that follows the handle alone, its bodies held [N s/m]: k T/2 + b of a spring and a damper.
    frequency : float
        Where b_req is asked for [Hz].
    reason : str
    stiffness : float
        Force per displacement at rest [N/m]. Negative with a finite b_req: a hand has to hold the handle there, else it
        moves on to where it is stiff.
    """

    mode: str
    point: str
    b_req: float
    floor: float
    frequency: float
    reason: str
    tick: tuple[Array, ...] = field(repr=False)
    stiffness: float = 0.0


class Looked:
    """Where a switched scene is looked at for its passivity, and how it moves there by itself."""

    def __init__(self, known, at=None, T=1e-3, travel=TRAVEL):
        self.known, self.travel = known, travel if at is None else None
        self.points = operating_points(known, at, T, self.travel)
        self.probes, self.borders = probes_of(self.points), borders(known, self.points, T)
        self.all = [*self.points, *self.probes, *(p for pair, _ in self.borders for p in pair)]
        self.slopes, _ = motion_at(known, self.points, T)
        self.alone = not known.form.coordinates and not known.form.updates

    def limits(self, forces, ticks, handle, T, delay=0.0, frequencies=POINTS):
        """Return (limits, kind): a :class:`PortLimit` of every point that tells something.

        ``forces``, ``ticks`` and ``handle`` are those of
        :func:`~hapticlab.analysis.stability.linearization.forces_and_ticks_at`, at ``all`` points.
        """
        flat = [np.concatenate([np.ravel(part) for part in tick]) for tick in ticks]
        P, found = len(self.points), {}
        whole = [np.isfinite(one).all() and np.isfinite(J).all() for one, J in zip(flat, self.slopes, strict=False)]
        clear = [k for k, p in enumerate(self.points) if whole[k] or not p.sampled]
        kind = kind_of(self.known, [self.points[k] for k in clear], self.probes, [*(flat[k] for k in clear), *flat[P:]])
        stiff = np.array([static_stiffness(*tick) if ok else np.nan for tick, ok in zip(ticks, whole, strict=False)])
        for k in self._closer([one if ok else one * np.nan for one, ok in zip(flat, whole, strict=False)], ticks, stiff):
            p = self.points[k]
            mode = self.known.named(p.mode)
            if not whole[k]:
                raise AnalysisError(
                    f"the force has no finite slope at {p.words}, {mode}. Give positions where it has one, at={{...}}"
                )
            caught = not stiff[k] < 0 or self._is_caught(k, stiff, forces[:P], kind)
            tells = (ticks[k], self.slopes[k], T, delay, handle, frequencies)
            found[k] = PortLimit(mode, p.words, *_asked(*tells, stiff[k], caught), ticks[k], float(stiff[k]))
        return (*self._told(found), *self._jumps(forces, ticks)), kind

    def _closer(self, flat, ticks, stiff):
        """Return the numbers of points that may ask for the most."""
        if not self.alone:
            return telling(self.points, flat)
        kept = [k for k, p in enumerate(self.points) if not p.sampled]
        for mode in dict.fromkeys(p.mode for p in self.points):  # the steepest place of such a force asks for the most
            those = [k for k, p in enumerate(self.points) if p.sampled and p.mode == mode and np.isfinite(flat[k]).all()]
            kept += [min(those, key=stiff.__getitem__), max(those, key=lambda k: ticks[k][3])] if those else []
        kept = sorted(set(kept))
        return [kept[k] for k in telling([self.points[k] for k in kept], [flat[k] for k in kept])]

    def _is_caught(self, k, stiff, forces, kind):
        """Tell whether a handle that negative stiffness drives away comes to where it is stiff, within its travel.

        A spring F(x), sampled and held, is passive with T/2 times its steepest slope as long as its potential has a bottom:
        where F' < 0 the energy criterion asks for nothing, and from the top of a detent or of a buckling beam a handle only
        moves to its next rest. Without a bottom energy comes out for ever.
        """
        if kind == "linear":
            return False
        own = self.points[k].values["x"]
        beyond = [p.values["x"] - own for p, one in zip(self.points, stiff, strict=True) if one > 0]
        if not self.alone:  # bodies would have moved, too: small motions tell no more than that it is stiff somewhere
            return kind == "small-signal" and bool(beyond)
        pushed = -np.sign(forces[k]) * (abs(forces[k]) > JUMP * np.nanmax(np.abs(forces)))
        sides = (pushed,) if pushed else (-1.0, 1.0)
        end = max(abs(p.values["x"]) for p in self.points)
        # of the last tenth of a travel nothing is known beyond: a ripple goes on there
        return bool(beyond) and all(own * side > 0.9 * end or any(far * side > 0 for far in beyond) for side in sides)

    def _told(self, found):
        """Return the limits, of sampled places in a mode those alone that ask for the most, or are softest below zero."""
        told = {k: one for k, one in found.items() if not self.points[k].sampled}
        for mode in dict.fromkeys(p.mode for p in self.points):
            those = [k for k in found if self.points[k].mode == mode]
            if those:
                most, softest = max(those, key=lambda k: _rank(found[k])), min(those, key=lambda k: found[k].stiffness)
                told |= {k: found[k] for k in (most, softest) if k == most or found[k].stiffness < 0}
        return [told[k] for k in sorted(told)]

    def _jumps(self, forces, ticks):
        """Return a limit for every surface on whose sides the force differs: of a slope without bound.

        Where it drops as x grows, as on the rim of a groove, a late sample takes energy out, as where F' < 0.
        """
        found, first = [], len(self.points) + len(self.probes)
        for k, ((one, other), by_x) in enumerate(self.borders):
            low, high = forces[first + 2 * k : first + 2 * k + 2]
            jump = high - low if by_x else abs(high - low)
            if jump > JUMP * max(abs(low), abs(high), 1.0):
                words = f"{self.known.named(one.mode)} | {self.known.named(other.mode)}"
                reason = f"the force jumps by {abs(high - low):.4g} N, so its slope has no bound and no damping is enough"
                found.append(PortLimit(words, one.words, np.inf, np.inf, 0.0, reason, ticks[first + 2 * k]))
        return found


def _rank(limit):
    return np.isnan(limit.b_req), limit.b_req


def _asked(tick, J, T, delay, handle, frequencies, stiffness, caught):
    """Return (b_req, floor, frequency, reason) of one tick map; ``handle`` are the states that remember the handle alone."""
    A, B, C, D = tick
    held = np.ix_(handle, handle)
    floor = required(A[held], B[handle], C[handle], D, T, delay, frequencies)[0]
    falls = int(rising(J)) if len(J) else 0
    pole = unstable_pole(A, B, C, falls)
    if pole is not None:
        return np.inf, floor, 0.0, f"unstable with the handle held, a pole at {pole:.6g}"
    if falls and unstable_pole(A, B, C) is not None:
        return np.nan, floor, 0.0, "moves away by itself, so no motion near it is passive"
    if not caught:
        return np.nan, floor, 0.0, negative(stiffness)
    b_req, theta = required(A, B, C, D, T, delay, frequencies)
    reason = "a resonance without damping" if np.isinf(b_req) else WORST
    if stiffness < 0:
        reason = f"locally active, {stiffness:.4g} N/m: a free handle moves away to where the scene is stiff"
    return b_req, floor, theta / (2 * np.pi * T), reason
