"""A person's model of their own arm, and the smoothest paths it takes: what moves without waiting for feedback."""

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Arm:
    """What an arm carries and how it holds it: m x'' + b x' = b_hand (i' - x') + k (i - x) for an intent i."""

    m: float
    b: float
    b_hand: float
    k: float

    def force(self, x, v, a):
        """The intent [m] that would hold this motion if it lasted."""
        return x + (self.m * a + (self.b + self.b_hand) * v) / self.k

    def intent(self, intent, before, after, h):
        """The intent h later: b_hand i' + k i = k force, its right side linear in between."""
        if self.b_hand == 0:
            return after
        decay = math.exp(-self.k * h / self.b_hand)
        first = (1 - decay) * self.b_hand / (self.k * h)
        return decay * intent + (first - decay) * before + (1 - first) * after


def quintic(start, end, duration):
    """Coefficients, lowest first, of the smoothest path between two (place, velocity, acceleration): least jerk.

    Examples
    --------
    >>> path = quintic((0, 0, 0), (1, 0, 0), 2.0)
    >>> [round(a, 9) for a in along(path, 1.0)[:2]]
    [0.5, 0.9375]
    """
    h = duration
    matrix = [[h**3, h**4, h**5], [3 * h**2, 4 * h**3, 5 * h**4], [6 * h, 12 * h**2, 20 * h**3]]
    x, v, a = start
    left = np.array(end) - [x + v * h + a * h * h / 2, v + a * h, a]
    return np.r_[x, v, a / 2, np.linalg.solve(matrix, left)]


def along(path, t):
    """Place, velocity and acceleration of a path at t."""
    place = velocity = acceleration = 0.0
    for c in reversed(path.tolist()):  # Horner's rule, derivatives along with it
        acceleration = acceleration * t + 2 * velocity
        velocity = velocity * t + place
        place = place * t + c
    return place, velocity, acceleration
