"""Eq. (23.9) along records: every term against energies of its own derivation."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, x
from hapticlab.base.telemetry import Telemetry
from hapticlab.errors import AnalysisError

T, K, B = 1e-3, 180.0, 0.1
PADDLE = hl.SimulatedPaddle(m=0.05, b=B, T=T, hand=hl.Hand(m=0.02, b=1.0, k=200.0, intent=lambda s: 0.004 * np.sin(40 * s)))


def ran(scene, paddle=PADDLE, duration=0.6, **options):
    return paddle.run(scene, duration=duration, progress=False, **options)


def test_the_terms_of_a_plain_wall_are_the_hand_s_kinetic_energy_and_the_springs():
    """Without hand and damping the kinetic energy says what was supplied: nothing of the check is used twice."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=T)
    log = ran(hl.wall()(k=K, x_o=0.001), paddle, v=0.3, duration=0.12, dtype="float64")
    found = hl.records.storage(log, hl.laws.wall_energy(), stiffness=K)
    kinetic = 0.05 * log.v**2 / 2
    np.testing.assert_allclose(found.supplied, kinetic[0] - kinetic, atol=1e-14)
    np.testing.assert_allclose(found.stored, K * np.maximum(log.x - 0.001, 0) ** 2 / 2, atol=1e-16)
    np.testing.assert_allclose(found.stored[0] + found.supplied - found.stored, found.excess, atol=1e-16)
    assert found.leak.sum() == pytest.approx(kinetic[-1] - kinetic[0], abs=1e-14)
    assert not found.holds and found.within_bound
    assert "fails for the environment" in str(found)


def test_damping_that_pays_for_the_hold_makes_it_hold():
    """b >= K T/2, Eq. (23.10), on the unilateral wall with a hand that pushes; and what was paid at least was paid."""
    log = ran(hl.wall()(k=K))
    bare, paid = (
        hl.records.storage(log, hl.laws.wall_energy(), stiffness=K),
        hl.records.storage(log, hl.laws.wall_energy(), b=B, stiffness=K),
    )
    assert not bare.holds and paid.holds and paid.within_bound
    # the damper's true loss, by Simpson's rule over a speed that is all but a straight line within each period
    middle = (log.v[1:] + log.v[:-1]) / 2
    assert paid.paid.sum() <= B * T * np.sum((log.v[:-1] ** 2 + 4 * middle**2 + log.v[1:] ** 2) / 6)
    assert paid.paid.sum() == pytest.approx(B * np.trapezoid(log.v**2, dx=T), rel=2e-3)


def test_a_predictive_law_leaks_more_than_its_spring_allows():
    """Eq. (23.7) is passive for slow motion only: above f_s/4 it generates, and the storage of the spring tells."""
    place = 1e-4 * np.tile([1.0, -1.0], 50) + 0.002
    F = K * (2 * place - 1.5 * np.roll(place, 1) + 0.5 * np.roll(place, 2))[2:]
    log = Telemetry(t=np.arange(98) * T, x=place[2:], v=0 * F, F=F, T=T, parameters={"k": K})
    found = hl.records.storage(log, hl.laws.wall_energy().subs(hl.parameters("x_o", units="m", values=0), 0), stiffness=K)
    assert not found.within_bound and "more than stiffness D^2/2" in str(found)
    # at Nyquist F = K (p + 4 a): four times the leak of the plain law
    np.testing.assert_allclose(found.leak, 4 * K * (2e-4) ** 2 / 2, rtol=1e-9)


def mass_on_a_coupler():
    m, c, k = hl.parameters("m c K", units="kg N*s/m N/m", values=(0.04, 0.5, 150))
    z = hl.coordinate("z", unit="m")
    gap = x(t) - z
    L = m * z.diff(t) ** 2 / 2 - k * gap**2 / 2
    damper = c * (hl.v(t) - z.diff(t)) ** 2 / 2
    return hl.Scene(force=hl.laws.virtual_coupler(z, K=k, b=c), eom=[hl.mechanics.lagrange(L, dissipation=damper)]), z


def test_the_storage_of_a_scene_is_its_lagrangian_energy():
    scene, z = mass_on_a_coupler()
    books = hl.records.energy_books(scene)
    books = hl.Scene(books.force, books.eom, {**books.watch, "z": z, "rate": z.diff(t)}, books.values)
    differences = []
    for period in (T, T / 4):
        log = ran(books, replace(PADDLE, T=period), dtype="float64")
        found, lost = hl.records.storage(log), log.dissipated[-1] - log.dissipated[0]
        differences.append(found.leak.sum() + lost)
    energy = 0.04 * log.rate**2 / 2 + 150 * (log.x - log.z) ** 2 / 2
    np.testing.assert_allclose(found.stored, energy, atol=1e-15)
    # supplied = stored + dissipated, but for the sampling of the port, which is of the first order in T
    assert lost > 0.01 and abs(differences[1]) < 0.06 * lost
    assert differences[0] / differences[1] == pytest.approx(4, rel=0.05)
    assert found.holds


def test_arrays_and_their_sizes():
    log = ran(hl.wall()(k=K), duration=0.05)
    given = K * np.maximum(log.x, 0) ** 2 / 2
    np.testing.assert_allclose(
        hl.records.storage(log, given).leak, hl.records.storage(log, hl.laws.wall_energy()).leak, atol=1e-18
    )
    for stored, words in [
        (None, "hl.records.energy_books"), (given[1:], "one energy per sample:"),
        (hl.v(hl.n) ** 2, "x\\(n\\) and parameters alone"),
        (sp.Symbol("q") * hl.laws.wall_energy(), "q"), (hl.parameters("q", units="N/m") * x(hl.n) ** 2, "has no parameter q"),
    ]:  # fmt: skip
        with pytest.raises(AnalysisError, match=words):
            hl.records.storage(log, stored)


def test_the_picture():
    above, below = hl.records.storage(ran(hl.wall()(k=K), duration=0.2), hl.laws.wall_energy(), b=B).plot().axes
    assert above.get_ylabel() == "energy [mJ]" and below.get_xlabel() == "time t [s]"
    assert len(above.lines) == 2 and len(below.lines) == 2
