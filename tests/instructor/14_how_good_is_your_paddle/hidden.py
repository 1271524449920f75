"""Hidden cases of lab 14."""


def cases(random):
    """Return what each exercise is asked beside its public cases."""
    return {
        "buzz_border": lambda: [{"count": random.uniform(5e-6, 2e-4), "felt": random.uniform(0.01, 0.2)} for _ in range(3)],
        "border": lambda: [_late(random) for _ in range(4)],
        "choose": lambda: [_table(random) for _ in range(5)],
        "effective": lambda: [_impedance(random) for _ in range(3)],
        "same_up_to": lambda: [_off(random) for _ in range(3)] + [{"f": [2.0, 5.0], "off": [0.3, 0.1], "weber": 0.2}],
        "same_damping": lambda: [_damping(random) for _ in range(3)],
    }


def _late(random):
    return {
        "b": random.uniform(1, 2),
        "B": random.uniform(0.2, 1),
        "late": random.uniform(2e-4, 3e-3),
        "f": random.uniform(20, 90),
        "gain": random.uniform(0.4, 1),
        "lag": random.uniform(1e-3, 8e-3),
    }


def _table(random):
    return {
        "lag": random.uniform(2e-4, 6e-3, 5).tolist(),
        "noise": random.uniform(1e-3, 2e-2, 5).tolist(),
        "cycles": random.integers(900, 20_000, 5).astype(float).tolist(),
        "B": random.uniform(1, 8),
        "felt": random.uniform(0.02, 0.08),
        "most_cycles": random.uniform(4000, 16_000),
    }


def _impedance(random):
    return {
        "f": sorted(random.uniform(1, 200, 4).tolist()),
        "real": random.uniform(-0.3, 1, 4).tolist(),
        "imaginary": random.uniform(-10, 0, 4).tolist(),
    }


def _off(random):
    return {
        "f": sorted(random.uniform(1, 300, 6).tolist()),
        "off": random.uniform(0.02, 0.4, 6).tolist(),
        "weber": random.uniform(0.15, 0.35),
    }


def _damping(random):
    return {
        "b": random.uniform(0.05, 0.5),
        "B": random.uniform(0.1, 1),
        "late": random.uniform(3e-4, 3e-3),
        "weber": random.uniform(0.1, 0.4),
    }
