"""Responses from blocks: known ratios, known noise, and how often the stated circle holds the truth."""

import numpy as np
import pytest

from hapticlab.measurement.spectrum import held_transfer, lines_in, ramp_transfer, response


def test_lines_of_a_known_sum():
    t = np.arange(400) / 400
    block = 3 * np.cos(2 * np.pi * 5 * t + 0.4) + 0.5 * np.sin(2 * np.pi * 9 * t)
    found = lines_in(np.array([block, 2 * block]), [5, 9])
    assert found[0] == pytest.approx([3 * np.exp(0.4j), -0.5j], abs=1e-13)
    assert found[1] == pytest.approx(2 * found[0])


@pytest.mark.parametrize("blocks", [3, 8])
def test_the_circle_holds_the_truth_95_times_in_100(blocks):
    """Noise on both, part of it in common, as in a closed loop; 20 000 trials, whose own error is 0.15 %."""
    draw = np.random.default_rng(7)
    truth, trials = 2 - 1j, 20_000

    def noise(size):
        return size * (draw.standard_normal((blocks, trials)) + 1j * draw.standard_normal((blocks, trials)))

    common = noise(0.02)
    reference = np.exp(2j * np.pi * draw.uniform(size=(blocks, 1))) * np.ones((blocks, trials))
    x = (1 + common + noise(0.02)) * reference
    y = (truth - 0.7 * common + noise(0.03)) * reference
    found = response(y, x, reference)
    covered = np.mean(abs(found.value - truth) <= found.radius)
    assert 0.945 < covered < 0.955
    assert 0 < found.coherence.min() and found.coherence.max() <= 1


def test_blocks_that_repeat_are_certain_and_one_block_tells_nothing():
    x, y = np.ones((3, 2), complex), np.full((3, 2), 2j)
    found = response(y, x, x)
    assert (found.value == 2j).all() and (found.radius == 0).all() and found.coherence == pytest.approx(1.0)
    assert np.isnan(response(y[:1], x[:1], x[:1]).radius).all()


def test_feedback_of_noise_does_not_bias_the_response():
    """x = r - y, y = G x + e: a plain ratio of y and x is pulled to -1 where e dominates; by r it is not."""
    draw = np.random.default_rng(2)
    G, r = 0.5, np.ones((40_000, 1), complex)
    e = 3 * (draw.standard_normal((40_000, 1)) + 1j * draw.standard_normal((40_000, 1)))
    x = (r - e) / (1 + G)
    y = G * x + e
    assert response(y, x, r).value[0] == pytest.approx(G, abs=0.1)  # x and y are sure to 3 sqrt 2/sqrt 40000/(1 + G)
    assert (np.vdot(x, y) / np.vdot(x, x)).real < -0.8


def test_hold_and_straight_line_against_integrals():
    T, w = 1e-3, 2 * np.pi * 130.0
    tau = (np.arange(20_000) + 0.5) / 20_000 * T
    held = np.mean(np.exp(-1j * w * tau))
    assert held_transfer(1j * w, T) == pytest.approx(held, rel=1e-8)
    assert held_transfer(1j * w, T, 4e-4) == pytest.approx(held * np.exp(-1j * w * 4e-4), rel=1e-8)
    both = np.concatenate([tau - T, tau])
    triangle = np.sum((1 - abs(both) / T) * np.exp(-1j * w * both)) / 20_000
    assert ramp_transfer(np.array([1j * w]), T)[0] == pytest.approx(triangle, rel=1e-8)
