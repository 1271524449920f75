"""Hidden givens of lab 00; the expected values come from solution.py."""

import numpy as np


def cases(random):
    """Return givens by exercise, drawn with a NumPy Generator."""
    return {
        "handle_position": lambda: [_stops(random, turned) for turned in (False, True, False)],
        "sign_evidence": lambda: [_tosses(random) for _ in range(3)],
        "force_full": lambda: [_scale(random) for _ in range(3)],
        "motor_current": lambda: [_drive(random) for _ in range(3)],
        "felt_stiffness": lambda: [_spring(random) for _ in range(2)],
        "limits": lambda: [
            {
                "k": random.uniform(50, 900),
                "metres_per_count": random.uniform(5e-6, 8e-4),
                "force_max": random.uniform(2, 10),
                "T": random.uniform(2e-4, 4e-3),
            }
            for _ in range(2)
        ],
    }


def _stops(random, turned):
    left = float(random.integers(-9000, 9000))
    span = float(random.integers(3000, 8000)) * (-1 if turned else 1)
    counts = left + span * random.uniform(0, 1, 5)
    return {"counts": counts.tolist(), "left": left, "right": left + span, "travel": random.uniform(0.06, 0.12)}


def _tosses(random):
    asked, on = random.uniform(-0.5, 0.5, 30), random.integers(0, 2, 30)
    moved = asked * on * 3e-3 + random.normal(0, 1e-3, 30)
    return {"asked": asked.tolist(), "moved": moved.tolist(), "on": on.tolist()}


def _scale(random):
    duty = np.linspace(0, random.uniform(0.4, 0.7), 6)
    grams = random.uniform(-8, 8) + random.uniform(4, 9) / 9.80665e-3 * duty**2 + random.normal(0, 0.5, 6)
    return {"duty": duty.tolist(), "grams": grams.round().tolist()}


def _drive(random):
    """A drive, and forces of both signs of which about half are more than it can give."""
    built = {
        "drum": random.uniform(0.003, 0.007),
        "sector": random.uniform(0.06, 0.09),
        "handle": random.uniform(0.05, 0.1),
        "torque_constant": random.uniform(0.01, 0.06),
        "supply": random.uniform(5, 24),
        "resistance": random.uniform(2, 15),
    }
    jacobian = built["drum"] * built["handle"] / built["sector"]
    most = built["supply"] / built["resistance"] * built["torque_constant"] / jacobian
    return {"force": (most * random.uniform(-2, 2, 6)).tolist(), **built}


def _spring(random):
    x = random.uniform(-0.015, 0.015, 40)
    F = random.uniform(100, 600) * x + random.normal(0, 0.02, 40)
    return {"x": x.tolist(), "F": F.tolist()}
