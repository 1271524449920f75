"""What a setting of a trade-off asks for to be stable and passive, from the program that was tried anyway."""

import functools
import math

from ...compiler.methods.chosen_method import chosen_method
from ...errors import HapticlabError
from ...limits.port import negative
from ..programs.error_order import order_of
from .condition_switches import switched
from .linearization import forces_and_ticks_at, forces_and_ticks_of
from .operating_points import TRAVEL
from .port_limits import Looked
from .step_limit import step_limit

#: frequencies looked at, twice; beside those around every pole they find what 1000 do, to 1e-7
POINTS = 150


class Limits:
    """Margins of steps and damping asked for, of all settings of one scene.

    Parameters
    ----------
    scene : Scene
    travel : float
        To which the handle goes to either side [m].
    delay : float
        After which a force is felt [s].
    """

    def __init__(self, scene, travel=TRAVEL, delay=0.0):
        self.scene, self.travel, self.delay = scene, travel, delay

    @functools.cached_property
    def places(self):
        """Where the scene, its cases as switches, is looked at."""
        return Looked(switched(self.scene), travel=self.travel)

    @functools.lru_cache(maxsize=64)  # noqa: B019  it lives as long as its bench
    def longest(self, method):
        """Return the longest stable step [s] of a method, and how long the shortest contact lasts [s]; None where not known."""
        T = 1e-3
        try:
            found = step_limit(self.scene, method, T=T)
        except HapticlabError:
            return None
        return found.h_max, math.inf if chosen_method(method).locates else found.steps_per_contact * T

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
        """Return (damping of a device [N s/m] that a setting asks for, where); the first None where that cannot be told.

        ``where`` is empty but for a scene that is not linear within its cases: what it asks for is of small motions there.
        Where the scene falls by itself, as a pole on a cart, no motion near it is passive; inf where its stiffness is
        negative, or its force jumps.
        """
        try:
            known, points = self.places.known, self.places.all
            if known.switches or len(program.inputs) != 1:
                names = ("method", "substeps", "hold", "force_at")
                found = forces_and_ticks_at(known, points, setting.T, **{name: getattr(setting, name) for name in names})
            else:
                found = forces_and_ticks_of(program, known, points)
            modes, kind = self.places.limits(*found, setting.T, self.delay, frequencies=POINTS)
        except HapticlabError:
            return None, ""
        asked = [(math.inf if one.reason == negative(one.stiffness) else one.b_req, one.point) for one in modes]
        b, where = max((one for one in asked if not math.isnan(one[0])), key=lambda one: one[0], default=(None, ""))
        return b, where if kind == "small-signal" else ""
