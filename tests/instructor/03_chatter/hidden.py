"""Hidden givens of lab 03; what is expected of them comes from the solution."""

import numpy as np


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    draw = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    return {
        "stability_estimate": lambda: [{"b": draw(0.05, 5), "T": draw(2e-4, 2e-3), "delay": draw(0, 3e-3)} for _ in range(3)],
        "limit_over_delay": lambda: [{"b": draw(0.05, 5), "T": draw(1e-3, 4e-3)} for _ in range(2)],
        "growth_per_sample": lambda: [{"m": draw(0.02, 0.3), "k": draw(50, 5000), "T": draw(2e-4, 2e-3)} for _ in range(3)],
        "late_wall": lambda: [
            {"x": list(random.uniform(-5e-3, 8e-3, 9)), "values": {"k": draw(100, 2000), "x_o": draw(0, 2e-3)}} for _ in range(2)
        ],
        "chatter_frequency": lambda: [_swing(random) for _ in range(3)],
        "threshold_speed": lambda: [
            {"k": draw(3000, 9000), "b": draw(0.2, 1.4), "T": 1e-3, "f_c": draw(0.005, 0.2)} for _ in range(3)
        ],
        "quantised_limit": lambda: [
            {"b": draw(0.02, 0.5), "T": 1e-3, "f_c": f_c, "resolution": draw(1e-5, 8e-4)}
            for f_c in (draw(0.05, 0.2), draw(0, 2e-3))
        ],
    }


def _swing(random):
    """One second of an oscillation that sits off zero, with a little of its third harmonic."""
    t = np.arange(1000) * 1e-3
    turn = 2 * np.pi * random.uniform(18, 70) * t + random.uniform(0, 6)
    x = 1e-3 * random.uniform(-5, 5) + 1e-3 * random.uniform(0.1, 1) * (np.sin(turn) + 0.1 * np.sin(3 * turn))
    return {"t": t.tolist(), "x": x.tolist()}
