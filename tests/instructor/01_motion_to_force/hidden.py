"""Hidden givens of lab 01; the expected values come from solution.py."""

import numpy as np

from hapticlab.course.variants import points

RANGES = {
    "m": (0.02, 0.5), "K": (50, 900), "b_c": (0.05, 2), "x(t)": (-0.02, 0.02), "v(t)": (-0.4, 0.4), "z": (-0.02, 0.02),
    "z'": (-0.4, 0.4),
}  # fmt: skip


def cases(random):
    """Return givens by exercise, drawn with a NumPy Generator."""
    return {
        "spring_damper_force": lambda: [
            {
                "x": random.uniform(-0.02, 0.02),
                "v": random.uniform(-0.3, 0.3),
                "k": random.uniform(50, 500),
                "b": random.uniform(0.1, 2),
            }
            for _ in range(3)
        ],
        "spring_damper": lambda: [
            {"x": _motion(random), "T": T, "values": {"k": random.uniform(50, 500), "b": random.uniform(0.1, 2)}}
            for T in (1e-3, 5e-4)
        ],
        "spring_and_damper": lambda: [_record(random) for _ in range(2)],
        "count_step": lambda: [
            {"m": random.uniform(0.02, 0.3), "metres_per_count": random.uniform(5e-6, 8e-4), "T": random.uniform(5e-4, 4e-3)}
            for _ in range(2)
        ],
        "mass_equation": lambda: [{"at": points(random, RANGES), "solve_for": "z''"}],
        "mass_on_coupler": lambda: [
            {
                "x": _motion(random, start),
                "T": 2e-3,
                "values": {"m": random.uniform(0.05, 0.2), "K": random.uniform(80, 400), "b_c": random.uniform(0.02, 0.5)},
                "channels": ["z"],
            }
            for start in (0.0, random.uniform(0.004, 0.01))
        ],
        "resonance": lambda: [
            {"m": random.uniform(0.02, 0.5), "K": random.uniform(50, 900), "b_c": random.uniform(0, 2)} for _ in range(2)
        ],
    }


def _motion(random, start=0.0):
    """Return a reach of random length from a start, with a pause and a step back [m]."""
    s = np.linspace(0, 1, 40)
    reach = start + random.uniform(0.005, 0.02) * s**3 * (10 - 15 * s + 6 * s * s)
    return [*reach.tolist(), *[float(reach[-1])] * 20, *[float(reach[-1]) - 0.003] * 20]


def _record(random):
    t = np.arange(60) * 1e-2
    x, v = 0.01 * np.sin(9 * t), 0.09 * np.cos(9 * t)
    F = random.uniform(80, 400) * x + random.uniform(0.2, 2) * v + random.normal(0, 0.01, 60)
    return {"x": x.tolist(), "v": v.tolist(), "F": F.tolist()}
