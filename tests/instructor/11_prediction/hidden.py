"""Hidden givens of lab 11; what is expected of them comes from the solution."""


def cases(random):
    """Return givens by exercise, drawn from a NumPy Generator."""
    draw = lambda low, high: float(random.uniform(low, high))  # noqa: E731
    wall = lambda: {  # noqa: E731
        "x": list(random.uniform(-3e-3, 6e-3, 10)),
        "values": {"k": draw(100, 2000), "x_o": draw(0, 2e-3)},
    }
    return {
        "half_sample_wall": lambda: [wall(), wall()],
        "ellis_wall": lambda: [wall(), wall()],
        "look_ahead": lambda: [{"T": draw(2e-4, 4e-3), "delay": draw(1e-4, 6e-3)} for _ in range(3)],
        "nyquist_damping": lambda: [
            {"taps": list(random.uniform(-1, 2, size)), "k": draw(50, 2000), "T": draw(2e-4, 2e-3)} for size in (1, 3, 4)
        ],
        "deadbeat_forces": lambda: [
            {
                "m": draw(0.02, 0.4), "T": draw(5e-4, 1e-2), "x": draw(-1e-3, 1e-3), "v": draw(-0.3, 0.3),
                "x_goal": draw(-1e-3, 1e-3), "v_goal": draw(-0.3, 0.3),
            }
            for _ in range(3)
        ],
    }  # fmt: skip
