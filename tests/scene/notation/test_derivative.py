"""Derivatives that are written down: what they are in symbols, in units and in print."""

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, v, x
from hapticlab.scene.notation.derivative import Partial, Rate
from hapticlab.scene.notation.symbols import acceleration
from hapticlab.scene.notation.units import unit_of

m, k, f = hl.parameters("m k f", units="kg N/m 1/s")
z, y = hl.coordinate("z", unit="m"), hl.coordinate("y", unit="m")
E = m * (z.diff(t) - y.diff(t) * sp.cos(z * k)) ** 2 / 2 - k * (z - x(t)) ** 2 * sp.exp(-y / 3) + v(t) * z.diff(t) * sp.sin(f * t)


@pytest.mark.parametrize("variable", [z, y, z.diff(t), y.diff(t), x(t), v(t), t, m, k])
def test_partial_holds_everything_else(variable):
    leaves = [z.diff(t), y.diff(t), x(t), v(t), z, y, t, m, k, f]
    plain = dict(zip(leaves, sp.symbols(f"p:{len(leaves)}"), strict=True))
    wanted = E.xreplace(plain).diff(plain[variable]).xreplace({p: e for e, p in plain.items()})
    assert sp.expand(Partial(E, variable).doit() - wanted) == 0


def test_rate_is_the_total_derivative_without_accelerations():
    total = E.diff(t).xreplace({z.diff(t, 2): 0, y.diff(t, 2): 0})
    total = total.xreplace({sp.Derivative(v(t), t, evaluate=False): acceleration(t)})
    assert sp.expand(Rate(E).doit() - total) == 0


def test_rates_nest():
    assert Rate(Rate(z**2)).doit() == 2 * z.diff(t) ** 2
    assert Rate(Rate(x(t))).doit() == acceleration(t)
    assert Rate(Partial(m * z.diff(t) ** 2 * y / 2, z.diff(t))).doit() == m * z.diff(t) * y.diff(t)
    assert Rate(z.diff(t)).doit() == 0


def test_a_number_does_not_change():
    assert Partial(3, z) == 0
    assert Rate(sp.pi) == 0


def test_units_are_divided():
    assert unit_of(Partial(k * z**2 / 2, z)) == "N"
    assert unit_of(Rate(z)) == "m/s"
    assert unit_of(Rate(Rate(z))) == "m/s^2"


def test_print():
    p = Partial(m * z.diff(t) ** 2 / 2, z.diff(t))
    assert sp.latex(p) == sp.latex(m * z.diff(t))
    assert str(p) == "Partial(m*Derivative(z(t), t)**2/2, Derivative(z(t), t))"
    assert str(Rate(z)) == "Rate(z(t))"
    assert sp.latex(Rate(z * y)) == sp.latex(z * y.diff(t) + y * z.diff(t))


def test_it_stands_in_expressions():
    assert (2 * Partial(z**3, z)).diff(z) == 12 * z
    assert Rate(z).subs(z, y) == Rate(y)
