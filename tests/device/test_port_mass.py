"""The bound on a mass felt through a constraint: closed forms against roots, roots against a simulated paddle."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab import T, n, v
from hapticlab.device.port_mass import largest_port_mass, largest_root

M = 0.05


def test_closed_forms():
    assert largest_port_mass(m=M, T=1e-3, velocity="measured", delay=7e-3) == M
    for k in range(5):
        limit = largest_port_mass(m=1.0, T=1e-3, delay=k * 1e-3)
        assert limit == pytest.approx(1 / math.cos(math.pi / (2 * k + 3)), rel=1e-14)
        for k_root, growth in ((0.999, -1), (1.001, 1)):
            assert np.sign(largest_root(k_root * limit, k) - 1) == growth
    # a part of a sample lies between the whole ones
    parts = [largest_port_mass(m=1.0, T=1e-3, delay=d * 1e-3) for d in (0, 1e-4, 0.3, 0.7, 1)]
    assert parts == sorted(parts, reverse=True)
    assert parts[1] == pytest.approx(2, rel=1e-3)


@pytest.mark.parametrize("velocity", ["measured", "backward_difference"])
@pytest.mark.parametrize("delay", [0.0, 0.4e-3, 1e-3, 2.3e-3])
def test_a_simulated_paddle_rings_with_that_growth(velocity, delay):
    # a mass that moves with the handle is felt as mp (v(n) - v(n-1))/T
    mp = hl.parameters("mp", units="kg")
    scene = hl.Scene(force=mp * (v(n) - v(n - 1)) / T)
    # a fine encoder makes the paddle take differences; it rounds far below what rings
    counts = None if velocity == "measured" else 1e13
    paddle = hl.SimulatedPaddle(m=M, b=0, T=1e-3, delay=delay, counts_per_metre=counts, hand=hl.Hand(push=1.0))
    limit = largest_port_mass(m=M, T=1e-3, delay=delay, velocity=velocity)
    whole, part = divmod(round(delay / 1e-3, 9), 1)
    for ratio in (0.9, 1.1):
        log = paddle.run(scene(mp=ratio * limit), duration=0.4, progress=False, dtype="float64")
        # about the steady force of a body pushed along
        ringing = np.abs(log.F - ratio * limit / (M + ratio * limit))
        early, late = ringing[40:80].max(), ringing[360:].max()
        growth = largest_root(ratio * limit / M, int(whole), part, velocity)
        assert (growth > 1) == (ratio > 1)
        if ratio > 1:
            assert late / early == pytest.approx(growth**320, rel=0.35)
        else:  # down to the encoder's own noise
            assert late < early * max(1.5 * growth**320, 1e-4)
