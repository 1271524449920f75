"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np


def turned_back(t, v0, m, b, coulomb):
    return -coulomb / b + (v0 + coulomb / b) * np.exp(-b / m * t)


def half_is_missing(t, x):
    area = np.concatenate([[0], np.cumsum((x[1:] + x[:-1] - 2 * x[0]) / 2 * np.diff(t))])
    found, *_ = np.linalg.lstsq(np.column_stack([np.ones(len(t)), t, -area, -(t**2)]), x, rcond=None)
    return {"b/m": found[2], "coulomb/m": found[3]}


WRONG = [
    ("coasting_speed", turned_back),
    ("coasting_speed", lambda t, v0, m, b, coulomb: v0 * np.exp(-b / m * t)),
    ("coasting_speed", lambda t, v0, m, b, coulomb: np.maximum(v0 - coulomb / m * t, 0.0)),
    ("coast_fit", half_is_missing),
    ("coast_fit", lambda t, x: dict(zip(("b/m", "coulomb/m"), -np.polyfit(
        np.gradient(x, t), np.gradient(np.gradient(x, t), t), 1), strict=True))),
    ("mass_and_friction", lambda A, rising, falling: {"m": A / rising, "coulomb": A * (rising - falling) / 2}),
    ("promised_stiffness", lambda b_low, b_high, T, B: 2 * (b_high - abs(B)) / T),
    ("promised_stiffness", lambda b_low, b_high, T, B: 2 * b_low / T),
    ("promised_stiffness", lambda b_low, b_high, T, B: max(2 * ((b_low + b_high) / 2 - abs(B)) / T, 0.0)),
    ("hand_constants", lambda M, sigma, omega, m, b: {"m": M, "b": 2 * M * sigma, "k": M * (omega**2 + sigma**2)}),
    ("what_95_means", "a"),
    ("which_window", "b"),
]  # fmt: skip
