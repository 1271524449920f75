"""Hidden givens of lab 07; what is expected of them comes from the solution."""

import numpy as np


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    uniform = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    part = lambda: {"m": uniform(0.02, 0.3), "K": uniform(100, 1500), "b": uniform(0.05, 1.0)}  # noqa: E731
    return {
        "step_matrix": lambda: [{**part(), "h": uniform(1e-3, 4e-3)} for _ in range(3)],
        "euler_growth": lambda: [{**part(), "h": uniform(1e-4, 2e-3)} for _ in range(3)],
        "longest_step": lambda: [*(part() for _ in range(3)), {"m": 0.1, "K": uniform(100, 900), "b": 0.0}],
        "order_seen": lambda: [_measured(random, order, points) for order, points in ((1.0, 4), (2.0, 5), (3.7, 3))],
        "shortest_period": lambda: [
            {"cycles": uniform(2e3, 4e4), "rest": uniform(2e3, 9e3), "load": uniform(0.3, 0.9), "hz": hz} for hz in (16e6, 48e6)
        ],
    }


def _measured(random, order, points):
    h = 4e-3 / 2.0 ** np.arange(points)
    error = random.uniform(10, 1000) * h**order * random.uniform(0.9, 1.1, points)
    return {"h": h.tolist(), "error": error.tolist()}
