"""Hidden givens of lab 06; the expected values come from solution.py."""

import numpy as np


def cases(random):
    """Return givens by exercise, drawn with a NumPy Generator."""
    return {
        "euler_step": lambda: [_state(random) for _ in range(3)],
        "pendulum": lambda: [_swing(random, start) for start in (0.0, random.uniform(0.004, 0.01))],
        "coupler_stiffness": lambda: [
            {"b": random.uniform(0.2, 3), "T": random.uniform(2e-4, 4e-3), "b_c": random.uniform(0.01, 0.15)} for _ in range(3)
        ],
        "felt_wall": lambda: [{"K": random.uniform(50, 900), "k": random.uniform(50, 5000)} for _ in range(2)],
        "longest_period": lambda: [{}],
        "swing_frequency": lambda: [
            {
                "l": random.uniform(0.05, 0.4),
                "g": random.uniform(1.6, 9.81),
                "M": random.uniform(0.02, 0.2),
                "m": random.uniform(0.02, 0.2),
                "K": random.uniform(5, 300),
            }
            for _ in range(3)
        ],
    }


def numbers(random):
    """Return a student's own numbers."""
    return {"K_WALL": 25.0 + 50.0 * random.integers(30, 80), "K_FELT": 10.0 * random.integers(40, 100)}


def _state(random):
    ranges = {"z": 0.02, "w": 0.5, "x": 0.02, "v": 0.5}
    moving = {name: random.uniform(-most, most) for name, most in ranges.items()}
    body = {"m": random.uniform(0.02, 0.2), "K": random.uniform(50, 500), "b_c": random.uniform(0.01, 0.5)}
    return {**moving, **body, "T": random.uniform(5e-4, 4e-3)}


def _swing(random, start):
    """Return a handle that is led to and fro about a start [m], and a pendulum of random size behind a soft coupler."""
    x = start + random.uniform(0.005, 0.02) * np.sin(random.uniform(3, 9) * 0.01 * np.arange(50))
    values = {
        "M": random.uniform(0.03, 0.1),
        "m": random.uniform(0.03, 0.1),
        "l": random.uniform(0.1, 0.3),
        "g": 9.81,
        "c": random.uniform(1e-4, 2e-3),
        "K": random.uniform(60, 150),
        "b_c": random.uniform(0.02, 0.3),
    }
    return {"x": x.tolist(), "T": 1e-2, "values": values, "channels": ["theta"]}
