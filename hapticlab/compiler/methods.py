"""The explicit fixed-step methods that ``hl.compile`` knows by name, and what each is known for."""

from dataclasses import dataclass

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
    step: callable
    order_with_velocity: int = None
    steps: int = 1
    implicit_damping: bool = False


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
