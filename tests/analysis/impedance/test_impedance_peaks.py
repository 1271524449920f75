"""Errors of a reduction at its peaks, against dense grids; poles against closed forms."""

from types import SimpleNamespace

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, v, x
from hapticlab.analysis.impedance.impedance import impedance, port_of
from hapticlab.analysis.impedance.impedance_peaks import BESIDE, free, held
from hapticlab.analysis.impedance.mass_chain import network_of
from hapticlab.analysis.impedance.reduction import reduction
from hapticlab.errors import AnalysisError

BARE = SimpleNamespace(m=0.05, b=0.1, hand=None)
HELD = SimpleNamespace(m=0.05, b=0.1, hand=SimpleNamespace(m=0.02, b=4, k=400))


def chain(count, damping):
    masses = [hl.coordinate(f"z{i}", unit="m") for i in range(count)]
    K, M, B = hl.parameters("k m b", units="N/m kg N*s/m", values=(2000, 0.02, damping))
    places = [x(t), *masses]
    pulls = [K * (a - b) + (B * (_rate(a) - _rate(b)) if damping else 0) for a, b in zip(places, masses, strict=False)]
    eom = [sp.Eq(M * z.diff(t, 2), pull - rest) for z, pull, rest in zip(masses, pulls, [*pulls[1:], 0], strict=True)]
    return hl.Scene(force=pulls[0], eom=eom, name=f"chain of {count}")


def _rate(place):
    return v(t) if place == x(t) else place.diff(t)


def dense(offer, paddle, low, high):
    """Return the largest error over 20000 frequencies, those beside a pole left out."""
    f = np.linspace(low, high, 20_000)
    for pole, _ in offer.poles:
        f = f[np.abs(f - pole) >= BESIDE * pole]
    Z, reduced, s = impedance(offer.full, f), impedance(offer.scene, f), 2j * np.pi * f
    beside = paddle.m * s + paddle.b
    if paddle.hand:
        beside = beside + paddle.hand.m * s + paddle.hand.b + paddle.hand.k / s
    return float((np.abs(reduced - Z) / np.abs(Z + beside)).max())


@pytest.mark.parametrize(("paddle", "damping", "true"), [(BARE, 0.01, 0.225), (HELD, 0.002, 1.126), (BARE, 0.001, 2.251)])
@pytest.mark.always("paddle1-*")
def test_the_peak_of_a_damped_resonance_is_seen(paddle, damping, true):
    """At 17.48 Hz, 0.005 to 0.0005 Hz wide; two masses put it 0.001 Hz beside, which half a percent beside does not show."""
    two = reduction(chain(4, damping), paddle, band=(0.1, 20), masses=2, accept=True)
    worst = dense(two, paddle, 17.4, 17.6)
    assert worst == pytest.approx(true, rel=0.01)
    assert worst * 0.98 < two.largest < worst * 1.02
    assert not two.within and not two.poles
    three = reduction(chain(4, damping), paddle, band=(0.1, 20))
    assert three.masses == 3 and three.largest > 0.98 * dense(three, paddle, 17.4, 17.6)


def test_the_peak_of_the_free_handle_is_seen():
    """The handle and the chain swing against each other at 25.7 Hz, where their impedances together are next to none."""
    slippery = SimpleNamespace(m=0.05, b=1e-4, hand=None)
    offer = reduction(chain(4, 0.01), slippery, band=(0.1, 40), masses=2, accept=True)
    p = free(network_of(chain(4, 0.01), port_of(chain(4, 0.01))), slippery)
    peak = p.imag.min() / (2 * np.pi)
    worst = dense(offer, slippery, peak - 0.2, peak + 0.2)
    assert peak == pytest.approx(25.746, abs=1e-3) and worst > 2
    assert offer.largest > 0.98 * worst and offer.below(peak + 0.2) > 0.98 * worst


def test_a_pole_without_damping_is_reported_with_its_shift():
    first = 2 * np.sqrt(2000 / 0.02) * np.sin(np.pi / 18) / (2 * np.pi)
    offer = reduction(chain(4, 0), HELD, band=(0.1, 20), masses=2)
    ((before, now),) = offer.poles
    assert before == pytest.approx(first, rel=1e-12)
    reduced = network_of(offer.scene, port_of(offer.scene))
    assert now == pytest.approx(np.sqrt(reduced.stiffness[1, 1] / reduced.mass[0, 0]) / (2 * np.pi), rel=1e-12)
    assert offer.shift == pytest.approx(now / before - 1) == pytest.approx(6.2e-5, rel=0.01)
    assert offer.within and offer.largest > 0.98 * dense(offer, HELD, 0.1, 20)
    assert "infinite at 17.479 Hz, that of the reduced scene at 17.48 Hz (6.2e-05 of it away)" in str(offer)
    with pytest.raises(AnalysisError, match=r"at 17.479 Hz, that of the reduced scene at 25.165 Hz .* outside the tol"):
        reduction(chain(4, 0), HELD, band=(0.1, 20), masses=1)


def test_a_pole_that_nobody_feels_is_none():
    """Two equal masses, joined: they swing against each other at 45 Hz, and the handle does not know."""
    u, w = hl.coordinate("u", unit="m"), hl.coordinate("w", unit="m")
    k, m = hl.parameters("k m", units="N/m kg", values=(800, 0.03))
    eom = [sp.Eq(m * a.diff(t, 2), k * (x(t) - a) - k * (a - b)) for a, b in ((u, w), (w, u))]
    offer = reduction(hl.Scene(force=k * (x(t) - u) + k * (x(t) - w), eom=eom), HELD, band=(0.1, 60))
    assert offer.within and offer.masses == 1
    ((before, now),) = offer.poles
    assert before == pytest.approx(np.sqrt(800 / 0.03) / (2 * np.pi)) == pytest.approx(now)


def test_poles_of_a_chain():
    network = network_of(chain(5, 0.03), port_of(chain(5, 0.03)))
    p, z = held(network)
    natural = 2 * np.sqrt(2000 / 0.02) * np.sin(np.pi * (2 * np.arange(1, 6) - 1) / 22)
    decay = 0.03 / 2000 * natural**2 / 2
    order = np.argsort(p.imag)
    assert p[order] == pytest.approx(-decay + 1j * np.sqrt(natural**2 - decay**2), rel=1e-12)
    assert np.einsum("im,ij,jm->m", z.conj(), network.mass, z) == pytest.approx(np.ones(5), rel=1e-12)
    loose = free(network, HELD)
    Z = [network.impedance(np.array([a / (2j * np.pi)]))[0] + 0.07 * a + 4.1 + 400 / a for a in loose]
    assert np.abs(Z).max() < 1e-8 * 4.1
