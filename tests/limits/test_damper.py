"""The largest sampled damper against closed forms, and against handles that ring."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab import n, parameters, x


@pytest.mark.parametrize("m, b, T", [(0.05, 0.3, 1e-3), (0.002, 3.0, 1e-3), (0.01, 1e-7, 2e-3), (1e-4, 5.0, 1e-3)])
def test_closed_form_without_delay(m, b, T):
    """z^2 - (a - g1 B/T) z + g0 B/T inside the unit circle, with the constants of the held plant."""
    a, tau = math.exp(-b * T / m), m / b
    if b > 1e-3:
        g0, g1 = (tau * (1 - a) - a * T) / b, (T - tau * (1 - a)) / b
    else:
        g0 = g1 = T**2 / (2 * m)
    edges = [T / g0] + ([T * (1 + a) / (g1 - g0)] if g1 > g0 else [])
    assert hl.damper_limit(m=m, b=b, T=T) == pytest.approx(min(edges), rel=1e-9 if b > 1e-3 else 1e-7)


def test_without_device_damping_it_is_two_masses_a_period():
    assert hl.damper_limit(m=0.03, b=0, T=2e-3) == pytest.approx(2 * 0.03 / 2e-3, rel=1e-12)


def test_a_whole_sample_of_delay_by_a_cubic():
    """b = 0: z^3 - z^2 + g z + g, g = B T/(2 m), has a pair on the unit circle where 1 - g^2 = |g + g| (Schur and Cohn)."""
    g = math.sqrt(2) - 1
    assert hl.damper_limit(m=0.05, b=0, T=1e-3, delay=1e-3) == pytest.approx(g * 2 * 0.05 / 1e-3, rel=1e-9)


@pytest.mark.parametrize("delay", [0.0, 3e-4, 1e-3, 2.6e-3])
def test_a_handle_rings_just_beyond_and_settles_just_below(delay):
    B = parameters("B", units="N*s/m")
    scene = hl.Scene(force=B * (x(n) - x(n - 1)) / hl.T)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.2, T=1e-3, delay=delay)
    limit = hl.damper_limit(m=0.05, b=0.2, T=1e-3, delay=delay)

    def grown(B):
        log = paddle.run(scene(B=B), duration=1.5, v=0.1, progress=False, dtype="float64")
        return np.abs(log.v[-100:]).max() / np.abs(log.v[600:700]).max()

    assert grown(1.01 * limit) > 1.5
    assert grown(0.99 * limit) < 0.7
