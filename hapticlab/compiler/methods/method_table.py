"""The explicit fixed-step methods that ``hl.compile`` knows by name, and what each is known for."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from . import stability_region
from .steps import RK4, adams_bashforth, nystrom, runge_kutta, semi_implicit_euler, verlet


@dataclass(frozen=True)
class Method:
    """A method and what it is known for.

    Attributes
    ----------
    name : str
    order : int
        Of the global error where the motion is smooth.
    evaluations : int
        Of the equations of motion, per step.
    step : callable ``(rhs, tau, (q, v, s), h) -> (q, v, s)``
        Of a multistep method ``(rhs, tau, (q, v, s), h, past) -> (q, v, s), past``.
    order_with_velocity : int or None
        Where it is less, the order for accelerations that depend on velocities; such a method is refused there.
    steps : int
        How many steps' rates it uses, the present one included; ``past`` are those of the others, newest first.
    implicit_damping : bool
        Its ``rhs`` solves (M - h D) a = f, D what damps of the slopes of f by the rates, instead of M a = f.
    """

    name: str
    order: int
    evaluations: int
    step: Callable[..., tuple]
    order_with_velocity: int | None = None
    steps: int = 1
    implicit_damping: bool = False

    @cached_property
    def real(self):
        """The largest stable h b/m of a body on a damper; nan where velocities are refused.

        Of a method that treats q and v alike it is the stable interval of y' = -y on the real axis.
        """
        return math.nan if self.order_with_velocity else stability_region.longest_damper(self)

    @cached_property
    def imaginary(self):
        """The largest stable omega h of a spring without damping: the stable interval on the imaginary axis."""
        return stability_region.longest_for(self)

    def longest_step(self, zeta=0.0):
        """The largest stable omega h of q'' = -omega^2 q - 2 zeta omega q'; nan with damping that is refused."""
        return math.nan if zeta and self.order_with_velocity else stability_region.longest_for(self, zeta)

    def energy_gain(self, omega_h):
        """The part of its energy that a spring-mass gains in a step of omega h, in the long run."""
        return stability_region.energy_gain(self, omega_h)

    def amplification(self, z):
        """|R(z)| of y' = lambda y, z = h lambda: at most 1 in the stability region.

        Semi-implicit Euler and Verlet take first-order states by Euler and Heun, of which this is the region; what they
        do to a spring is in :meth:`longest_step`.
        """
        return stability_region.amplification(self, z)


METHODS = {
    m.name: m
    for m in (
        Method("euler", 1, 1, runge_kutta([()], [1])),
        Method("semi_implicit_euler", 1, 1, semi_implicit_euler),
        Method("semi_implicit_euler_damped", 1, 1, semi_implicit_euler, implicit_damping=True),
        Method("verlet", 2, 2, verlet),
        Method("midpoint", 2, 2, runge_kutta([(), (1 / 2,)], [0, 1])),
        Method("heun", 2, 2, runge_kutta([(), (1,)], [1 / 2, 1 / 2])),
        Method("ssprk3", 3, 3, runge_kutta([(), (1,), (1 / 4, 1 / 4)], [1 / 6, 1 / 6, 2 / 3])),
        Method("nystrom4", 4, 3, nystrom, order_with_velocity=2),
        Method("adams_bashforth2", 2, 1, adams_bashforth((3 / 2, -1 / 2)), steps=2),
        Method("adams_bashforth3", 3, 1, adams_bashforth((23 / 12, -16 / 12, 5 / 12)), steps=3),
        Method("rk4", 4, 4, RK4),
    )
}
