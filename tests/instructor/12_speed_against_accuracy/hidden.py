"""Hidden givens of lab 12; what is expected of them comes from the solution.

Scenes are drawn from a few, whose reference points a grader then measures once for a whole class.
"""

WALLS = [{"K": 380.0, "B": 1.5}, {"K": 620.0, "B": 2.4}, {"K": 450.0, "B": 2.4}, {"K": 560.0, "B": 1.4}]
MASSES = [{"m": 0.04, "K": 600.0}, {"m": 0.07, "K": 950.0}, {"m": 0.06, "K": 700.0}, {"m": 0.04, "K": 900.0}]
BUMPERS = [{"m": 0.025, "k_b": 1100.0}, {"m": 0.04, "k_b": 1900.0}, {"m": 0.035, "k_b": 1300.0}, {"m": 0.026, "k_b": 1300.0}]
#: scenes of a task in which a design must be good
SCENES = 2


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    uniform = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    figures = lambda: [uniform(0.5, 3), uniform(20, 80), uniform(-1, 1)]  # noqa: E731
    return {
        "load_percent": lambda: [
            {"cycles": uniform(2e3, 4e4), "rest": uniform(2e3, 9e3), "T": uniform(5e-4, 4e-3), "hz": hz} for hz in (16e6, 48e6)
        ],
        "step_for": lambda: [
            {"wanted": uniform(0.1, 1), "h": uniform(1e-3, 4e-3), "error": uniform(2, 9), "order": order} for order in (1, 2, 3)
        ],
        "wall_margin": lambda: [
            {
                "b": uniform(0.2, 2),
                "K": uniform(100, 900),
                "B": uniform(0.2, 3),
                "T": uniform(5e-4, 2e-3),
                "tau": uniform(1e-3, 9e-3),
            }
            for _ in range(3)
        ],
        "dominates": lambda: [_pair(random, figures(), kind) for kind in ("better", "one worse", "one equal", "margin")],
        "wall_design": lambda: _scenes(random, "wall", WALLS),
        "mass_design": lambda: _scenes(random, "mass", MASSES),
        "bumper_design": lambda: _scenes(random, "bumper", BUMPERS),
    }


def _scenes(random, task, several):
    return [{"task": task, **several[int(k)]} for k in random.permutation(len(several))[:SCENES]]


def _pair(random, mine, kind):
    """Return two designs: mine better in all, worse in one, equal in one, or better in all but the margin."""
    worse = [mine[0] * random.uniform(1.1, 2), mine[1] * random.uniform(1.1, 2), mine[2] - random.uniform(0.1, 1)]
    if kind == "one worse":
        worse[0] = mine[0] * random.uniform(0.3, 0.9)
    if kind == "one equal":
        worse[1] = mine[1]
    if kind == "margin":
        worse[2] = mine[2] + random.uniform(0.1, 1)
    return {"mine": [float(one) for one in mine], "other": [float(one) for one in worse]}
