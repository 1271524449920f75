"""The same work by numba, as its users write it; ImportError where it is not installed."""

import math

import numpy as np


def numba_steps(rates, state, T):
    """Return RK4 over ticks, compiled by numba, for ``rates(y, sample, p) -> list``: the coupler of floors.c."""
    from numba import njit

    rates = njit(rates)

    @njit
    def run(samples, p, force):
        y = np.zeros(state)
        for n in range(len(samples)):
            s = samples[n]
            force[n] = p[0] * (s[0] - y[0]) + p[1] * (s[1] - y[1])
            a = rates(y, s, p)
            b = rates(y + T / 2 * a, s, p)
            c = rates(y + T / 2 * b, s, p)
            d = rates(y + T * c, s, p)
            y = y + T / 6 * (a + 2 * (b + c) + d)

    return run


def coupler_rates(y, s, p):
    """Return z', z'' of the coupler."""
    wall = p[2] * (y[0] - p[4]) if y[0] >= p[4] else 0.0
    return np.array([y[1], (p[0] * (s[0] - y[0]) + p[1] * (s[1] - y[1]) - wall) / p[3]])


def numba_lanes():
    """Return the wall swept over k, one thread, scalar code: what floors.c does in vectors."""
    from numba import njit

    @njit
    def run(ticks, ks, phi, push, counts, v0, peaks):
        metres = np.float32(1 / counts) if counts > 0 else np.float32(0)
        for lane in range(len(ks)):
            k, x, v, peak = np.float32(ks[lane]), 0.0, v0, 0.0
            for _ in range(ticks):
                seen = np.float32(math.floor(x * counts)) * metres if counts > 0 else np.float32(x)
                F = np.float64(k * seen) if seen >= 0 else 0.0
                peak = max(peak, F)
                u = push - F
                x, v = phi[0] * x + phi[1] * v + phi[2] * u, phi[3] * x + phi[4] * v + phi[5] * u
            peaks[lane] = peak

    return run
