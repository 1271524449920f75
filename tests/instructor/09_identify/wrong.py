"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np


def turned_back(t, v0, m, b, coulomb):
    return -coulomb / b + (v0 + coulomb / b) * np.exp(-b / m * t)


WRONG = [
    ("coasting_speed", turned_back),
    ("coast_fit", lambda t, x: dict(zip(("b/m", "coulomb/m"), -np.polyfit(
        np.gradient(x, t), np.gradient(np.gradient(x, t), t), 1), strict=True))),
    ("mass_and_friction", lambda A, rising, falling: {"m": A / rising, "coulomb": A * (rising - falling) / 2}),
    ("promised_stiffness", lambda b_low, b_high, T, B: 2 * (b_high - abs(B)) / T),
    ("promised_stiffness", lambda b_low, b_high, T, B: 2 * b_low / T),
    ("hand_constants", lambda M, sigma, omega, m, b: {"m": M, "b": 2 * M * sigma, "k": M * (omega**2 + sigma**2)}),
    ("what_95_means", "a"),
    ("which_window", "b"),
]  # fmt: skip
