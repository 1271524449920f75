"""Llewellyn's criterion against what it stands for: the resistance felt with random passive terminations."""

import numpy as np
import pytest

from hapticlab.limits.two_port import TwoPort, frequencies

T = 1e-3


def flat(h, stable=True):
    return TwoPort(lambda theta: np.tile(np.array(h, dtype=complex), (len(theta), 1, 1)), T=T, name="flat", stable=stable)


def passive(generator, count):
    """Random impedances with a resistance >= 0, many of them purely reactive, over many orders of magnitude."""
    size = 10 ** generator.uniform(-4, 4, count)
    angle = np.where(generator.random(count) < 0.5, np.pi / 2, np.pi * (generator.random(count) - 0.5))
    return size * np.exp(1j * angle * np.sign(generator.random(count) - 0.5))


def test_the_criterion_says_whether_some_passive_environment_makes_the_hand_feel_a_negative_resistance():
    generator, seen = np.random.default_rng(8), []
    for _ in range(150):
        h = generator.normal(size=(2, 2)) + 1j * generator.normal(size=(2, 2))
        h[[0, 1], [0, 1]] = abs(h[[0, 1], [0, 1]].real) + 1j * h[[0, 1], [0, 1]].imag
        port = flat(h)
        felt = port.felt(np.ones(4000), passive(generator, 4000)).real.min()
        least, good = port.least_resistance([1.0])[0], port.criterion([1.0])[0] >= 0
        assert felt >= least - 1e-9 * abs(h[0, 0])
        assert good == (least >= 0)
        if abs(least) > 0.3 * h[0, 0].real:  # far from the border the random environments decide as well
            assert good == (felt >= 0)
        seen.append(good)
    assert 15 < sum(seen) < 135


def test_the_least_resistance_is_reached_by_a_reactance():
    """Where the half plane of passive environments is mapped to a disk, its edge is the imaginary axis."""
    h = np.array([[0.3 + 0.2j, 0.8], [-0.7 + 0.4j, 0.5 - 0.1j]])
    reactance = 1j * np.tan(np.linspace(-np.pi / 2, np.pi / 2, 200001)[1:-1])
    felt = flat(h).felt(np.ones(len(reactance)), reactance).real
    assert felt.min() == pytest.approx(flat(h).least_resistance([1.0])[0], rel=1e-7)


def test_a_network_that_hides_nothing_and_one_with_a_negative_port():
    wire = flat([[0, 1], [-1, 0]])  # an ideal display: the hand feels the environment
    assert wire.absolutely_stable and wire.felt([1.0], [2 + 3j])[0] == 2 + 3j
    assert not flat([[0, 1], [-1, 0]], stable=False).absolutely_stable  # the criterion knows nothing of it
    assert not flat([[-0.1, 0.1], [-0.1, 5.0]]).absolutely_stable
    assert not flat([[5.0, 0.1], [-0.1, -0.1]]).absolutely_stable


def test_the_worst_frequency():
    def h(theta):
        return np.moveaxis(np.array([[0.2 + 0 * theta, 1 + 0 * theta], [-1 + 0 * theta, (theta - 2) ** 2]]), 2, 0) + 0j

    port = TwoPort(h, T=T, name="dip", stable=True)
    assert port.worst == pytest.approx(2 / (2 * np.pi * T), rel=1e-3)
    assert frequencies()[0] < 1.1e-5 and frequencies()[-1] == np.pi
