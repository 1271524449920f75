"""Passivity indices of held laws against closed forms and against a matrix of every motion."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.indices import passivity_indices

K, T = 340.0, 8e-4


@pytest.mark.parametrize(
    "law, B, nu, eps",
    [
        ("zoh", 0.0, -1 / 2, -2),
        ("backward_difference", 0.0, -1, -1),
        ("ellis", 0.0, -2, -1 / 2),
        ("zoh", 0.3, -1 / 2 - 0.3, -2 / 1.6),  # H = K (1.6) at Nyquist, in units of K T = 1
        ("ellis", 0.3, -2 - 0.3, -2 / 4.6),
    ],
)
def test_closed_forms(law, B, nu, eps):
    """At Nyquist z = -1: Z = -T H/2, so that nu = -T H/2 and eps = -2/(T H) where that is the worst."""
    found = passivity_indices(hl.laws.LinearLaw.of(law, K=K, T=T, B=B * K * T))
    assert found.nu == pytest.approx(nu * K * T, rel=1e-9)
    assert found.eps == pytest.approx(eps / (K * T), rel=1e-9)
    assert found.eps_frequency == pytest.approx(0.5 / T)


def test_eps_of_a_law_that_is_worst_inside_the_band():
    """H = 1/z - 0.6/z^2: Re H (1/z - 1) = 1.6 cos 2t - cos t - 0.6 cos 3t over |H|^2 = 1.36 - 1.2 cos t."""
    law = hl.laws.LinearLaw.of_taps([0.0, 1.0, -0.6], T=1.0)
    theta = np.linspace(1e-3, math.pi, 200_001)
    top = np.cos(2 * theta) - np.cos(theta) - 0.6 * np.cos(3 * theta) + 0.6 * np.cos(2 * theta)
    values = top / (1.36 - 1.2 * np.cos(theta))
    found = passivity_indices(law)
    assert 0 < found.eps_frequency < 0.5
    assert found.eps == pytest.approx(values.min(), rel=1e-9)


@pytest.mark.parametrize("taps", [[1.0], [1.5, -0.5], [2.0, -1.5, 0.5], [1.3, -0.3], [0.4, 0.6]])
def test_no_motion_breaks_the_inequalities_and_some_come_close(taps):
    """Work less nu D^2/T, and less eps T F^2, as matrices over all motions from rest at 0 to rest at 0; T = 1."""
    count, law = 60, hl.laws.LinearLaw.of_taps(taps, T=1.0)
    found = passivity_indices(law)
    place = np.vstack([np.zeros((1, count)), np.eye(count), np.zeros((len(taps) + 1, count))])  # at rest at 0 before and after
    F = sum(c * np.vstack([np.zeros((lag, count)), place[: len(place) - lag]]) for lag, c in enumerate(taps))[:-1]
    D = np.diff(place, axis=0)
    work = (F.T @ D + D.T @ F) / 2
    for index, size in ((found.nu, D.T @ D), (found.eps, F.T @ F)):
        root = np.linalg.inv(np.linalg.cholesky(size))
        least = np.linalg.eigvalsh(root @ work @ root.T)[0]
        assert index - 1e-9 <= least
        assert least == pytest.approx(index, rel=2e-2)  # a motion of 60 samples comes as close as that


@pytest.mark.parametrize(
    "taps, at",
    [
        ([100.0, 0.0, 100.0], 0.25),  # 2 K cos t: (cos 2t - cos t)/(2 K T cos t)
        ([100.0, -100.0, 100.0], 1 / 6),  # K (2 cos t - 1)
        ([0.0, 1.0, 2.0, 1.0], 0.5),  # 4 cos^2(t/2), late: (cos 3t - cos 2t)/(4 cos^2(t/2)), on both sides
    ],
)
def test_where_motion_makes_no_force_no_dashpot_is_enough(taps, at):
    """Beside the zero eps goes as one over the distance, by the formula itself: 100 times as much at a hundredth."""
    law, theta = hl.laws.LinearLaw.of_taps(taps, T=T), 2 * math.pi * at
    H = [sum(c * np.exp(-1j * k * (theta - side * d)) for k, c in enumerate(taps)) for side in (1, -1) for d in (1e-3, 1e-5)]
    t = [theta - side * d for side in (1, -1) for d in (1e-3, 1e-5)]
    values = [(h * (np.exp(-1j * a) - 1)).real / abs(h) ** 2 for h, a in zip(H, t, strict=True)]
    assert min(values[1] / values[0], values[3] / values[2]) > 50 and min(values) < 0
    found = passivity_indices(law)
    assert found.eps == -math.inf and found.eps_frequency == pytest.approx(at / T)
    assert "no dashpot in series is enough" in str(found)


@pytest.mark.parametrize("scale", [1.0, 1e-3, 1e6])
def test_a_zero_that_leaves_nothing_real_is_passed_by(scale):
    """K (1 + 1/z): -2 sin^2(t/2)/(K T), so -2/(K T) at Nyquist, where H is zero."""
    found = passivity_indices(hl.laws.LinearLaw.of_taps([scale * K, scale * K], T=T))
    assert found.eps == pytest.approx(-2 / (scale * K * T), rel=1e-9)
    assert found.eps_frequency == pytest.approx(0.5 / T, rel=1e-9)


def test_a_zero_about_which_eps_rises_is_no_minimum():
    """(1 + 1/z)^2: (cos 2t - cos t)/(4 cos^2(t/2)), which is infinite at Nyquist, against a grid."""
    t = math.pi * np.arange(1, 200_000) / 200_000
    values = (np.cos(2 * t) - np.cos(t)) / (4 * np.cos(t / 2) ** 2)
    assert passivity_indices(hl.laws.LinearLaw.of_taps([1.0, 2.0, 1.0], T=1.0)).eps == pytest.approx(values.min(), rel=1e-8)


@pytest.mark.parametrize("radius", [0.999, 0.9999, 1.001])
@pytest.mark.always("0.9999")
def test_a_zero_near_the_circle_is_a_deep_dip(radius):
    """1 - 2 r cos(a) /z + r^2/z^2 against a grid about its angle that is fine enough."""
    law = hl.laws.LinearLaw.of_taps([1.0, -2 * radius * math.cos(1.0), radius**2], T=1.0)
    t = 1.0 + np.linspace(-0.02, 0.02, 800_001)
    H = 1 - 2 * radius * math.cos(1.0) * np.exp(-1j * t) + radius**2 * np.exp(-2j * t)
    values = (H * (np.exp(-1j * t) - 1)).real / abs(H) ** 2
    assert passivity_indices(law).eps == pytest.approx(values.min(), rel=1e-6)


def test_a_law_with_poles_has_its_zeros_found():
    """A filtered damper has its one zero at z = 1 and none elsewhere; K (1 + z^-2) through the same filter has its two."""
    law = hl.laws.LinearLaw.of("zoh", K=0.0, T=T, B=2.0, velocity_filter=3e-3)
    tau = 3e-3
    t = math.pi * np.arange(1, 20_001) / 20_000
    Z = 2 * T / ((tau + T) * np.exp(1j * t) - tau)  # T H/(z - 1), H = B (z - 1)/((tau + T) z - tau)
    assert passivity_indices(law).eps == pytest.approx((Z.real / abs(Z) ** 2).min(), rel=1e-9)
    filtered = hl.laws.LinearLaw.of("zoh", K=K, T=T, B=2.0, velocity_filter=tau).then([1.0, 0.0, 1.0])
    found = passivity_indices(filtered)
    assert found.eps == -math.inf and found.eps_frequency == pytest.approx(0.25 / T)


def test_it_needs_a_linear_law_with_a_force():
    with pytest.raises(AnalysisError, match="LinearLaw.of"):
        passivity_indices(hl.wall())
    with pytest.raises(AnalysisError, match="zero for every motion,"):
        passivity_indices(hl.laws.LinearLaw.of("zoh", K=0, T=T))
