"""Hidden cases of lab 17."""

import numpy as np


def cases(random):
    """Return what each exercise is asked beside its public cases."""
    return {
        "lever": lambda: [_drawn(random, F=(-3, 3), m_1=(0.02, 0.2), m_2=(0.02, 0.2), N=(0.3, 4)) for _ in range(3)],
        "stiffest_spring": lambda: [
            _drawn(random, m_1=(0.02, 0.2), m_2=(0.02, 0.2), N=(0.3, 4), T=(2e-4, 3e-3)) for _ in range(3)
        ],
        "proxy": lambda: [{"x": _path(random, first), "x_o": 0.01} for first in (0.004, 0.016, -0.003, 0.03)],
        "rubbed": lambda: [{"x": _path(random, 0.0), **_drawn(random, K=(80, 400), F_c=(0.1, 0.8))} for _ in range(3)],
        "sampled_frequency": lambda: [
            {"v": factor * p / T, "p": p, "T": T}
            for p, T in ((random.uniform(5e-4, 3e-3), random.uniform(5e-4, 2e-3)),)
            for factor in random.uniform([0.1, 0.55, 1.1, 1.6, 2.55], [0.4, 0.9, 1.4, 1.9, 2.9])
        ],
        "largest_amplitude": lambda: [_drawn(random, b=(0.02, 2), T=(2e-4, 3e-3), p=(3e-4, 1e-2)) for _ in range(3)],
        "hand_force": lambda: [
            _drawn(random, a=(-3, 3), v=(0.05, 0.5), m=(0.03, 2), b=(0.1, 6), f_c=(0.02, 3), M=(0.03, 1)) for _ in range(3)
        ],
    }


def _drawn(random, **ranges):
    return {name: random.uniform(*ends) for name, ends in ranges.items()}


def _path(random, first):
    """Positions that pass 10 mm, in either direction, and come back."""
    phase = np.linspace(0, 4 * np.pi, 30)
    return (first + 0.02 * np.sin(phase) + random.uniform(-1e-3, 1e-3, 30) * (phase > 0)).tolist()
