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
    found = passivity_indices(hl.LinearLaw.of(law, K=K, T=T, B=B * K * T))
    assert found.nu == pytest.approx(nu * K * T, rel=1e-9)
    assert found.eps == pytest.approx(eps / (K * T), rel=1e-9)
    assert found.eps_frequency == pytest.approx(0.5 / T)


def test_eps_of_a_law_that_is_worst_inside_the_band():
    """H = 1/z - 0.6/z^2: Re H (1/z - 1) = 1.6 cos 2t - cos t - 0.6 cos 3t over |H|^2 = 1.36 - 1.2 cos t."""
    law = hl.LinearLaw.of_taps([0.0, 1.0, -0.6], T=1.0)
    theta = np.linspace(1e-3, math.pi, 200_001)
    top = np.cos(2 * theta) - np.cos(theta) - 0.6 * np.cos(3 * theta) + 0.6 * np.cos(2 * theta)
    values = top / (1.36 - 1.2 * np.cos(theta))
    found = passivity_indices(law)
    assert 0 < found.eps_frequency < 0.5
    assert found.eps == pytest.approx(values.min(), rel=1e-9)


@pytest.mark.parametrize("taps", [[1.0], [1.5, -0.5], [2.0, -1.5, 0.5], [1.3, -0.3], [0.4, 0.6]])
def test_no_motion_breaks_the_inequalities_and_some_come_close(taps):
    """Work less nu D^2/T, and less eps T F^2, as matrices over all motions from rest at 0 to rest at 0; T = 1."""
    count, law = 60, hl.LinearLaw.of_taps(taps, T=1.0)
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


def test_it_needs_a_linear_law():
    with pytest.raises(AnalysisError, match="LinearLaw.of"):
        passivity_indices(hl.wall())
