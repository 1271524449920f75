"""Hidden givens of lab 05; what is expected of them comes from the solution."""

import numpy as np


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    uniform = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    way = lambda: float(random.choice([-1, 1]) * random.uniform(2e-5, 4e-4))  # noqa: E731
    return {
        "period_energy": lambda: [
            {
                "x": uniform(1e-3, 5e-3), "D": way(), "K": uniform(50, 2000), "b": uniform(0.02, 1),
                "T": uniform(2e-4, 4e-3),
            }
            for _ in range(3)
        ],
        "damper_gives": lambda: [
            {"D": way(), "B": sign * uniform(0.05, 0.4), "T": uniform(2e-4, 4e-3)} for sign in (1, -1, 1)
        ],
        "observed_energy": lambda: [_record(random, length) for length in (2, 9, 40)],
        "damping_asked": lambda: [
            {"taps": random.uniform(-200, 400, length).tolist(), "theta": uniform(0.2, np.pi), "T": uniform(2e-4, 4e-3)}
            for length in (1, 2, 4)
        ],
        "disk_size": lambda: [
            {"K": uniform(20, 900), "theta": theta, "b": uniform(0.05, 0.6), "T": uniform(2e-4, 2e-3)}
            for theta in (uniform(0.1, 1.0), uniform(1.0, 3.0), np.pi)
        ],
        "controlled_force": lambda: [
            {"f": uniform(-1, 2), "credit": credit, "D": D, "T": 1e-3, "alpha_max": alpha_max}
            for credit, D, alpha_max in (
                (-uniform(1e-6, 1e-5), way(), 1e3), (-uniform(1e-4, 1e-3), way(), uniform(0.5, 3)),
                (uniform(1e-6, 1e-3), way(), 5.0), (-1e-5, 0.0, 5.0), (0.0, way(), 5.0),
            )
        ],
    }  # fmt: skip


def _record(random, length):
    x = np.cumsum(random.uniform(-3e-4, 3e-4, length))
    return {"x": x.tolist(), "F": (random.uniform(50, 800) * np.maximum(x, 0)).tolist()}
