"""Whether equations of motion determine every acceleration."""

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t
from hapticlab.compiler.algebra.graph import Graph
from hapticlab.compiler.prune.mass_matrix import is_definite
from hapticlab.errors import MassError

m, M, J, l = hl.parameters("m M J l", units="kg kg kg*m^2 m")
z, y = hl.coordinate("z", unit="m"), hl.coordinate("y", unit="m")
phi = hl.coordinate("phi", unit="rad")


def definite(*eom, **values):
    scene = hl.Scene(force=0, eom=list(eom), watch=[])
    return is_definite(scene.explicit(), values, Graph())


def test_masses_of_energies_are_definite():
    v2 = (z.diff(t) + l * sp.cos(phi) * phi.diff(t)) ** 2 + (l * sp.sin(phi) * phi.diff(t)) ** 2
    assert definite(hl.mechanics.lagrange(M * z.diff(t) ** 2 / 2 + m * v2 / 2))


def test_a_negative_matrix_is_of_one_sign():
    assert definite(sp.Eq(-m * z.diff(t, 2), M * y.diff(t, 2) * 0), sp.Eq(-M * y.diff(t, 2), 0))


@pytest.mark.parametrize(
    "eom",
    [
        [sp.Eq(m * z.diff(t, 2) + M * y.diff(t, 2), 0), sp.Eq(M * y.diff(t, 2), 0)],
        [sp.Eq(m * y.diff(t, 2) + 3 * m * z.diff(t, 2), 0), sp.Eq(3 * m * y.diff(t, 2) + m * z.diff(t, 2), 0)],
        [sp.Eq(m * z.diff(t, 2), 0), sp.Eq(-M * y.diff(t, 2), 0)],
    ],
    ids=["not symmetric", "not of one sign", "of two signs"],
)
def test_what_needs_pivots(eom):
    assert not definite(*eom)


def test_small_masses_beside_large_ones_are_masses():
    assert definite(hl.mechanics.lagrange(M * z.diff(t) ** 2 / 2 + m * y.diff(t) ** 2 / 2), M=1e6, m=1e-9)


def test_masses_that_cancel_are_seen_in_their_values():
    rate = z.diff(t) - y.diff(t)
    L = m * rate**2 / 2 + M * y.diff(t) ** 2 / 2
    assert definite(hl.mechanics.lagrange(L), m=0.1, M=0.2)
    with pytest.raises(MassError, match="accelerations of y and z"):
        definite(hl.mechanics.lagrange(m * rate**2 / 2))


def test_a_turned_massless_direction_is_found():
    rate = phi.diff(t) * l + z.diff(t) * sp.cos(phi)
    with pytest.raises(MassError, match="accelerations of phi and z"):
        definite(hl.mechanics.lagrange(m * rate**2 / 2))


def test_an_arm_that_is_singular_at_its_start_alone_goes_on_with_pivots():
    assert not definite(hl.mechanics.lagrange(m * (l * sp.sin(phi) * phi.diff(t)) ** 2 / 2))


def test_nothing_moves():
    assert not definite()
