"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

WRONG = [
    ("step_matrix", lambda m, K, b, h: [[1, h], [-h * K / m, 1 - h * b / m]]),
    ("step_matrix", lambda m, K, b, h: [[1 - h**2 * K / m, h], [-h * K / m, 1 - h * b / m]]),
    ("euler_growth", lambda m, K, b, h: 1 - h * b / m + h**2 * K / m),
    ("euler_growth", lambda m, K, b, h: 2 - h * b / m),
    ("longest_step", lambda m, K, b: 2 * np.sqrt(m / K)),
    ("longest_step", lambda m, K, b: (-b + np.sqrt(b**2 + 4 * K * m)) / (2 * K)),
    ("order_seen", lambda h, error: np.polyfit(np.log(error), np.log(h), 1)[0]),
    ("order_seen", lambda h, error: np.polyfit(h, error, 1)[0]),
    ("shortest_period", lambda cycles, rest, load, hz: (cycles + rest) / hz),
    ("shortest_period", lambda cycles, rest, load, hz: (cycles + rest) * load / hz),
    ("why_order_one", "a"),
]  # fmt: skip
