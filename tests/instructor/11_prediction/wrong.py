"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

import hapticlab as hl
from hapticlab import n, x

k, x_o = hl.parameters("k x_o", units="N/m m")

WRONG = [
    ("half_sample_wall", hl.wall()),
    ("half_sample_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (2 * x(n) - x(n - 1) - x_o)))),
    ("half_sample_wall", hl.Scene(force=hl.when(x(n) > x_o, k * (1.5 * x(n) - 0.5 * x(n - 1) - x_o)))),
    ("half_sample_wall", hl.wall("ellis")),
    ("ellis_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (1.5 * x(n) - 0.5 * x(n - 1) - x_o)))),
    ("ellis_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (2.5 * x(n) - 2.5 * x(n - 1) + x(n - 2) - x_o)))),
    ("look_ahead", lambda T, delay: np.array([1 + delay / T, -delay / T])),
    ("look_ahead", lambda T, delay: np.array([2 + delay / T, -1 - delay / T])),
    ("look_ahead", lambda T, delay: np.array([1.5, -0.5])),
    ("look_ahead", lambda T, delay: np.array([1 + T / 2 + delay, -T / 2 - delay])),
    ("look_ahead", lambda T, delay: np.array([1.5 + delay / T, 0.5 + delay / T])),
    ("look_ahead", lambda T, delay: np.array([0.5 - delay / T, 0.5 + delay / T])),
    ("nyquist_damping", lambda taps, k, T: k * T * np.sum(taps) / 2),
    ("nyquist_damping", lambda taps, k, T: k * T * np.sum(taps * (-1.0) ** np.arange(len(taps)))),
    ("nyquist_damping", lambda taps, k, T: k * T * np.sum(np.abs(taps)) / 2),
    ("deadbeat_forces", lambda m, T, x, v, x_goal, v_goal: [
        (3 * m * (v - v_goal) / T - 2 * m * (x + 2 * T * v - x_goal) / T**2) / 2,
        (2 * m * (x + 2 * T * v - x_goal) / T**2 - m * (v - v_goal) / T) / 2]),
    ("which_law", "b"),
    ("which_law", "d"),
]  # fmt: skip
