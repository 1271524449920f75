"""What a setting of a trade-off asks for to be stable and passive, from the program that was tried anyway."""

import functools
import math

import numpy as np

from ..compiler.exact import EXACT
from ..compiler.order import order_of
from ..compiler.step_matrix import rising
from ..errors import HapticlabError
from .linearization import motion_at, tick_at, tick_of
from .operating import operating_points
from .port import required, unstable_pole
from .step_limit import step_limit
from .switches import switched

#: frequencies looked at, twice; beside those around every pole they find what 1000 do, to 1e-7
POINTS = 150


class Limits:
    """Margins of steps and damping asked for, of all settings of one scene."""

    def __init__(self, scene):
        self.scene = scene

    @functools.cached_property
    def places(self):
        """The scene with its cases as switches, its operating points, and how many motions there grow by themselves."""
        known = switched(self.scene)
        points = operating_points(known)
        J, _ = motion_at(known, points, 1e-3)
        return known, points, [int(rising(one)) if len(one) else 0 for one in J]

    @functools.lru_cache(maxsize=64)  # noqa: B019  it lives as long as its bench
    def longest(self, method):
        """Return the longest stable step [s] of a method, and how long the shortest contact lasts [s]; None where not known."""
        T = 1e-3
        try:
            found = step_limit(self.scene, method, T=T)
        except HapticlabError:
            return None
        located = method in ("taylor", EXACT)
        return found.h_max, math.inf if located else found.steps_per_contact * T

    @functools.lru_cache(maxsize=256)  # noqa: B019
    def order(self, method, hold, force_at, velocity):
        """Return the order in T that is claimed for the error of the force; None where there is no error."""
        try:
            found = float(order_of(self.scene, method, hold=hold, velocity=velocity, force_at=force_at))
        except HapticlabError:
            return None
        return found if math.isfinite(found) else None

    def steps(self, setting):
        """Return (margin, steps in the shortest contact) of a setting, each None where it is not known."""
        found, h = self.longest(setting.method), setting.T / setting.substeps
        return (None, None) if found is None else (found[0] / h, found[1] / h)

    def damping(self, setting, program):
        """Return the damping of a device [N s/m] that a setting asks for; None where that cannot be told.

        Where the scene falls by itself, as a pole on a cart, no motion near it is passive.
        """
        try:
            known, points, rises = self.places
            if known.switches or len(program.inputs) != 1:
                names = ("method", "substeps", "hold", "force_at")
                ticks, _ = tick_at(known, points, setting.T, **{name: getattr(setting, name) for name in names})
            else:
                ticks, _ = tick_of(program, known, points)
        except HapticlabError:
            return None
        asked = [_asked(tick, falls, setting.T) for tick, falls in zip(ticks, rises, strict=True)]
        known = [b for b in asked if b is not None]
        return max(known) if known else None


def _asked(tick, falls, T):
    A, B, C, D = tick
    if not all(np.isfinite(part).all() for part in tick):
        return None
    if unstable_pole(A, B, C, falls) is not None:
        return math.inf
    if falls and unstable_pole(A, B, C) is not None:
        return None
    return required(A, B, C, D, T, points=POINTS)[0]
