"""Explicit fixed-step methods, as the lines of the textbook, traced alike for numbers and for programs.

A method advances ``(q, v, s)`` by ``h``: positions q and velocities v = q' of the second-order coordinates, and the
first-order states s. ``rhs(tau, q, v, s)`` returns ``(a, ds)`` at the time tau after the sample. Lists in, lists out.

Tables: Hairer, Norsett and Wanner, *Solving Ordinary Differential Equations I*, ch. II.1. Semi-implicit Euler and
velocity Verlet: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, ch. I.
"""

from dataclasses import dataclass


def _plus(y, h, dy):
    return [a + h * b for a, b in zip(y, dy, strict=True)]


@dataclass(frozen=True)
class Method:
    """A method and what it is known for.

    Attributes
    ----------
    name : str
    order : int
        Of the global error, for forces that depend on velocity too.
    evaluations : int
        Of the equations of motion, per step.
    step : callable ``(rhs, tau, (q, v, s), h) -> (q, v, s)``
    """

    name: str
    order: int
    evaluations: int
    step: callable


def runge_kutta(a, b):
    """Return the step of an explicit Runge-Kutta table with rows ``a`` and weights ``b``; nodes are the row sums."""

    def step(rhs, tau, state, h):
        q, v, s = state
        k = []
        for row in a:
            at = [q, v, s]
            for weight, slopes in zip(row, k, strict=False):
                if weight:
                    at = [_plus(part, weight * h, slope) for part, slope in zip(at, slopes, strict=True)]
            acceleration, ds = rhs(tau + sum(row) * h, *at)
            k.append((at[1], acceleration, ds))
        return tuple(_weighted(part, h, b, [slopes[j] for slopes in k]) for j, part in enumerate((q, v, s)))

    return step


def _weighted(y, h, b, slopes):
    """Return y + h * (b1 k1 + b2 k2 + ...), stages of equal weight summed first."""
    result = []
    for i, start in enumerate(y):
        groups = {}
        for weight, slope in zip(b, slopes, strict=True):
            if weight:
                groups[weight] = groups[weight] + slope[i] if weight in groups else slope[i]
        total = None
        for weight, summed in groups.items():
            term = (weight * h) * summed
            total = term if total is None else total + term
        result.append(start + total)
    return result


def semi_implicit_euler(rhs, tau, state, h):
    """v(n+1) = v(n) + h a(q(n), v(n)); q(n+1) = q(n) + h v(n+1)."""
    q, v, s = state
    a, ds = rhs(tau, q, v, s)
    v = _plus(v, h, a)
    return _plus(q, h, v), v, _plus(s, h, ds)


def verlet(rhs, tau, state, h):
    """Velocity Verlet, the second force at q(n+1) and v + h a.

    With the half-step velocity there instead, a velocity-dependent force would cost it an order.
    """
    q, v, s = state
    a, ds = rhs(tau, q, v, s)
    q_next = [p + h * (w + (h / 2) * c) for p, w, c in zip(q, v, a, strict=True)]
    a_next, ds_next = rhs(tau + h, q_next, _plus(v, h, a), _plus(s, h, ds))
    v_next = [w + (h / 2) * (c + d) for w, c, d in zip(v, a, a_next, strict=True)]
    return q_next, v_next, [y + (h / 2) * (c + d) for y, c, d in zip(s, ds, ds_next, strict=True)]


METHODS = {
    m.name: m
    for m in (
        Method("euler", 1, 1, runge_kutta([()], [1])),
        Method("semi_implicit_euler", 1, 1, semi_implicit_euler),
        Method("verlet", 2, 2, verlet),
        Method("heun", 2, 2, runge_kutta([(), (1,)], [1 / 2, 1 / 2])),
        Method("rk4", 4, 4, runge_kutta([(), (1 / 2,), (0, 1 / 2), (0, 0, 1)], [1 / 6, 1 / 3, 1 / 3, 1 / 6])),
    )
}
