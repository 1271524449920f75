"""Hidden givens of lab 04; what is expected of them comes from the solution."""

import numpy as np


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    draw = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    interval = lambda name, value: {  # noqa: E731
        name: value, f"{name}_low": value * draw(0.7, 0.98), f"{name}_high": value * draw(1.02, 1.3),
    }  # fmt: skip
    handle = lambda coulomb: {"v0": draw(0.05, 1), "m": draw(0.02, 0.2), "b": draw(0.02, 1), "coulomb": coulomb}  # noqa: E731
    return {
        "compensating": lambda: [
            {
                "x": list(np.cumsum(random.uniform(-2e-5, 2e-5, 12))),
                "T": draw(2e-4, 2e-3),
                "values": {"viscous": draw(0, 2), "dry": draw(0, 2), "b": draw(0.05, 1), "f_c": draw(0.01, 0.2), "speed": 5e-3},
            }
            for _ in range(2)
        ],
        "coast": lambda: [handle(draw(0.01, 0.2)), handle(draw(0.01, 0.2)), handle(0.0)],
        "cycle_amplitude": lambda: [{"g": draw(0.001, 0.1), "k": draw(5, 300), "kept": draw(0.2, 0.98)} for _ in range(3)],
        "onset": lambda: [{"kept": draw(0.1, 0.99)} for _ in range(3)],
        "safe_fractions": lambda: [interval("b", draw(0.05, 1)) | interval("coulomb", draw(0.01, 0.2)) for _ in range(2)],
        "stiffest_passive": lambda: (
            [
                {"b": draw(0.05, 0.3), "b_added": draw(0.2, 1), "B": sign * draw(0, 0.24), "T": draw(2e-4, 2e-3)}
                for sign in (1, -1)
            ]
            + [{"b": 0.1, "b_added": 0.1, "B": -draw(0.3, 0.5), "T": 1e-3}]
        ),
        "free_air_wall": lambda: [
            {
                "x": list(random.uniform(-3e-3, 6e-3, 10)),
                "T": draw(2e-4, 2e-3),
                "values": {"k": draw(100, 2000), "x_o": draw(0, 2e-3), "B": draw(-0.5, 0.5)},
            }
            for _ in range(2)
        ],
    }
