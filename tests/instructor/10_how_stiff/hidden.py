"""Hidden cases of lab 10."""

import numpy as np


def cases(random):
    """Return what each exercise is asked beside its public cases."""
    return {
        "part_right": lambda: [_pair(random) for _ in range(3)],
        "staircase": lambda: [_answers(random, trials) for trials in (1, 25, 40)],
        "converges_to": lambda: [
            {"down": 3, "weight": 1.0},
            {"down": 1, "weight": random.uniform(1, 4)},
            {"down": 2, "weight": 0.74},
        ],
        "log_likelihood": lambda: [_answered(random) for _ in range(3)],
        "at_d_prime_1": lambda: [{"level": random.uniform(0.05, 0.5), "part": random.uniform(0.6, 0.95)} for _ in range(3)],
        "steps_between": lambda: [_span(random) for _ in range(3)],
    }


def _pair(random):
    k = random.uniform(50, 400)
    return {"k_1": k, "k_2": k * np.exp(random.uniform(-0.5, 0.5)), "weber": random.uniform(0.08, 0.4)}


def _answers(random, trials):
    right = (random.random(trials) < 0.7).astype(float)
    return {"answers": right.tolist(), "start": random.uniform(0.3, 0.8), "factor": random.uniform(1.1, 2.0)}


def _answered(random):
    levels = random.uniform(0.05, 0.6, 12)
    return {
        "threshold": random.uniform(0.1, 0.4),
        "levels": levels.tolist(),
        "right": (random.random(12) < 0.5 + levels / 2).astype(float).tolist(),
    }


def _span(random):
    low = random.uniform(10, 100)
    return {"k_low": low, "k_high": low * random.uniform(2, 40), "weber": random.uniform(0.08, 0.4)}
