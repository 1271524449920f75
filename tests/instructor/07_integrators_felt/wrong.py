"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

WRONG = [
    ("step_matrix", lambda m, K, b, h: [[1, h], [-h * K / m, 1 - h * b / m]]),
    ("euler_growth", lambda m, K, b, h: 1 - h * b / m + h**2 * K / m),
    ("longest_step", lambda m, K, b: 2 * np.sqrt(m / K)),
    ("order_seen", lambda h, error: np.polyfit(np.log(error), np.log(h), 1)[0]),
    ("shortest_period", lambda cycles, rest, load, hz: (cycles + rest) / hz),
    ("why_order_one", "a"),
]  # fmt: skip
