"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

WRONG = [
    ("load_percent", lambda cycles, rest, T, hz: (cycles + rest) / (T * hz)),
    ("load_percent", lambda cycles, rest, T, hz: 100 * cycles / (T * hz)),
    ("step_for", lambda wanted, h, error, order: h * wanted / error),
    ("step_for", lambda wanted, h, error, order: h * (error / wanted) ** (1 / order)),
    ("wall_margin", lambda b, K, B, T, tau: b - K * T / 2 - B),
    ("wall_margin", lambda b, K, B, T, tau: b - K * T / 2 - B * T / (tau + T)),
    ("dominates", lambda mine, other: all(a <= b for a, b in zip(mine, other, strict=True)) and list(mine) != list(other)),
    ("dominates", lambda mine, other: mine[0] < other[0] and mine[1] < other[1] and mine[2] > other[2]),
    ("wall_design", {"T": 2e-3, "law": "zoh", "velocity": "backward"}),
    ("wall_design", {"T": 1.0, "law": "half_sample", "velocity": "filtered", "tau": 2e-3}),
    ("wall_design", {"T": 1e-3, "law": "ellis", "velocity": "backward"}),
    ("mass_design", {"method": "rk4", "T": 1e-3, "substeps": 1, "hold": "soh"}),
    ("mass_design", {"method": "rk4", "T": 1e-3, "substeps": 1, "hold": "zoh"}),
    ("mass_design", {"method": "euler", "T": 1e-3, "substeps": 1, "hold": "foh"}),
    ("bumper_design", {"method": "taylor", "T": 1e-3, "substeps": 1, "hold": "soh"}),
    ("bumper_design", {"method": "semi_implicit_euler", "T": 2e-3, "substeps": 1, "hold": "zoh"}),
]
