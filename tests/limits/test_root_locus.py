"""Root loci against the characteristic polynomial written by hand, its branches and where it is left."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.root_locus import root_locus

M, B, T = 0.05, 5.0, 1e-3


def paddle(**changes):
    return SimpleNamespace(**{"m": M, "b": B, "T": T, "delay": 0.0, "hand": None, **changes})


def by_hand(K):
    """Roots of (z - 1)(z - a) z + K (g1 z + g0)(1.5 z - 0.5), the law of Eq. (23.5) on a free handle."""
    tau = M / B
    a = math.exp(-T / tau)
    g1, g0 = (T - tau * (1 - a)) / B, (tau * (1 - a) - a * T) / B
    return np.roots(np.polyadd([1, -(1 + a), a, 0], K * np.polymul([g1, g0], [1.5, -0.5])))


def test_every_branch_is_a_root_of_the_polynomial_by_hand():
    locus = root_locus(paddle(), law="backward_difference", K=np.linspace(0, 60000, 9))
    assert set(np.linspace(0, 60000, 9)) <= set(locus.K)
    for K, poles in zip(locus.K, locus.poles, strict=True):
        theirs = by_hand(K)
        assert max(np.abs(theirs - z).min() for z in poles) < 1e-7  # two poles meet: the square root of rounding
    np.testing.assert_allclose(locus.radius, [np.abs(by_hand(K)).max() for K in locus.K], atol=1e-7)


def test_branches_are_continuous():
    locus = root_locus(paddle(delay=1.3e-3), law="ellis")
    assert np.abs(np.diff(locus.poles, axis=0)).max() < 0.05
    assert locus.poles.shape[1] == 2 + 2 + 2  # x and v, two past forces, two past samples


def test_where_it_leaves():
    locus = root_locus(paddle(), law="backward_difference")
    (K, frequency), *_ = locus.crossings
    assert K == pytest.approx(locus.limit.K, rel=1e-12) and K in locus.K
    z = by_hand(K)[np.argmax(np.abs(by_hand(K)))]
    assert abs(z) == pytest.approx(1, abs=1e-9)
    assert abs(np.angle(z)) / (2 * math.pi * T) == pytest.approx(frequency, rel=1e-6)
    assert locus.radius[locus.K < 0.999 * K].max() <= 1 + 1e-12
    assert "136" in str(locus) and "3099" in str(locus)


def test_it_ends_at_the_zeros():
    locus = root_locus(paddle(), law="backward_difference", K=[0, 1e12])
    a = math.exp(-T * B / M)
    g1, g0 = (T - M / B * (1 - a)) / B, (M / B * (1 - a) - a * T) / B
    np.testing.assert_allclose(np.sort(locus.zeros.real), [-g0 / g1, 1 / 3], rtol=1e-9)
    near = np.abs(locus.poles[-1][:, None] - locus.zeros).min(axis=0)
    assert near.max() < 1e-5


def test_a_scene_and_what_is_refused():
    scene = hl.laws.force_filter(hl.wall(unilateral=None))
    assert root_locus(paddle(), law=scene).limit.K == pytest.approx(root_locus(paddle(), law="ellis").limit.K, rel=1e-8)
    for K in (5.0, [1.0], [-1.0, 2.0], [0.0, math.nan], "a"):
        with pytest.raises(AnalysisError, match="two or more finite stiffnesses"):
            root_locus(paddle(), K=K)


def test_picture():
    pytest.importorskip("matplotlib")
    locus = root_locus(paddle(), law="backward_difference")
    axes = locus.plot().axes[0]
    (inset,) = axes.child_axes  # shows where the pole begins and where it leaves
    (low, high), (left, right) = inset.get_ylim(), inset.get_xlim()
    z = np.exp(2j * np.pi * locus.limit.frequency * locus.T)
    assert left < z.real < right and low < z.imag < high
    labels = [text.get_text() for text in axes.figure.legends[0].get_texts()]
    assert any(label.startswith("leaves at K = 30997.5 N/m, 136.3 Hz") for label in labels)
    assert axes.get_xlabel() == "Re z" and axes.get_aspect() == 1
