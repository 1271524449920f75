"""The bound on a mass felt through a constraint: closed forms against roots, roots against a simulated paddle."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab import T, n, v
from hapticlab.device.port_mass_check import largest_port_mass, largest_root

M = 0.05


def test_closed_forms():
    assert largest_port_mass(m=M, T=1e-3, velocity="measured", delay=7e-3) == M
    for k in range(5):
        limit = largest_port_mass(m=1.0, T=1e-3, delay=k * 1e-3)
        assert limit == pytest.approx(1 / math.cos(math.pi / (2 * k + 3)), rel=1e-14)
        for k_root, growth in ((0.999, -1), (1.001, 1)):
            assert np.sign(largest_root(k_root * limit, k) - 1) == growth
    # half a sample of delay doubles what a measured velocity allows, as device_image says: z^2 + (r/2)(z + 1) = 0
    assert largest_port_mass(m=M, T=1e-3, velocity="measured", delay=0.5e-3) == pytest.approx(2 * M, rel=1e-9)
    # of a backward difference a part of a sample lies between the whole ones
    parts = [largest_port_mass(m=1.0, T=1e-3, delay=d * 1e-3) for d in (0, 1e-4, 0.3, 0.7, 1)]
    assert parts == sorted(parts, reverse=True)
    assert parts[1] == pytest.approx(2, rel=1e-3)


def growth_of(ringing, order):
    """Return the largest growth per sample of a sum of ``order`` geometric sequences: Prony's method."""
    rows = np.lib.stride_tricks.sliding_window_view(ringing, order + 1)
    rows = rows / np.abs(rows).max(axis=1, keepdims=True)  # what has grown weighs no more
    weights, *_ = np.linalg.lstsq(rows[:, :-1], -rows[:, -1])
    return np.abs(np.roots([1.0, *weights[::-1]])).max()


@pytest.mark.parametrize("velocity", ["measured", "backward_difference"])
@pytest.mark.parametrize("delay", [0.0, 0.4e-3, 1e-3, 2.3e-3])
@pytest.mark.always("0.0-measured", "0.001-backward_difference")
def test_a_simulated_paddle_rings_with_that_growth(velocity, delay):
    # a mass that moves with the handle is felt as mp (v(n) - v(n-1))/T
    mp = hl.parameters("mp", units="kg")
    scene = hl.Scene(force=mp * (v(n) - v(n - 1)) / T)
    # a fine encoder makes the paddle take differences; it rounds far below what rings
    counts = None if velocity == "measured" else 1e12
    paddle = hl.SimulatedPaddle(m=M, b=0, T=1e-3, delay=delay, counts_per_metre=counts, hand=hl.Hand(push=1.0))
    limit = largest_port_mass(m=M, T=1e-3, delay=delay, velocity=velocity)
    whole, part = divmod(round(delay / 1e-3, 9), 1)
    order = int(whole) + (1 if velocity == "measured" else 2) + (part > 0)
    for ratio in (0.9, 1.1):
        log = paddle.run(scene(mp=ratio * limit), duration=0.07, progress=False, dtype="float64")
        # about the steady force of a body pushed along
        ringing = log.F - ratio * limit / (M + ratio * limit)
        growth = largest_root(ratio * limit / M, int(whole), part, velocity)
        assert (growth > 1) == (ratio > 1)
        # an encoder of 1e-12 m rounds the force by 4e-7 N, and what rings is 8e-3 N at least
        assert growth_of(ringing[10:], order) == pytest.approx(growth, rel=1e-11 if velocity == "measured" else 1e-6)
