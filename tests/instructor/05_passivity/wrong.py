"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

WRONG = [
    ("period_energy", lambda x, D, K, b, T: {"leak": K * (x + D) ** 2 / 2 - K * x**2 / 2, "loss": b * D**2 / T}),
    ("period_energy", lambda x, D, K, b, T: {"leak": K * D**2 / 2, "loss": b * D**2}),
    ("damper_gives", lambda D, B, T: {"slow": -B * D**2 / T, "alternating": -B * D**2 / T}),
    ("damper_gives", lambda D, B, T: {"slow": -abs(B) * D**2 / T, "alternating": abs(B) * D**2 / T}),
    ("observed_energy", lambda x, F: np.concatenate([[0], np.cumsum(F[1:] * np.diff(x))])),
    ("damping_asked", lambda taps, theta, T: (
        T / 2 * ((1 - np.exp(-1j * theta)) * np.sum(taps * np.exp(1j * theta * np.arange(len(taps))))).real
        / (1 - np.cos(theta)))),
    ("disk_size", lambda K, theta, b, T: K * abs(T / (4 * b) * (1 + 1j / np.tan(theta / 2)))),
    ("controlled_force", lambda f, credit, D, T, alpha_max: (
        f if credit >= 0 or D == 0 else f - min(-credit * T / D**2, alpha_max) * D / T)),
    ("observed_energy", lambda x, F: np.concatenate([[0], np.cumsum((F[1:] + F[:-1]) / 2 * np.diff(x))])),
    ("disk_size", lambda K, theta, b, T: (
        K * abs(T / (4 * b) * (1 + 1j / np.tan(theta / 2)))
        / abs(1 + K * T / (4 * b) * (1 + 1j / np.tan(theta / 2))))),
    ("why_it_failed", "c"),
]  # fmt: skip
