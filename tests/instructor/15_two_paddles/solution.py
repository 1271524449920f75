"""Answers of lab 15, by the names they have in the notebook."""

import numpy as np

import hapticlab as hl
from hapticlab import n, v, x

prediction_felt = "mass"  # not marked
prediction_factor = 10.0

k, b = hl.parameters("k b", units="N/m N*s/m")
x_other, v_other = hl.parameters("x_other v_other", units="m m/s", values=(0, 0))
one_side = hl.Scene(force=k * (x(n) - x_other) + b * (v(n) - v_other))


def two_dampers(k, b, d):
    """Damping together, k (x - (x - d v)), and against each other, k (x + (x - d v)) + 2 b v."""
    return np.array([k * d, 2 * b - k * d])


def highest_stiffness(b_h, b, d):
    """Stiffness at which b_h + 2 b - k d = 0."""
    return (b_h + 2 * b) / d


def felt_damping(k, K, d):
    """Dampings from x(t - 2 d) = x - 2 d v."""
    return np.array([2 * d * k**2 / (k + K), -2 * d * k * K / (k + K)])


def wave_side(b, v, w):
    """Force and wave that leaves, from w = (b v - F)/sqrt(2 b)."""
    F = b * v - np.sqrt(2 * b) * w
    return np.array([F, (b * v + F) / np.sqrt(2 * b)])


def repaying_damper(heard, given, dx, T, alpha_max):
    """Damping that dissipates given - heard within one period."""
    owed = given - heard
    if owed <= 0 or dx == 0:
        return 0.0
    return min(alpha_max, owed * T / dx**2)


def gain(silence, hold, fade):
    """A straight line from 1 at hold to 0 at hold + fade."""
    return float(np.clip((hold + fade - silence) / fade, 0, 1))


which_coupling = "d"
discussion = """
Over 100 ms I choose position-position with a soft spring of about 20 N/m, a passivity controller and a fade on each side.
The table gives a limit of about 80 N/m for two pinching hands at long delays, but only about 2 N/m for any two hands, so
the stiffness alone guarantees nothing and the controller has to. With k = 20 N/m we both feel a damper of 2 k d = 4 N s/m
that the box does not have, and the box feels softer than it is. With waves of 1 N s/m we would feel a spring of only 10
N/m and a mass of 100 g that is not there. If one person lets go, the other one pulls a free handle on an undamped spring,
so I would stop when a hand is missing. If the link falls silent, the force is zero after 100 ms.
"""
