"""A scene on a leash: the motor is off for good from the tick on at which the handle is too far from where it began."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import sympy as sp

from ..scene.notation.symbols import n, parameters, signal, v, when, x
from .guard import guarded

if TYPE_CHECKING:
    from ..scene.scene import Scene

#: [J] that a guarded scene may give beside what its excitation does
SPARE = 0.05


def leashed(scene: Scene, reach: float, speed_max: float | None = None) -> Scene:
    """The scene with no force from the tick on at which the handle is further than ``reach`` from where it began.

    Counted from the handle's place at the first tick, wherever that is, and for good: a handle that comes back past the
    limit is not pushed again. Nor is one that was faster than ``speed_max`` [m/s]. It watches ``cut``, 1 from that tick on.

    Examples
    --------
    >>> import hapticlab as hl
    >>> push = hl.Scene(hl.parameters("A", units="N", values=-1.0), name="push")
    >>> log = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).run(leashed(push, 0.01), duration=0.2, x=0.03)
    >>> float(log.x[log.cut > 0][0]) > 0.04 > float(log.x[log.cut == 0][-1]), float(abs(log.F[log.cut > 0]).max())
    (True, 0.0)
    """
    limit = parameters("reach", units="m", values=reach)
    began, strayed = signal("began", unit="m"), signal("strayed", unit="1")
    too_far = sp.Or(strayed(n - 1) > sp.Rational(1, 2), sp.Abs(x(n) - began(n)) > limit)
    if speed_max is not None:
        too_far = sp.Or(too_far, sp.Abs(v(n)) > parameters("speed_max", units="m/s", values=speed_max))
    rules = sp.Eq(began(n), when(n <= 0, x(n), began(n - 1))), sp.Eq(strayed(n), when(too_far, 1, 0))
    force = when(strayed(n) > sp.Rational(1, 2), 0, scene.force)
    return replace(scene, force=force, eom=(*scene.eom, *rules), watch={**scene.watch, "cut": strayed(n)})


def held_back(scene: Scene, reach: float, *, speed_max: float, work: float, periods: int = 0) -> Scene:
    """The scene on a leash and guarded: ``cut`` is 1 from the tick on at which either switched the motor off.

    Parameters
    ----------
    scene : Scene
    reach : float
        [m] from where the handle began.
    speed_max : float
        [m/s]
    work : float
        What the scene is meant to give in all, at most [J].
    periods : int
        As :func:`~hapticlab.measurement.guard.guarded` takes it.
    """
    short = leashed(scene, reach)
    safe = guarded(short, energy_max=SPARE + work, speed_max=speed_max, periods=periods)
    watch = dict(safe.watch)  # one channel for all: a link carries few
    watch.pop("drawn")
    off = sp.Or(watch.pop("tripped") > sp.Rational(1, 2), watch["cut"] > sp.Rational(1, 2))
    return replace(safe, watch={**watch, "cut": when(off, 1, 0)})
