"""Hidden givens of lab 02; what is expected of them comes from the solution."""

import numpy as np


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    stiffness = lambda: float(random.uniform(50, 3000))  # noqa: E731
    displacement = lambda: float(random.choice([-1, 1]) * random.uniform(2e-5, 4e-4))  # noqa: E731
    return {
        "held_work": lambda: [{"k": stiffness(), "x": float(random.uniform(5e-4, 5e-3)), "D": displacement()} for _ in range(3)],
        "period_leak": lambda: [{"k": stiffness(), "D": displacement()} for _ in range(3)],
        "bounce_gain": lambda: [
            {"k": stiffness(), "m": float(random.uniform(0.02, 0.3)), "T": float(random.uniform(2e-4, 2e-3))} for _ in range(3)
        ],
        "energy_generated": lambda: [{"x": _contacts(random), "k": stiffness()} for _ in range(3)],
        "two_walls": lambda: [
            {
                "x": list(random.uniform(-8e-3, 8e-3, 9)),
                "values": {"k": stiffness(), "x_o": float(random.uniform(1e-3, 4e-3))},
            }
            for _ in range(2)
        ],
        "damping_that_pays": lambda: [{}],
    }


def numbers(random):
    """Return a student's own numbers; none gives the answer to those that came with the lab."""
    return {"K_OWN": 10.0 * random.integers(20, 90), "T_OWN": random.choice([0.6e-3, 0.7e-3, 1.1e-3, 1.3e-3, 1.7e-3])}


def _contacts(random):
    """Return positions of two contacts of different depth, outside before, between and after [m]."""
    once = np.sin(np.pi * np.linspace(-0.1, 1.1, 30))
    return [float(depth * place) for depth in random.uniform(0.5e-3, 4e-3, 2) for place in once]
