"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np
from matplotlib.figure import Figure

import hapticlab as hl
from hapticlab import n, x

k, x_o = hl.parameters("k x_o", units="N/m m")


def drawn_limit(limit):
    axes, delay = Figure().subplots(), np.linspace(0, 3, 100)
    axes.plot(delay, limit(1e-3 * delay))
    axes.set(xlabel="delay [ms]", ylabel="k [N/m]")
    return axes


def crossings(t, x):
    y = x - x.mean()
    return np.sum(y[:-1] * y[1:] < 0) / (t[-1] - t[0])


WRONG = [
    ("stability_estimate", lambda b, T, delay: b / (T + delay)),
    ("limit_over_delay", lambda b, T: drawn_limit(lambda delay: b / (T + delay))),
    ("limit_over_delay", lambda b, T: drawn_limit(lambda delay: 2 * b / (T / 2 + delay))),
    ("growth_per_sample", lambda m, k, T: 1 + k * T**2 / (2 * m)),
    ("growth_per_sample", lambda m, k, T: 1 + k * T**2 / (4 * m)),
    ("late_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n - 1) - x_o)))),
    ("chatter_frequency", crossings),
    ("threshold_speed", lambda k, b, T, f_c: 4 * f_c / (np.pi * (k * T - b))),
    ("quantised_limit", lambda b, T, f_c, resolution: 2 * b / T + 2 * f_c / resolution),
    ("culprit", "a"),
]  # fmt: skip
