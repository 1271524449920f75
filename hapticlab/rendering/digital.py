"""A wall designed in the digital domain: the sampled loop has the poles that the wall itself would have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.shows_itself import ShowsItself
from ..scene.notation.symbols import when
from .model import WallModel
from .scene_lines import Lines, number

if TYPE_CHECKING:
    from ..device.device import AnyDevice
    from ..device.hand.hand import Hand
    from ..scene.laws.estimators import VelocityEstimate
    from ..scene.scene import Scene


@dataclass(frozen=True)
class DigitalGains(ShowsItself):
    """Gains that put the poles of a sampled wall where the target's are, z = e^(s T).

    Attributes
    ----------
    k1, k2 : float
        Stiffness [N/m] and damping [N s/m] of the force k1 p + k2 v.
    poles : tuple of complex
        Of the sampled loop, one a target pole.
    model : WallModel
    """

    k1: float
    k2: float
    poles: tuple[complex, ...]
    model: WallModel

    def __str__(self) -> str:
        shown = ", ".join(f"{z:.4g}" for z in self.poles)
        return (
            f"k1 = {self.k1:.6g} N/m ({self.k1 / self.model.K:.3%} of K), k2 = {self.k2:.6g} N s/m "
            f"({self.k2 / (self.model.K * self.model.T):.4g} K T); poles {shown}\n  {self.model}"
        )


def digital_gains(paddle: AnyDevice, *, K: float, B: float = 0.0, hand: Hand | None = None) -> DigitalGains:
    """Gains of :func:`digital_wall`: those of a held force that give the poles of handle, hand and wall in continuous time.

    For a handle without damping in no hand, with w^2 = K/m: k1 = K sinc^2(wT/2) and k2 = k1 T/2, which is Eq. (23.3) on a
    slightly softer spring. From M T/2 of damping on, and at stiffnesses past the sampling frequency's reach, both gains
    stay finite; the force they ask for may not be one a motor has.

    Parameters
    ----------
    paddle : SimulatedPaddle or Device
    K, B : float
        The wall that is meant, [N/m] > 0 and [N s/m] >= 0.
    hand : Hand, optional
        The hand to design for; the paddle's own unless given. ``hl.Hand()`` is none.

    Returns
    -------
    DigitalGains

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.design.digital_gains(hl.SimulatedPaddle(m=0.05, b=0, T=0.01), K=500))
    k1 = 459.698 N/m (91.940% of K), k2 = 2.29849 N s/m (0.4597 K T); poles 0.5403+0.8415j, 0.5403-0.8415j
      M = 0.05 kg, b = 0 N s/m, k = 0 N/m, push = 0 N; wall K = 500 N/m, B = 0 N s/m, T = 0.01 s, delay = 0 s
    """
    model = WallModel.of(paddle, K=K, B=B, hand=hand)
    g = _row(model)
    poles = np.linalg.eigvals(model.flow(1.0, wall=True)[0]).astype(complex)
    return DigitalGains(model.K * float(g[0]), model.K * model.T * float(g[1]), tuple(map(complex, poles)), model)


def _row(model):
    """Return the gains on (p, w), in units of K, by Ackermann's formula."""
    (Phi, gamma), (wall, _) = model.flow(1.0), model.flow(1.0, wall=True)
    # by Cayley and Hamilton the target's characteristic polynomial of Phi is linear in Phi
    wanted = (np.trace(Phi) - np.trace(wall)) * Phi + (np.linalg.det(wall) - np.linalg.det(Phi)) * np.eye(2)
    return np.linalg.solve(np.column_stack([gamma, Phi @ gamma]), wanted)[1]


def digital_wall(
    paddle: AnyDevice,
    *,
    K: float,
    B: float = 0.0,
    hand: Hand | None = None,
    velocity: Literal["model"] | VelocityEstimate | None = None,
    clamp: bool = False,
    force_max: float | None = None,
) -> Scene:
    """Virtual wall designed in the digital domain (Section 23.4.1): F = k1 p + k2 v where p >= 0, else 0.

    The gains are :func:`digital_gains`. Under a delay the law looks at the handle where its force begins to act, predicted
    with the model and the forces under way. A push the hand is known to have, ``push``, moves the rest to where it would
    be on the spring K, for k1 alone is softer.

    The coefficients belong to the paddle's T. At another period, 0.1 % off or more, the force is no number, and the motor
    off. At crossings of the boundary, which fall between samples, the wall still leaks; :func:`deadbeat_wall` does not.

    Parameters
    ----------
    paddle, K, B, hand
        As in :func:`digital_gains`.
    velocity : "model" or VelocityEstimate, optional
        v(n) of the paddle; or what two positions and the forces between them say by the model, exact where the model is;
        or :func:`~hapticlab.scene.laws.estimators.filtered_velocity` and its like.
    clamp : bool
        Never pull.
    force_max : float, optional
        The motor's limit [N]; the paddle's own unless given.

    Returns
    -------
    Scene
        With parameters k (fixed: the coefficients belong to it) and x_o [m]; push [N], the hand's force at x = 0, where the
        hand has one; and force_max [N] where there is a limit.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0, T=0.01)
    >>> log = paddle.run(hl.laws.digital_wall(paddle, K=500), duration=0.5, v=0.2, x=1e-3, progress=False)
    >>> round(float(log.F.max()), 3)
    0.994
    """
    gains = digital_gains(paddle, K=K, B=B, hand=hand)
    lines = Lines(gains.model)
    p, w = lines.at_switch(velocity)
    force = when(p >= 0, digital_force(lines, p, w))
    return lines.scene(force, "digital wall", force_max=motor_limit(paddle, force_max), clamp=clamp)


def digital_force(lines, p, w):
    """Return the force inside the wall, in metres of its spring."""
    g = _row(lines.model)
    softer = number((1 - g[0]) * lines.model.rest) * lines.outer
    return number(g[0]) * p + number(g[1]) * w + softer


def motor_limit(paddle, given):
    """Return the force a law may ask for [N], or None."""
    return getattr(paddle, "force_max", None) if given is None else given
