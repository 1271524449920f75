"""Damping compensation: the device's own friction, viscous and dry, fed back with the other sign."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import sympy as sp

from ...base.arguments import choice, instance
from ...errors import SceneError
from ..notation.amount import amount
from ..notation.parameters import parameters
from ..notation.symbols import n, v, when
from ..scene import Scene
from .estimators import AN_ESTIMATE, VelocityEstimate

if TYPE_CHECKING:
    from ...base.annotations import Term


SHAPES = ("smooth", "dead_zone")


def damping_compensation(
    scene: Scene | None = None,
    *,
    b: Term,
    coulomb: Term = 0,
    speed: Term | None = None,
    sign: str = "smooth",
    velocity: VelocityEstimate | None = None,
) -> Scene:
    """Cancel a fraction of a device's friction: F = -viscous b v(n) - dry coulomb s(v(n)), negative virtual damping.

    The physical damper stays, and with it the passivity that it buys at all frequencies; the compensation acts where
    the hand is slow. So Eq. (23.10) reads b > K T/2 + viscous b in a wall K in which the compensation acts: of what is
    compensated there nothing is left for the wall. A compensation in free air only leaves most of it;
    :func:`~hapticlab.analysis.stability.worst_motion.worst_motion` searches how much.

    Beyond ``viscous`` = 1, or ``dry`` = 1, the paddle runs away, and sooner where its friction is less than b and
    coulomb say: :func:`~hapticlab.rendering.compensation_limit.compensation_limit` tells how much of an identified
    friction is safe.

    Parameters
    ----------
    scene : Scene, optional
        What is felt beside; nothing unless given.
    b : float, text or Parameter
        The device's viscous damping at the handle [N s/m], >= 0.
    coulomb : float, text or Parameter
        Its Coulomb friction [N], >= 0.
    speed : float, text or Parameter
        Width of s about v = 0 [m/s], > 0, needed with ``coulomb``: several times the noise of the velocity, and one
        encoder count per period at least, lest it buzzes at rest.
    sign : {"smooth", "dead_zone"}
        s(v) = v/sqrt(v^2 + speed^2), or sign(v) beyond ``speed`` and nothing within: it leaves a handle at rest alone.
    velocity : VelocityEstimate, optional
        Instead of the paddle's v(n).

    Returns
    -------
    Scene
        With parameters viscous and dry [1], the parts that are cancelled, >= 0.

    Examples
    --------
    >>> import hapticlab as hl
    >>> free = hl.laws.damping_compensation(b=0.1, coulomb=0.05, speed="5 mm/s")(viscous=0.9, dry=0.8)
    >>> sorted(free.values)
    ['dry', 'viscous']
    >>> wall = hl.laws.damping_compensation(hl.wall(), b=0.1)(k=20, viscous=0.9)
    """
    choice("sign", sign, SHAPES, error=SceneError)
    instance("velocity", velocity, VelocityEstimate | None, AN_ESTIMATE, error=SceneError)
    moving = v(n) if velocity is None else velocity.velocity
    viscous, dry = parameters("viscous dry", units="1 1", ranges=((0, math.inf), (0, math.inf)))
    force = -viscous * amount(b, "N*s/m", "b", "friction", least=0) * moving
    friction = amount(coulomb, "N", "coulomb", "friction", least=0)
    if friction != 0:
        if speed is None:
            raise SceneError("coulomb without speed: the sign of a measured velocity needs a width, such as speed='5 mm/s'")
        force -= dry * friction * _sign(moving, amount(speed, "m/s", "speed", "friction", above=0), sign)
    eom = () if velocity is None else velocity.eom
    if scene is None:
        return Scene(force, eom, name="damping compensation")
    fresh = tuple(e for e in eom if e not in scene.eom)
    name = f"{scene.name} with damping compensation"
    return Scene(scene.force + force, (*scene.eom, *fresh), scene.watch, scene.values, name)


def _sign(moving, speed, sign):
    if sign == "smooth":
        return moving / sp.sqrt(moving**2 + speed**2)
    return when(moving > speed, 1, when(moving < -speed, -1, 0))
