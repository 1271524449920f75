"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

WRONG = [
    ("penalty_force", lambda gap, rate, k, b: np.where(gap < 0, -k * gap - b * rate, 0.0)),
    ("penalty_force", lambda gap, rate, k, b: np.maximum(0, -k * gap - b * rate)),
    ("stiffest_penalty", lambda m, M, h: m * (np.pi / (10 * h)) ** 2),
    ("impact", lambda v, w, m, M, e: {"v": -e * v, "w": w + (1 + e) * m * v / M, "p": -(1 + e) * m * v}),
    ("impact", lambda v, w, m, M, e: {
        "v": v + (1 + e) * (w - v), "w": w - (1 + e) * m * (w - v) / M, "p": (1 + e) * m * (w - v)}),
    ("pulse_time", lambda p, F_max: 2 * p / F_max),
    ("pulse_time", lambda p, F_max: p / F_max),
    ("reaction", lambda a, m, g: {"N": m * (g + a), "gap_acceleration": -g - a}),
    ("reaction", lambda a, m, g: {"N": m * g, "gap_acceleration": 0.0}),
    ("largest_multiplier", lambda a, e, g: np.linalg.det(
        [[1, (1 + e) / g], [(1 + e) * a, (1 + e) ** 2 * a / g + e**2]])),
    ("two_springs", "a"),
]  # fmt: skip
