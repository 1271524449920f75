"""Answers of lab 08, by the names they have in its notebook."""

import numpy as np

prediction = 27.6


def penalty_force(gap, rate, k, b):
    """Return the normal force of a penalty contact [N], which never pulls."""
    return np.where(gap < 0, np.maximum(0.0, -k * gap - b * rate), 0.0)


def stiffest_penalty(m, M, h):
    """Return the largest stiffness [N/m] with which a contact lasts ten steps."""
    return m * M / (m + M) * (np.pi / (10 * h)) ** 2


two_springs = "c"


def impact(v, w, m, M, e):
    """Return the velocities after an impact [m/s] and the impulse on the ball [N s]."""
    p = (1 + e) * m * M / (m + M) * (w - v)
    return {"v": v + p / m, "w": w - p / M, "p": p}


def pulse_time(p, F_max):
    """Return tau of the pulse that peaks at F_max [s]."""
    return p / (np.e * F_max)


def reaction(a, m, g):
    """Return the reaction [N] on a ball on an accelerating plate, and the acceleration of the gap [m/s^2]."""
    return {"N": max(0.0, m * (g + a)), "gap_acceleration": max(0.0, -g - a)}


def largest_multiplier(a, e, g):
    """Return the largest magnitude of the eigenvalues of the map from one impact to the next."""
    step = [[1, (1 + e) / g], [(1 + e) * a, (1 + e) ** 2 * a / g + e**2]]
    return np.abs(np.linalg.eigvals(step)).max()


discussion = (
    "I predicted the weight of the ball, which is too small by a factor of a hundred: the impulse within one period "
    "needs 27.6 N. If the same impulse is spread over 5 ms, the hand feels 2 N, later and softer. For a drum I would use "
    "the impulse, p = 23 mN s at an instant; for a box that lies on the handle the constraint, which opens at -9.81 m/s^2; "
    "for a ball on a board the penalty, up to 411 N/m at 500 Hz. My own juggling became better when I slowed down at "
    "impact, and with closed eyes I kept the ball up for six bounces by its rhythm."
)
