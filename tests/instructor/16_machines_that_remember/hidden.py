"""Hidden cases of lab 16."""

import numpy as np


def cases(random):
    """Return what each exercise is asked beside its public cases."""
    return {
        "switch": lambda: [{"x": _path(random, 0.002, 0.012), "values": _switch(random)} for _ in range(3)],
        "lost": lambda: [_switch(random) for _ in range(3)],
        "gear": lambda: [{"x": _path(random, -0.01, 0.01), "values": _gear(random)} for _ in range(3)],
        "gear_lost": lambda: [{**_gear(random), "X": random.uniform(0.001, 0.02)} for _ in range(4)],
        "period": lambda: [_relay(random) for _ in range(3)],
        "latch": lambda: [_latch(random) for _ in range(3)],
        "remembered": lambda: [_counts(random) for _ in range(5)],
    }


def _path(random, low, high):
    return random.uniform(low, high, 24).tolist()


def _switch(random):
    x_off = random.uniform(0.004, 0.006)
    return {
        "k": random.uniform(50, 300),
        "d": random.uniform(0.001, 0.004),
        "x_on": x_off + random.uniform(0.001, 0.003),
        "x_off": x_off,
    }


def _gear(random):
    return {"k": random.uniform(80, 300), "F_c": random.uniform(0.05, 0.3), "g": random.uniform(0.001, 0.006)}


def _relay(random):
    low = random.uniform(10, 20)
    return {
        "tau": random.uniform(0.2, 3),
        "hot": random.uniform(30, 60),
        "low": low,
        "high": low + random.uniform(1, 6),
    }


def _latch(random):
    return {"set": _bits(random), "reset": _bits(random), "q": int(random.integers(2))}


def _bits(random):
    return (random.random(16) < 0.4).astype(int).tolist()


def _counts(random):
    count = random.uniform(1e-5, 2e-4)
    x_off = count * (np.floor(random.uniform(20, 100)) + random.uniform(0.1, 0.9))
    return {"x_off": x_off, "x_on": x_off + count * random.uniform(0.2, 5), "count": count}
