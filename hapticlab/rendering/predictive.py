"""A wall that looks half a period ahead with the exact motion of handle, hand and wall, Section 23.4.1."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from ..scene.notation.symbols import when
from .digital import motor_limit
from .model import WallModel
from .scene_lines import Lines, number

if TYPE_CHECKING:
    from ..device.device import AnyDevice
    from ..device.hand.hand import Hand
    from ..scene.laws.estimators import VelocityEstimate
    from ..scene.scene import Scene


def predictive_wall(
    paddle: AnyDevice,
    *,
    K: float,
    B: float = 0.0,
    hand: Hand | None = None,
    velocity: Literal["model"] | VelocityEstimate | None = None,
    clamp: bool = False,
    force_max: float | None = None,
) -> Scene:
    """Virtual wall by model-based half-sample prediction: F = K p(n + 1/2) + B v(n + 1/2) where p(n) >= 0, else 0.

    The half sample is predicted by the analytic solution of handle, hand and wall, where Eq. (23.3) goes on at constant
    velocity. Under a delay the half period begins where the force begins to act. Periods in which the boundary is crossed
    are predicted as if it were not; :func:`deadbeat_wall` handles them.

    Parameters
    ----------
    paddle, K, B, hand
        As in :func:`digital_gains`.
    velocity, clamp, force_max
        As in :func:`digital_wall`.

    Returns
    -------
    Scene

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0, T=1e-3, hand=hl.Hand(m=0.02, b=1, k=200))
    >>> print(hl.laws.predictive_wall(paddle, K=500).name)
    predictive wall (made for T = 1 ms)
    """
    lines = Lines(WallModel.of(paddle, K=K, B=B, hand=hand))
    p, w = lines.at_switch(velocity)
    force = when(p >= 0, half_sample_force(lines, p, w))
    return lines.scene(force, "predictive wall", force_max=motor_limit(paddle, force_max), clamp=clamp)


def half_sample_force(lines, p, w):
    """Return the force of the wall half a period on, in metres of its spring."""
    model = lines.model
    Phi, gamma = model.flow(0.5, wall=True)
    damper = model.B / (model.K * model.T)
    row, push = Phi[0] + damper * Phi[1], gamma[0] + damper * gamma[1]
    return number(row[0]) * p + number(row[1]) * w + number(push) * lines.outer
