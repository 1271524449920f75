"""Answers of lab 08, by the names they have in its notebook."""

import numpy as np

prediction = 27.6


def penalty_force(gap, rate, k, b):
    """Normal force of a penalty contact [N], which never pulls."""
    return np.where(gap < 0, np.maximum(0.0, -k * gap - b * rate), 0.0)


def stiffest_penalty(m, M, h):
    """Largest stiffness [N/m] with which a contact lasts ten steps."""
    return m * M / (m + M) * (np.pi / (10 * h)) ** 2


two_springs = "c"


def impact(v, w, m, M, e):
    """Velocities after an impact [m/s] and the impulse on the ball [N s]."""
    p = (1 + e) * m * M / (m + M) * (w - v)
    return {"v": v + p / m, "w": w - p / M, "p": p}


def pulse_time(p, F_max):
    """Tau of the pulse that peaks at F_max [s]."""
    return p / (np.e * F_max)


def reaction(a, m, g):
    """Reaction [N] of a ball on a plate that accelerates, and the acceleration of the gap [m/s^2]."""
    return {"N": max(0.0, m * (g + a)), "gap_acceleration": max(0.0, -g - a)}


def largest_multiplier(a, e, g):
    """Largest magnitude of the eigenvalues from one impact to the next."""
    step = [[1, (1 + e) / g], [(1 + e) * a, (1 + e) ** 2 * a / g + e**2]]
    return np.abs(np.linalg.eigvals(step)).max()


discussion = (
    "I predicted the weight of the ball and was off by a factor of a hundred: 27.6 N would be needed in one "
    "period. Spread over 5 ms the same impulse is felt with 2 N, later and softer. For a drum I take the impulse, "
    "p = 23 mN s in no time; for a box that lies on the handle the constraint, which lets go at -9.81 m/s^2; for "
    "a ball on a board the penalty, up to 411 N/m at 500 Hz. My own juggle got better when I slowed down at "
    "impact, and with closed eyes I kept the ball by touch."
)
