"""Hidden givens of lab 08; what is expected of them comes from the solution."""


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    uniform = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    return {
        "penalty_force": lambda: [
            {
                "gap": random.uniform(-4e-3, 2e-3, 12).tolist(),
                "rate": random.uniform(-1, 1, 12).tolist(),
                "k": uniform(100, 2000),
                "b": b,
            }
            for b in (0.0, uniform(0.5, 5))
        ],
        "stiffest_penalty": lambda: [
            {"m": uniform(0.005, 0.2), "M": uniform(0.05, 0.5), "h": uniform(1e-4, 3e-3)} for _ in range(3)
        ],
        "impact": lambda: [
            {"v": uniform(-2, -0.1), "w": uniform(0, 1), "m": uniform(0.005, 0.2), "M": M, "e": e}
            for M, e in ((uniform(0.05, 0.5), uniform(0.2, 0.9)), (uniform(0.05, 0.5), 0.0), (1e5, uniform(0.2, 1)))
        ],
        "pulse_time": lambda: [{"p": uniform(1e-3, 0.1), "F_max": uniform(1, 9)} for _ in range(2)],
        "reaction": lambda: [
            {"a": a, "m": uniform(0.005, 0.3), "g": 9.81} for a in (uniform(-9, 9), uniform(-60, -11), uniform(1, 40))
        ],
        "largest_multiplier": lambda: [
            {"a": a, "e": uniform(0.3, 0.95), "g": g} for a, g in ((uniform(-5, -1), 9.81), (uniform(1, 9), 9.81), (-30.0, 1.62))
        ],
    }
