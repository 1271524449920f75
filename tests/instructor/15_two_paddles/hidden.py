"""Hidden givens of lab 15; what is expected of them comes from the solution."""


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    draw = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    side = lambda: {  # noqa: E731
        "x": list(random.uniform(-0.02, 0.02, 6)),
        "v": list(random.uniform(-0.3, 0.3, 6)),
        "values": {"k": draw(10, 300), "b": draw(0.1, 2), "x_other": draw(-0.01, 0.01), "v_other": draw(-0.2, 0.2)},
    }
    return {
        "one_side": lambda: [side(), side()],
        "two_dampers": lambda: [{"k": draw(10, 300), "b": draw(0, 2), "d": draw(1e-3, 0.1)} for _ in range(3)],
        "highest_stiffness": lambda: [{"b_h": draw(0.1, 3), "b": draw(0, 2), "d": draw(1e-3, 0.05)} for _ in range(3)],
        "felt_damping": lambda: [{"k": draw(10, 300), "K": draw(0, 500), "d": draw(1e-3, 0.1)} for _ in range(3)],
        "wave_side": lambda: [{"b": draw(0.1, 4), "v": draw(-0.4, 0.4), "w": draw(-0.4, 0.4)} for _ in range(3)],
        "repaying_damper": lambda: [
            {
                "heard": draw(0, 4e-3),
                "given": given,
                "dx": draw(2e-4, 2e-3) * sign,
                "T": draw(5e-4, 2e-3),
                "alpha_max": draw(1, 9),
            }
            for given, sign in ((0.005, 1), (0.0041, -1), (0.0, 1), (0.02, -1))
        ],
        "gain": lambda: [
            {"silence": hold + fade * part, "hold": hold, "fade": fade}
            for part in (-0.3, draw(0.1, 0.9), draw(1.1, 3))
            for hold, fade in [(draw(0.02, 0.1), draw(0.02, 0.1))]
        ],
    }
