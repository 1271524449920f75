"""Hidden cases of lab 09."""

import numpy as np


def cases(random):
    """Return what each exercise is asked beside its public cases."""
    return {
        "coasting_speed": lambda: [
            _coast(random, coulomb) for coulomb in (0.0, random.uniform(0.01, 0.1), random.uniform(0.01, 0.1))
        ],
        "coast_fit": lambda: [_record(random) for _ in range(3)],
        "mass_and_friction": lambda: [_thrown(random) for _ in range(2)],
        "promised_stiffness": lambda: [
            _interval(random, B) for B in (0.0, random.uniform(0, 0.05), -random.uniform(0, 0.05), 0.5)
        ],
        "hand_constants": lambda: [_swing(random) for _ in range(2)],
    }


def _coast(random, coulomb):
    return {
        "t": np.sort(random.uniform(0, 0.6, 8)).tolist(),
        "v0": random.uniform(0.1, 0.6),
        "m": random.uniform(0.02, 0.2),
        "b": random.uniform(0.05, 0.3),
        "coulomb": coulomb,
    }


def _record(random):
    """Positions of a handle that coasts, in an encoder's counts with noise, until shortly before it stops."""
    beta, gamma, v0, T = (
        random.uniform(2, 8),
        random.uniform(0.8, 3),
        random.uniform(0.3, 0.5),
        random.choice([5e-4, 1e-3]),
    )
    ends = np.log1p(beta * v0 / gamma) / beta
    t = np.arange(0, 0.95 * ends, T)
    x = (v0 + gamma / beta) * -np.expm1(-beta * t) / beta - gamma / beta * t
    counts = np.floor((x + 6e-6 * random.standard_normal(len(x))) / 12.8e-6)
    return {"t": t.tolist(), "x": (12.8e-6 * (counts - counts[0])).tolist()}


def _thrown(random):
    A, coulomb, m = random.uniform(0.1, 0.5), random.uniform(0.01, 0.08), random.uniform(0.02, 0.2)
    return {"A": A, "rising": (A + coulomb) / m, "falling": (A - coulomb) / m}


def _interval(random, B):
    low = random.uniform(0.08, 0.2)
    return {"b_low": low, "b_high": low + random.uniform(0.005, 0.05), "T": random.choice([5e-4, 1e-3, 2e-3]), "B": B}


def _swing(random):
    m = random.uniform(0.02, 0.05)
    return {
        "M": m + random.uniform(0.01, 0.1),
        "sigma": random.uniform(12, 30),
        "omega": random.uniform(40, 90),
        "m": m,
        "b": random.uniform(0.05, 0.2),
    }
