"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

import hapticlab as hl
from hapticlab import n, x

k, x_o = hl.parameters("k x_o", units="N/m m")

B = hl.parameters("B", units="N*s/m", ranges=(-1, 1))

WRONG = [
    ("half_sample_wall", hl.wall()),
    ("half_sample_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (2 * x(n) - x(n - 1) - x_o)))),
    ("half_sample_wall", hl.Scene(force=hl.when(x(n) > x_o, k * (1.5 * x(n) - 0.5 * x(n - 1) - x_o)))),
    ("half_sample_wall", hl.wall("ellis")),
    ("ellis_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (1.5 * x(n) - 0.5 * x(n - 1) - x_o)))),
    ("nyquist_damping", lambda taps, k, T: k * T * np.sum(taps) / 2),
    ("stiffest_passive", lambda b, b_added, B, T: max(0, 2 * (b + b_added + B) / T)),
    ("free_air_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)) + B * (x(n) - x(n - 1)) / hl.T)),
    ("free_air_wall", hl.Scene(force=hl.when(x(n) >= x_o, B * (x(n) - x(n - 1)) / hl.T, k * (x(n) - x_o)))),
    ("free_air_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o), B * (x(n - 1) - x(n - 2)) / hl.T))),
    ("deadbeat_forces", lambda m, T, x, v, x_goal, v_goal: [
        (3 * m * (v - v_goal) / T - 2 * m * (x + 2 * T * v - x_goal) / T**2) / 2,
        (2 * m * (x + 2 * T * v - x_goal) / T**2 - m * (v - v_goal) / T) / 2]),
    ("which_law", "b"),
]  # fmt: skip
