"""Answers of lab 09."""

import numpy as np

prediction_coasts = 30.0
prediction_slows = "damping at 0.4 m/s, friction at 0.1 m/s"
prediction_grip = 200.0


def coasting_speed(t, v0, m, b, coulomb):
    """Return the speed [m/s] of a coasting handle at the times t [s]; 0 once it has stopped."""
    heads_for = -coulomb / b
    return np.maximum(heads_for + (v0 - heads_for) * np.exp(-b / m * t), 0.0)


def coast_fit(t, x):
    """Return b/m [1/s] and coulomb/m [m/s^2] from the equation of motion integrated twice."""
    area = np.concatenate([[0], np.cumsum((x[1:] + x[:-1] - 2 * x[0]) / 2 * np.diff(t))])
    columns = np.column_stack([np.ones(len(t)), t, -area, -(t**2) / 2])
    found, *_ = np.linalg.lstsq(columns, x, rcond=None)
    return {"b/m": found[2], "coulomb/m": found[3]}


def mass_and_friction(A, rising, falling):
    """Return mass [kg] and Coulomb friction [N]: the accelerations add up to 2 A/m and differ by 2 coulomb/m."""
    m = 2 * A / (rising + falling)
    return {"m": m, "coulomb": m * (rising - falling) / 2}


what_95_means = "d"


def promised_stiffness(b_low, b_high, T, B):
    """Return the largest K [N/m] of Eq. (23.10) for the least damping that the interval allows."""
    return max(2 * (b_low - abs(B)) / T, 0.0)


def hand_constants(M, sigma, omega, m, b):
    """Return mass, damping and stiffness of the hand from the oscillation of handle and hand together."""
    return {"m": M - m, "b": 2 * M * sigma - b, "k": M * (omega**2 + sigma**2)}


which_window = "a"

discussion = (
    "One 95 % interval in twenty misses the true value, so one OUTSIDE among seven happens in about a third of all labs and is "
    "no reason to distrust the method; seven would be. If the paddle becomes warm, its damping changes because grease becomes "
    "thinner, and a loosened screw adds backlash, which the model does not contain. The interval describes only the noise of "
    "this recording and not the changes between two days, so it shows neither. The window of 60 ms shows that a model with "
    "enough freedom can fit data although it is wrong. Residuals that look like noise are necessary but not sufficient, and "
    "the time at which reflexes begin must come from another source."
)
