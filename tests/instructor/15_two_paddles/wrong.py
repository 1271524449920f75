"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

import hapticlab as hl
from hapticlab import n, v, x

k, b = hl.parameters("k b", units="N/m N*s/m")
x_other, v_other = hl.parameters("x_other v_other", units="m m/s", values=(0, 0))

WRONG = [
    ("one_side", hl.Scene(force=k * (x_other - x(n)) + b * (v_other - v(n)))),
    ("one_side", hl.Scene(force=k * (x(n) - x_other) + b * (v(n) + v_other))),
    ("one_side", hl.Scene(force=k * (x(n) + x_other) + b * (v(n) - v_other))),
    ("one_side", hl.Scene(force=k * (x(n) - x_other) + b * (v_other - v(n)))),
    ("two_dampers", lambda k, b, d: [k * d, k * d]),
    ("two_dampers", lambda k, b, d: [k * d, b - k * d]),
    ("two_dampers", lambda k, b, d: [-k * d, 2 * b + k * d]),
    ("two_dampers", lambda k, b, d: [2 * k * d, 2 * b - 2 * k * d]),
    ("two_dampers", lambda k, b, d: [k * d + 2 * b, 2 * b - k * d]),
    ("highest_stiffness", lambda b_h, b, d: (b_h + 2 * b) / (2 * d)),
    ("highest_stiffness", lambda b_h, b, d: b_h / d),
    ("highest_stiffness", lambda b_h, b, d: (b_h + b) / d),
    ("felt_damping", lambda k, K, d: [d * k**2 / (k + K), -d * k * K / (k + K)]),
    ("felt_damping", lambda k, K, d: [2 * d * k**2 / (k + K), 2 * d * k * K / (k + K)]),
    ("felt_damping", lambda k, K, d: [2 * d * k, -2 * d * k * K / (k + K)]),
    ("felt_damping", lambda k, K, d: [2 * d * k**2 / (k + K), -2 * d * K]),
    ("wave_side", lambda b, v, w: [b * v + np.sqrt(2 * b) * w, np.sqrt(2 * b) * v + w]),
    ("wave_side", lambda b, v, w: [b * v - np.sqrt(b) * w, np.sqrt(b) * v - w]),
    ("wave_side", lambda b, v, w: [np.sqrt(2 * b) * v - w, b * v - np.sqrt(2 * b) * w]),
    ("repaying_damper", lambda heard, given, dx, T, alpha_max: min(alpha_max, (given - heard) / dx**2) if dx else 0.0),
    ("repaying_damper", lambda heard, given, dx, T, alpha_max: max(0.0, given - heard) * T / dx**2 if dx else 0.0),
    ("repaying_damper", lambda heard, given, dx, T, alpha_max: min(alpha_max, given * T / dx**2) if dx else 0.0),
    ("repaying_damper", lambda heard, given, dx, T, alpha_max: min(alpha_max, (given - heard) * T / dx**2) if dx else 0.0),
    ("gain", lambda silence, hold, fade: float(np.clip((silence - hold) / fade, 0, 1))),
    ("gain", lambda silence, hold, fade: (hold + fade - silence) / fade),
    ("gain", lambda silence, hold, fade: max(0.0, 1 - silence / (hold + fade))),
    ("gain", lambda silence, hold, fade: 1.0 if silence <= hold else 0.0),
    ("which_coupling", "a"),
    ("which_coupling", "b"),
    ("which_coupling", "c"),
]
