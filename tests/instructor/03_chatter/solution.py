"""Answers of lab 03, by the names they have in the notebook."""

import numpy as np
from matplotlib.figure import Figure

import hapticlab as hl
from hapticlab import n, x

prediction = "about 2200 N/m"  # a text is noted as well


def stability_estimate(b, T, delay):
    """Largest stable stiffness [N/m], to first order in the delay: b - k (T/2 + delay) = 0."""
    return b / (T / 2 + delay)


def limit_over_delay(b, T):
    """Figure of the limit to first order over delays of 0 to 3 ms."""
    figure = Figure(layout="constrained")
    axes, delay = figure.subplots(), np.linspace(0, 3e-3, 200)
    axes.plot(1e3 * delay, stability_estimate(b, T, delay))
    axes.set(xlabel="computational delay [ms]", ylabel="stiffness k [N/m]", ylim=(0, None))
    return figure


def growth_per_sample(m, k, T):
    """Factor on the amplitude in one sample: the root of the determinant of [[1 - kT^2/2m, T], [-kT/m, 1]]."""
    return np.sqrt(1 + k * T**2 / (2 * m))


k, x_o = hl.parameters("k x_o", units="N/m m")
late_wall = hl.Scene(force=hl.when(x(n - 1) >= x_o, k * (x(n - 1) - x_o)))


def chatter_frequency(t, x):
    """Frequency [Hz] from the upward crossings of the mean, each placed between its samples."""
    y = x - np.mean(x)
    i = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    at = t[i] + (t[i + 1] - t[i]) * y[i] / (y[i] - y[i + 1])
    return (len(at) - 1) / (at[-1] - at[0])


def threshold_speed(k, b, T, f_c):
    """Speed amplitude [m/s] at which 4 f_c X, what friction takes, is pi w X^2 (k T/2 - b), what the hold gives."""
    return 4 * f_c / (np.pi * (k * T / 2 - b))


def quantised_limit(b, T, f_c, resolution):
    """Largest passive stiffness [N/m]: the hold is paid by b, the encoder by dry friction."""
    return min(2 * b / T, 2 * f_c / resolution)


culprit = "c"
discussion = """
Anybody's hand means that passivity decides, so the smaller of 2b/T and 2 f_c/Delta. Mass is in neither, it only
slows the handle and makes free air feel heavy. Doubling the viscous damping doubles 2b/T, but it is felt as syrup
in free air. Doubling the rate doubles the same limit and is felt by nobody, so it is my choice as long as the
encoder is fine and friction stands by; otherwise finer counts come first. More dry friction would help the
encoder's limit, and is felt at every turning point as a handle that sticks.
"""
