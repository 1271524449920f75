"""Answers of lab 05, by the names they have in its notebook."""

import numpy as np

prediction = 1000.0


def period_energy(x, D, K, b, T):
    """Leak of a held spring and least loss of the device's damper in one period [J]."""
    stored = K * (x + D) ** 2 / 2 - K * x**2 / 2
    return {"leak": stored - K * x * D, "loss": b * D**2 / T}


def damper_gives(D, B, T):
    """Energy that the held virtual damper gives in one period, in two motions [J]."""
    return {"slow": -B * D / T * D, "alternating": -B * (-D) / T * D}


def observed_energy(x, F):
    """Work on the environment until each sample [J]."""
    return np.concatenate([[0.0], np.cumsum(F[:-1] * np.diff(x))])


def damping_asked(taps, theta, T):
    """Colgate and Schenkel's condition at one angle a sample [N s/m]."""
    H = np.sum(taps * np.exp(-1j * theta * np.arange(len(taps))))
    return T / 2 * ((1 - np.exp(-1j * theta)) * H).real / (1 - np.cos(theta))


def disk_size(K, theta, b, T):
    """Size of the mapped law; below 1 it is passive in every hand."""
    centre = -T / (4 * b) * (1 + 1j / np.tan(theta / 2))
    return abs(K * abs(centre) / (1 + K * centre))


def controlled_force(f, credit, D, T, alpha_max):
    """Force with the series passivity controller [N]."""
    if credit >= 0 or D == 0:
        return f
    return f + min(-credit * T / D**2, alpha_max) * D / T


why_it_failed = "a"

discussion = (
    "I predicted 1000 N/m for the light finger, and its limit is 240, because I counted on a damping that this finger does "
    "not have; the bound counts on the damping of the device alone. I would insist on it for the handle of a surgeon, which "
    "anybody may touch in any way, and not for a knob that is always held firmly. With b = 0.5 and B = -0.3 the bound is "
    "400 N/m, twice that of the bare paddle, while slow motion feels only 0.2 N s/m."
)
