"""Coordinates defined by equations: in any order, at no cost, and never lost without a word."""

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, x
from hapticlab.errors import MassError, SceneError
from hapticlab.scene.aliases import definitions, substituted

w, y, z = (hl.coordinate(name, unit="m") for name in "wyz")
k, m, b = hl.parameters("k m b", units="N/m kg N*s/m", values=(300, 0.05, 0.4))


def test_a_chain_in_any_order():
    equations = [sp.Eq(w, y / 2 + x(t)), sp.Eq(y, 3 * z), sp.Eq(m * z.diff(t, 2), -k * w)]
    known, rest = definitions(equations, (w, y, z))
    assert known == {y: 3 * z, w: sp.Rational(3, 2) * z + x(t)}
    assert rest == [equations[2]]
    moved = substituted(w * y.diff(t, 2) + w.diff(t), known)
    assert sp.expand(moved - (3 * z / 2 + x(t)) * 3 * z.diff(t, 2) - 3 * z.diff(t) / 2 - hl.v(t)) == 0


def test_an_equation_with_rates_is_one_of_motion():
    assert definitions([sp.Eq(z, -y.diff(t) * b / k), sp.Eq(y, 2 * y - z)], (y, z))[0] == {}


def test_a_gear_costs_what_its_definition_costs():
    """A mass behind a gear, its motion z written as w = 3 z throughout, against the same without the name."""

    def scene(place, rate, eom):
        F = k * (x(t) - place)
        return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), 3 * F - b * rate), *eom], watch={"place": place})

    named = scene(w, w.diff(t), [sp.Eq(w, y), sp.Eq(y, 3 * z)])
    plain = scene(3 * z, 3 * z.diff(t), [])
    programs = [hl.compile(s, T=1e-3) for s in (named, plain)]
    assert programs[0].tick == programs[1].tick and programs[0].states == programs[1].states
    assert named.explicit().coordinates == (z,)


@pytest.mark.parametrize(
    ("equations", "said"),
    [
        ([sp.Eq(y, 2 * w), sp.Eq(w, z + y), sp.Eq(z, w)], r"y\(t\) -> w\(t\) -> y\(t\): these are defined by each other."),
        ([sp.Eq(y, z), sp.Eq(y, 2 * z)], "two equations define y"),
    ],
)
def test_what_is_not_defined(equations, said):
    with pytest.raises(SceneError, match=said):
        definitions(equations, (w, y, z))


def test_starts_are_not_lost():
    a = hl.coordinate("a", unit="m", initial=1)
    with pytest.raises(SceneError, match="a is defined by .* Leave out initial="):
        definitions([sp.Eq(a, z)], (a, z))
    c = hl.coordinate("c", unit="m", initial=2 * y)
    with pytest.raises(SceneError, match="c starts at 2.*; write z"):
        definitions([sp.Eq(y, z)], (c, y, z))


def test_in_a_scene():
    late = hl.Scene(force=k * y, eom=[sp.Eq(y, x(t) + z), sp.Eq(m * z.diff(t, 2), -k * y - b * y.diff(t, 2) * m / b)])
    with pytest.raises(SceneError, match="acceleration of the handle"):
        late.explicit()
    twice = hl.Scene(force=k * y, eom=[sp.Eq(y, z), sp.Eq(m * y.diff(t, 2), -k * y), sp.Eq(m * z.diff(t, 2), -k * z)])
    with pytest.raises(MassError, match="2 equations of motion for 1 coordinates"):
        twice.explicit()
