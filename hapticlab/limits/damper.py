"""The largest sampled damper: what a virtual damper, or a passivity controller's, may be at most."""

from __future__ import annotations

import math

import numpy as np

from ..arguments import number, period
from .limit import MOST_PERIODS, whole_and_fraction


def damper_limit(*, m: float, b: float, T: float, delay: float = 0.0) -> float:
    """Largest B [N s/m] at which a handle with the damper F = B (x[n] - x[n-1])/T alone is stable; exact, linear.

    Without device damping and delay it is 2 m/T. A hand adds mass, which raises it, and may add stiffness, which lowers
    it. Up to B = b the damper is moreover passive in any hand, Eq. (23.10).

    Parameters
    ----------
    m : float
        Mass of the handle [kg], > 0.
    b : float
        Its viscous damping [N s/m], >= 0.
    T : float
        Sampling period [s], > 0.
    delay : float
        Computational delay [s], whole and fractional periods alike, >= 0.

    Returns
    -------
    float

    Examples
    --------
    >>> round(damper_limit(m=0.05, b=0.0, T=1e-3), 9)
    100.0
    """
    m = number("m", m, "kg", "a handle", above=0)
    b = number("b", b, "N s/m", "a device", least=0)
    T = period(T)
    delay = number("delay", delay, "s", least=0, why="a force cannot come before its sample")
    whole, fraction = whole_and_fraction(delay, T, most=MOST_PERIODS)
    plant, force = _loop(m, b, T, fraction)

    def stable(B):
        characteristic = np.polyadd(np.r_[plant, np.zeros(whole + len(force) - 1)], B / T * force)
        return np.abs(np.roots(characteristic)).max() < 1

    low, high = 0.0, 4 * (m / T + b)  # beyond every limit: 2 m/T for a light damper, 2 b for a heavy one
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low


def _loop(m, b, T, fraction):
    """Return p, q with p(z) D = -q(z) z^-(whole + fraction > 0) F: D the displacement of a period, F computed before it."""
    a = math.exp(-b * T / m)
    D_all, v_all, glide = _moved(m, b, T)
    D_new, v_new, _ = _moved(m, b, T * (1 - fraction))
    # v[n+1] = a v[n] - v_new F[n] - v_old F[n-1],   D[n+1] = glide v[n] - D_new F[n] - D_old F[n-1]
    new = np.array([D_new, glide * v_new - a * D_new])
    old = np.array([D_all - D_new, glide * (v_all - v_new) - a * (D_all - D_new)])
    numerator = new if fraction == 0 else np.r_[new, 0.0] + np.r_[0.0, old]
    return np.array([1.0, -a]), numerator


def _moved(m, b, time):
    """The displacement and velocity that 1 N gives a handle at rest in that time, and the displacement of a start at 1 m/s."""
    s = b * time / m
    if s < 1e-5:  # to rounding, where the quotients below would lose half their digits
        return time**2 / m * (1 / 2 - s / 6), time / m * (1 - s / 2), time * (1 - s / 2)
    lost = -math.expm1(-s)
    return (time - m * lost / b) / b, lost / b, m * lost / b
