"""The disk of passive hands, by summing hands over aliases and by sampling a real one; the map against the condition."""

import numpy as np
import pytest
from scipy.linalg import expm

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.colgate import passivity_margin
from hapticlab.limits.linear_law import LinearLaw
from hapticlab.limits.nyquist_disk import nyquist_disk

T, b = 1e-3, 0.12
ELLIS = LinearLaw.of("ellis", K=60, T=T)
ALIASES = np.arange(-20000, 20001)


def sampled(admittances, theta, delay):
    """G at theta of a hand with these admittances at the aliases of theta: held, delayed, integrated, sampled."""
    w = (theta + 2 * np.pi * ALIASES) / T
    hold = (1 - np.exp(-1j * theta)) / (1j * w) * np.exp(-1j * w * delay)
    return np.sum(admittances * hold / (1j * w)) / T


@pytest.mark.parametrize("delay", [0.0, 0.3e-3, 1.8e-3])
@pytest.mark.parametrize("theta", [0.3, 1.7, np.pi])
@pytest.mark.always("0.3-0.0", "1.7-0.0003", "3.1*-0.0018")
def test_every_sum_over_the_aliases_lies_in_the_disk_and_some_on_its_edge(delay, theta):
    disk, generator = nyquist_disk(hl.Device(b=b, delay=delay), ELLIS), np.random.default_rng(4)
    centre, radius = disk.centre(theta), disk.radius(theta)
    turn = (theta + 2 * np.pi * ALIASES) * delay / T
    for _ in range(20):  # |Y - 1/(2b)| <= 1/(2b): damping b and any passive hand
        Y = (1 + generator.random(len(ALIASES)) ** 0.5 * np.exp(2j * np.pi * generator.random(len(ALIASES)))) / (2 * b)
        assert abs(sampled(Y, theta, delay) - centre) <= radius * (1 + 1e-9)
    for phase in (0.0, 1.0, 4.0):  # all terms of the sum turned the same way; the aliases left out are 1e-5 of it
        aligned = (1 + np.exp(1j * (phase + turn))) / (2 * b)
        assert abs(sampled(aligned, theta, delay) - centre) == pytest.approx(radius, rel=3e-5)


def test_a_handle_in_a_hand_of_springs_is_inside():
    """Sampled by its matrix exponential; a handle without mass, on its own damping, lies on the edge."""
    theta = np.linspace(0.05, np.pi, 40)
    disk = nyquist_disk(hl.Device(b=b), ELLIS)
    for m, k in ((1e-3, 0.0), (0.05, 0.0), (0.05, 4e4), (1e-4, 900.0)):
        both = expm(T * np.array([[0, 1, 0], [-k / m, -b / m, 1 / m], [0, 0, 0]]))
        plant, force = both[:2, :2], both[:2, 2]
        G = np.array([np.linalg.solve(np.exp(1j * a) * np.eye(2) - plant, force)[0] for a in theta])
        assert np.all(abs(G - disk.centre(theta)) <= disk.radius(theta) * (1 + 1e-9))
    massless = T / b / (np.exp(1j * theta) - 1)
    assert abs(massless - disk.centre(theta)) == pytest.approx(disk.radius(theta), rel=1e-12)


@pytest.mark.parametrize("delay", [0.0, 0.4e-3, 1e-3])
@pytest.mark.parametrize("K", [30, 60, 150])
def test_inside_the_unit_circle_is_the_condition_at_every_frequency(K, delay):
    law = LinearLaw.of("ellis", K=K, T=T, B=0.02, velocity_filter=1e-3)
    disk = nyquist_disk(hl.Device(b=b, delay=delay), law)
    theta = np.linspace(0.01, np.pi, 300)
    asked = passivity_margin(hl.Device(b=b, delay=delay), law).asked(theta)
    assert np.array_equal(np.abs(disk.mapped(theta)) < 1, asked < b)
    assert disk.passive == bool(np.all(asked < b))


def test_the_wall_of_eq_23_10_touches_the_circle_at_its_limit():
    for B, at in ((0.05, np.pi), (-0.05, 1e-4)):
        K = 2 * (b - 0.05) / T
        disk = nyquist_disk(hl.Device(b=b), LinearLaw.of("zoh", K=K, T=T, B=B))
        assert abs(disk.mapped(at)) == pytest.approx(1.0, rel=1e-7)


def test_words_picture_and_refusals():
    disk = nyquist_disk(hl.Device(b=0.13), ELLIS)
    assert "|M| = 0.857143 at 500 Hz, inside" in str(disk)
    assert "some passive hand closes an unstable loop" in str(nyquist_disk(hl.Device(b=0.1), ELLIS))
    left, right = disk.plot().axes
    assert "T/b" in left.get_xlabel() and len(right.lines) == 3
    endless = nyquist_disk(hl.Device(b=0.1), LinearLaw.of("zoh", K=400, T=T))  # 1 + H c = 1 - K T/(4 b) at Nyquist
    assert "|M| infinite at 500 Hz, outside" in str(endless)
    worst = endless.plot().axes[1].lines[2]
    assert worst.get_label() == "worst: |M| infinite, off the picture" and not len(worst.get_xdata())
    assert "for slow motion" in str(nyquist_disk(hl.Device(b=0.1, delay=1e-3), LinearLaw.of("zoh", K=60, T=T)))
    with pytest.raises(AnalysisError, match="b = 0"):
        nyquist_disk(hl.Device(b=0), ELLIS)
    mass = LinearLaw(np.array([[2.0, -1.0], [1.0, 0.0]]), np.array([1.0, 0]), np.array([1.0, 0]), 1.0, T, "free mass")
    with pytest.raises(AnalysisError):
        nyquist_disk(hl.Device(b=b), mass)
