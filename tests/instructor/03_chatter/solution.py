"""Answers of lab 03, by the names they have in the notebook."""

import numpy as np

import hapticlab as hl
from hapticlab import n, x

prediction = "about 2200 N/m"  # a text is noted as well


def stability_estimate(b, T, delay):
    """Return the largest stable stiffness [N/m]: b - k (T/2 + delay) = 0."""
    return b / (T / 2 + delay)


def limit_over_delay(b, T):
    """Return a figure of the limit to first order over delays from 0 to 3 ms."""
    delay = np.linspace(0, 3, 200)
    limit = stability_estimate(b, T, 1e-3 * delay)
    return hl.plot({"": (delay, limit)}, xlabel="delay [ms]", ylabel="stiffness k [N/m]")


def growth_per_sample(m, k, T):
    """Return the root of the determinant of [[1 - kT^2/2m, T], [-kT/m, 1]]."""
    return np.sqrt(1 + k * T**2 / (2 * m))


k, x_o = hl.parameters("k x_o", units="N/m m")
late_wall = hl.Scene(force=hl.when(x(n - 1) >= x_o, k * (x(n - 1) - x_o)))


def chatter_frequency(t, x):
    """Return the frequency [Hz], from upward crossings between the samples."""
    y = x - np.mean(x)
    i = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    at = t[i] + (t[i + 1] - t[i]) * y[i] / (y[i] - y[i + 1])
    return (len(at) - 1) / (at[-1] - at[0])


def threshold_speed(k, b, T, f_c):
    """Return X w [m/s], at which 4 f_c X equals pi w X^2 (k T/2 - b)."""
    return 4 * f_c / (np.pi * (k * T / 2 - b))


def quantised_limit(b, T, f_c, resolution):
    """Return the largest passive stiffness [N/m]."""
    return min(2 * b / T, 2 * f_c / resolution)


culprit = "c"
discussion = """
"In anybody's hand" means that passivity decides, so the smaller of 2b/T and 2
f_c/Delta. The mass appears in neither; it only slows the handle and makes it feel heavy
outside the wall. Doubling the viscous damping doubles 2b/T, but the user feels it
everywhere, like syrup. Doubling the rate doubles the same limit, and nobody feels it,
so I choose the rate, as long as the encoder is fine and there is enough dry friction;
otherwise more counts come first. More dry friction would raise the limit of the
encoder, but the user feels it at every turning point as a handle that sticks.
"""
