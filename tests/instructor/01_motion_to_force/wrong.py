"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x

k, b, m, K, b_c = hl.parameters("k b m K b_c", units="N/m N*s/m kg N/m N*s/m")
z = hl.coordinate("z", unit="m", initial=x(n))


def on_coupler(force_sign, mass_sign, z=z):
    F_c = K * (x(t) - z) + b_c * (v(t) - z.diff(t))
    return hl.Scene(force=force_sign * F_c, eom=[sp.Eq(m * z.diff(t, 2), mass_sign * F_c)], watch=[z])


def mass_moves(force):
    return sp.Eq(m * z.diff(t, 2), force)


WRONG = [
    ("spring_damper_force", lambda x, v, k, b: -k * x - b * v),
    ("spring_damper_force", lambda x, v, k, b: k * x - b * v),
    ("spring_damper_force", lambda x, v, k, b: 1000 * k * x + b * v),
    ("spring_damper", hl.Scene(force=k * x(n) - b * v(n))),
    ("spring_and_damper", lambda x, v, F: {"k": np.sum(F * x) / np.sum(x * x), "b": np.sum(F * v) / np.sum(v * v)}),
    ("spring_and_damper", lambda x, v, F: dict(zip("bk", np.linalg.lstsq(np.c_[x, v], F, rcond=None)[0], strict=True))),
    ("count_step", lambda m, metres_per_count, T: m * metres_per_count / T),
    ("mass_equation", mass_moves(K * (z - x(t)) + b_c * (z.diff(t) - v(t)))),
    ("mass_equation", mass_moves(K * (x(t) - z) + b_c * (z.diff(t) - v(t)))),
    ("mass_equation", mass_moves(K * (x(t) - z) - b_c * z.diff(t))),
    ("mass_equation", mass_moves(K * (z - x(t)) + b_c * (v(t) - z.diff(t)))),
    ("mass_equation", mass_moves(K * (x(t) + z) + b_c * (v(t) + z.diff(t)))),
    ("mass_equation", mass_moves(K * (x(t) - z) + 2 * b_c * (v(t) - z.diff(t)))),
    ("mass_equation", mass_moves(K * (x(t) - z) + b_c * (v(t) - z.diff(t)) - 9.81 * m)),
    ("mass_on_coupler", on_coupler(1, -1)),
    ("mass_on_coupler", on_coupler(-1, 1)),
    ("mass_on_coupler", on_coupler(1, 1, hl.coordinate("z", unit="m"))),
    ("resonance", lambda m, K, b_c: {"f": np.sqrt(K / m), "zeta": b_c / (2 * np.sqrt(K * m))}),
    ("resonance", lambda m, K, b_c: {
        "f": np.sqrt(K / m - (b_c / m) ** 2 / 4) / (2 * np.pi), "zeta": b_c / (2 * np.sqrt(K * m))}),
    ("thousand", "c"),
]  # fmt: skip
