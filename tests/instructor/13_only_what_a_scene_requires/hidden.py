"""Hidden cases of lab 13."""

import numpy as np

CASE = {"T": 1e-3, "method": "semi_implicit_euler"}


def cases(random):
    """Return what each exercise is asked beside its public cases."""
    return {
        "needed": lambda: [_graph(random, states) for states in (4, 6, 8)],
        "felt_ratio": lambda: [_forces(random) for _ in range(3)],
        "shaken": lambda: [_grooves(random) for _ in range(3)],
        "speed_noticed": lambda: [_drag(random) for _ in range(4)],
        "highest_frequency": lambda: [_masses(random) for _ in range(3)],
        "rigid": lambda: [{"x": _path(random), **CASE, "values": _values(random)} for _ in range(2)],
    }


def _graph(random, states):
    uses = (random.random((states, states)) < 0.25).astype(int)
    force = np.zeros(states, int)
    force[random.integers(states)] = 1
    return {"uses": uses.tolist(), "force": force.tolist()}


def _forces(random):
    full = random.uniform(-2, 2, 23)
    return {
        "full": full.tolist(),
        "smaller": (full + random.uniform(-0.1, 0.1, 23)).tolist(),
        "least": random.uniform(0.02, 0.06),
        "weber": random.uniform(0.05, 0.2),
        "rows": int(random.integers(4, 8)),
    }


def _grooves(random):
    given = {"A": (0.005, 0.05), "p": (5e-4, 3e-3), "speed": (0.01, 0.2), "m": (0.03, 0.1), "b": (0.5, 3), "k": (100, 600)}
    return {name: random.uniform(*ends) for name, ends in given.items()}


def _drag(random):
    return {"b": random.uniform(0.2, 6), "c": random.uniform(0.5, 6), "least": random.uniform(0.01, 0.06), "weber": 0.1}


def _masses(random):
    given = {"m_1": (0.03, 0.2), "m_2": (0.02, 0.3), "k": (50, 500), "weber": (0.05, 0.2)}
    return {name: random.uniform(*ends) for name, ends in given.items()}


def _path(random):
    return np.cumsum(random.uniform(-4e-4, 6e-4, 24)).tolist()


def _values(random):
    return {"K": random.uniform(100, 300), "b_c": random.uniform(0.2, 0.8)}
