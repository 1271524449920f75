"""Pulses on entering a wall: what meets the handle first is a brake, and the spring only has to hold it.

A wall that stops a handle by its spring needs a stiffness that the sampling period cannot carry. A brake of a few
periods takes the momentum instead, and the wall feels harder at the same K: Salcudean and Vlaar, *On the emulation of
stiff walls and static friction with a magnetically levitated input/output device*, J. Dynamic Systems, Measurement, and
Control 119 (1997) 127-132.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ...base.arguments import count, instance
from ...base.shows_itself import ShowsItself
from ...errors import SceneError
from ..notation.amount import amount
from ..notation.parameters import T
from ..notation.symbols import n, signal, v, when, x
from ..scene import Scene
from .estimators import AN_ESTIMATE, VelocityEstimate

if TYPE_CHECKING:
    from ...base.annotations import Term


#: periods that a pulse may last
LONGEST_PULSE = 1000


@dataclass(frozen=True, kw_only=True)
class Entry(ShowsItself):
    """The boundary at which the handle enters, and the estimate of its entry speed.

    Parameters
    ----------
    x_o : float, text or Parameter, optional
        Where the boundary is [m]; the scene's own x_o unless given.
    velocity : VelocityEstimate, optional
        Instead of the paddle's v(n).

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.Entry(x_o="10 mm").velocity is None
    True
    """

    x_o: Term | None = None
    velocity: VelocityEstimate | None = None

    def __post_init__(self) -> None:
        if self.velocity is not None:
            instance("velocity", self.velocity, VelocityEstimate, AN_ESTIMATE, error=SceneError)
        if self.x_o is not None:
            amount(self.x_o, "m", "x_o")


ENTRY = Entry()


def braking_pulse(
    scene: Scene,
    *,
    impulse: Term | None = None,
    part: Term | None = None,
    mass: Term | None = None,
    periods: int = 1,
    force_max: Term | None = None,
    entry: Entry = ENTRY,
    name: str = "brake",
) -> Scene:
    """Add a braking pulse on entry: a given impulse, or a fraction of the momentum of the handle.

    The pulse begins at the first sample inside and lasts ``periods`` T. It ends sooner where the handle has stopped or
    left, so that it brakes and does not throw. A free handle of this mass without friction comes out of it with the
    part (1 - part) of its speed, exactly where v(n) is exact and the delay zero; a damper b takes less than b periods
    T/mass more. A speed from an encoder of count D is known to D/T only: give the ``entry`` a velocity that is better.

    Parameters
    ----------
    scene : Scene
        The wall, or anything else behind the boundary.
    impulse : float, text or Parameter
        [N s], > 0. Either this, or ``part`` and ``mass``.
    part : float or Parameter
        Of the momentum mass v(n) at the entry; 1 stops the handle.
    mass : float, text or Parameter
        Of handle and hand [kg], > 0.
    periods : int
        1 to 1000.
    force_max : float, text or Parameter, optional
        The pulse's greatest force [N]; what a motor cannot give is better left out than cut off.
    entry : Entry
        Where the boundary is, and which speed counts: ``hl.laws.Entry(x_o=, velocity=)``.
    name : str
        Of the pulse's signals.

    Returns
    -------
    Scene

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.braking_pulse(hl.wall(), part=0.8, mass="50 g", periods=2).name
    'zoh wall with a braking pulse'
    """
    moving, eom = _speed(entry.velocity)
    periods = count("periods", periods, "a pulse", of="periods", most=LONGEST_PULSE, error=SceneError)
    if (impulse is None) == (part is None) or (mass is None) != (part is None):
        raise SceneError("a braking pulse needs impulse=..., in N s, or part=... of the momentum and mass=..., in kg")
    if impulse is not None:
        taken = amount(impulse, "N*s", "impulse", "a pulse", above=0)
    else:
        part = amount(part, "1", "part", "a pulse", above=0)
        amount(part, "1", "part", "a pulse above the whole momentum throws the handle back:", most=1)
        taken = part * amount(mass, "kg", "mass", "a pulse", above=0) * sp.Max(moving, 0)
    force = taken / (periods * T)
    force = force if force_max is None else sp.Min(force, amount(force_max, "N", "force_max", "a pulse", above=0))
    entered, inside = _crossing(scene, entry.x_o)
    left, size = signal(f"{name}_left", unit="1"), signal(f"{name}_force", unit="N")
    going = when(inside & (moving > 0), sp.Max(left(n - 1) - 1, 0))
    eom += (
        sp.Eq(left(n), when(entered, periods, going)),
        sp.Eq(size(n), when(entered, force, size(n - 1)) if periods > 1 else force),
    )
    return _added(scene, when(left(n) > 0, size(n)), eom, "a braking pulse")


def friction_pulse(
    scene: Scene,
    *,
    friction: Term,
    mass: Term,
    periods: int,
    entry: Entry = ENTRY,
    name: str = "friction",
) -> Scene:
    """Add dry friction for some time after entry: it opposes motion in both directions, and holds a handle that has stopped.

    For ``periods`` T from the first sample inside the force is ``friction`` against the motion, and never more than
    stops this mass within the next period, mass v(n)/T: the part of Karnopp's friction that a sampled force can render.
    A free handle decelerates by friction/mass and then stops within one period, exactly where v(n) is exact and there
    is neither damper nor delay; ``periods`` must last for both, or some speed is left.

    A wrong mass: where ``friction`` does not limit it, the part 1 - mass/m of the speed is left from one period to the
    next, m the true one. So too small a mass only takes longer. One too large turns the handle at every period, and may
    throw it back out, though below 2 m never faster than it was; from 2 m on it shakes ever more, up to ``friction``.

    A delay of d whole periods: with the right mass it swings, from d = 1 on without end. Give the part
    d^d/(d + 1)^(d + 1) of the mass, 1/4 for one period and 4/27 for two, and it stops without turning.

    Parameters
    ----------
    scene : Scene
    friction : float, text or Parameter
        [N], > 0.
    mass : float, text or Parameter
        Of handle and hand [kg], > 0.
    periods : int
        1 to 1000.
    entry, name
        As for :func:`braking_pulse`.

    Returns
    -------
    Scene

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.friction_pulse(hl.wall(), friction=2.0, mass="50 g", periods=20).name
    'zoh wall with a friction pulse'
    """
    moving, eom = _speed(entry.velocity)
    periods = count("periods", periods, "a pulse", of="periods", most=LONGEST_PULSE, error=SceneError)
    limit, mass = amount(friction, "N", "friction", "a pulse", above=0), amount(mass, "kg", "mass", "a pulse", above=0)
    entered, inside = _crossing(scene, entry.x_o)
    left = signal(f"{name}_left", unit="1")
    eom += (sp.Eq(left(n), when(entered, periods, when(inside, sp.Max(left(n - 1) - 1, 0)))),)
    force = sp.Max(-limit, sp.Min(limit, mass * moving / T))
    return _added(scene, when(left(n) > 0, force), eom, "a friction pulse")


def _speed(velocity):
    if velocity is None:
        return v(n), ()
    return velocity.velocity, velocity.eom


def _crossing(scene, x_o):
    """Two conditions: this sample is the first one inside, and it is inside."""
    if x_o is None and "x_o" not in scene.parameters:
        raise SceneError(f"{scene.name} has no parameter x_o. Give its boundary in m: entry=hl.laws.Entry(x_o=0.01)")
    boundary = scene.parameters["x_o"] if x_o is None else amount(x_o, "m", "x_o")
    return (x(n) >= boundary) & (x(n - 1) < boundary), x(n) >= boundary


def _added(scene, force, eom, what):
    fresh = tuple(e for e in eom if e not in scene.eom)  # an estimate that the scene has already
    return Scene(scene.force + force, (*scene.eom, *fresh), scene.watch, scene.values, f"{scene.name} with {what}")
