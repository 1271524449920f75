"""The explicit fixed-step methods that ``hl.compile`` knows by name, and what each is known for."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from ...base.facts import card
from ...base.shows_itself import ShowsItself
from ..ir.trace import Builder
from . import stability_region
from .steps import RK4, adams_bashforth, nystrom, runge_kutta, semi_implicit_euler, verlet


@dataclass(frozen=True, repr=False)
class Method(ShowsItself):
    """A method and its properties; ``print`` shows them.

    Attributes
    ----------
    name : str
        The text that stands for it, ``method="rk4"``.
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
    says : str
        What it does, in one sentence.
    source : str
        Where it is from, or where a textbook has it.
    confused_with : str
        A law with which it is confused, and the difference.
    """

    name: str
    order: int
    evaluations: int
    step: Callable[..., tuple]
    order_with_velocity: int | None = None
    steps: int = 1
    implicit_damping: bool = False
    says: str = ""
    source: str = ""
    confused_with: str = ""

    def __post_init__(self):
        object.__setattr__(self, "__doc__", self.says)  # what help and hl.find read

    def __reduce__(self):
        return method_named, (self.name,)

    def __str__(self) -> str:
        each = "evaluation" if self.evaluations == 1 else "evaluations"
        first = f"; {self.order_with_velocity} where accelerations depend on velocities" if self.order_with_velocity else ""
        step = (
            f"{self.evaluations} {each} of the equations of motion per step, plus {self.instructions} instructions per coordinate"
        )
        facts = {"order": f"{self.order}{first}", "cost": step, "stable": self.stable, "source": self.source}
        return card(f"{self.name}: {self.says}", {**facts, "not to be confused with": self.confused_with})

    @property
    def stable(self):
        """The longest stable step in words; h is the step, omega the frequency of a spring without damping."""
        spring = (
            f"h omega <= {self.imaginary:.4g} of a spring"
            if self.imaginary
            else ("no step is stable for a spring without damping")
        )
        damper = "any step" if math.isinf(self.real) else f"h b/m <= {self.real:.4g}"
        return spring if math.isnan(self.real) else f"{spring}; {damper} of a damper"

    @cached_property
    def instructions(self):
        """How many instructions a step takes for one coordinate, the equations of motion not counted."""
        builder, given = Builder("f32"), iter(range(100))

        def leaf(*_):
            return builder.leaf("input", next(given), "f32")

        def rhs(_, q, v, s):  # one instruction each
            return [q[0] + v[0]], []

        past = ([[[leaf()], [leaf()], []] for _ in range(self.steps - 1)],) if self.steps > 1 else ()
        state = self.step(rhs, 0.0, ([leaf()], [leaf()], []), 1e-3, *past)
        (q,), (v,), _ = state[0] if past else state
        return len(builder.block([q, v])) - self.evaluations

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
        """The largest stable omega h of q'' = -omega^2 q - 2 zeta omega q'; nan with damping that is refused.

        Parameters
        ----------
        zeta : float
            Damping ratio, >= 0.
        """
        return math.nan if zeta and self.order_with_velocity else stability_region.longest_for(self, zeta)

    def energy_gain(self, omega_h):
        """The fraction of its energy that a spring-mass gains per step of omega h, in the long run.

        Parameters
        ----------
        omega_h : float
            Natural frequency times step [rad], > 0.
        """
        return stability_region.energy_gain(self, omega_h)

    def amplification(self, z):
        """Magnitude of R(z) for y' = lambda y, z = h lambda: at most 1 in the stability region.

        Semi-implicit Euler and Verlet take first-order states by Euler and Heun, of which this is the region; what they
        do to a spring is in :meth:`longest_step`.

        Parameters
        ----------
        z : complex or array
            h lambda, without unit.
        """
        return stability_region.amplification(self, z)


METHODS = {
    m.name: m
    for m in (
        Method(
            "euler", 1, 1, runge_kutta([()], [1]),
            says="Forward Euler: position and velocity both follow the rates at the start of the step.",
            source="Euler, Institutiones Calculi Integralis I (1768)",
            confused_with="semi_implicit_euler, which moves the position by the new velocity and so keeps a spring from growing",
        ),
        Method(
            "semi_implicit_euler", 1, 1, semi_implicit_euler,
            says="Semi-implicit (symplectic) Euler: the velocity first, then the position by the new velocity.",
            source="Hairer, Lubich and Wanner, Geometric Numerical Integration, ch. I",
            confused_with="euler; implicit (backward) Euler, which solves equations in each step and damps",
        ),
        Method(
            "semi_implicit_euler_damped", 1, 1, semi_implicit_euler, implicit_damping=True,
            says="Semi-implicit Euler with the dampers' forces at the end of the step, so that stiff damping is stable.",
            source="Hairer and Wanner, Solving Ordinary Differential Equations II, ch. IV.7: linearly implicit, in the damping",
            confused_with="semi_implicit_euler, whose dampers are explicit; implicit Euler, which takes springs implicitly too",
        ),
        Method(
            "verlet", 2, 2, verlet,
            says="Velocity Verlet: the position by the present acceleration, the velocity by the mean of two.",
            source="Hairer, Lubich and Wanner, Geometric Numerical Integration, ch. I; Verlet, Physical Review 159 (1967)",
            confused_with="leapfrog, the same positions with velocities offset by half a step",
        ),
        Method(
            "midpoint", 2, 2, runge_kutta([(), (1 / 2,)], [0, 1]),
            says="Explicit midpoint: a whole step with the rates at half the step.",
            source="Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, ch. II.1; Runge (1895)",
            confused_with="the implicit midpoint rule, stable at every step; semi_implicit_euler, of lower order and with "
                          "longer steps",
        ),
        Method(
            "heun", 2, 2, runge_kutta([(), (1,)], [1 / 2, 1 / 2]),
            says="Heun: the mean of the rates at both ends; the end of the step is estimated by Euler.",
            source="Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, ch. II.1",
            confused_with="the trapezoidal rule (Tustin), which is implicit; Heun's method of order 3",
        ),
        Method(
            "ssprk3", 3, 3, runge_kutta([(), (1,), (1 / 4, 1 / 4)], [1 / 6, 1 / 6, 2 / 3]),
            says="Runge-Kutta of order 3 that is a mean of Euler steps, so that a quantity that Euler keeps bounded stays "
                 "bounded.",
            source="Gottlieb, Shu and Tadmor, SIAM Review 43 (2001)",
            confused_with="Kutta's method of order 3, of the same order and stable interval, not a mean of Euler steps",
        ),
        Method(
            "nystrom4", 4, 3, nystrom, order_with_velocity=2,
            says="Nystrom: order 4 from three evaluations, where accelerations are free of velocities.",
            source="Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, ch. II.14",
            confused_with="rk4, which also integrates dampers and first-order states, with one evaluation more",
        ),
        Method(
            "adams_bashforth2", 2, 1, adams_bashforth((3 / 2, -1 / 2)), steps=2,
            says="Adams-Bashforth of two steps: a line through the rates of the last two samples.",
            source="Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, ch. III.1",
            confused_with="Adams-Moulton, which is implicit; midpoint, of the same order without memory",
        ),
        Method(
            "adams_bashforth3", 3, 1, adams_bashforth((23 / 12, -16 / 12, 5 / 12)), steps=3,
            says="Adams-Bashforth of three steps: a parabola through the rates of the last three samples.",
            source="Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, ch. III.1",
            confused_with="Adams-Moulton, which is implicit; ssprk3, of the same order without memory",
        ),
        Method(
            "rk4", 4, 4, RK4,
            says="The classical Runge-Kutta method: four evaluations, order 4.",
            source="Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, ch. II.1; Kutta (1901)",
            confused_with="RK45 of solve_ivp, which chooses its own step; the 3/8 rule, of the same order",
        ),
    )
}  # fmt: skip


def method_named(name):
    """The method of the table that has this name."""
    return METHODS[name]
