"""Units against pint's own arithmetic, and the refusals in words."""

import pint
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.base.units import dimension, si_name
from hapticlab.errors import ParameterError, UnitsError
from hapticlab.scene.notation.units import unit_of

k, x_o, m, b, A = hl.parameters("k x_o m b A", units="N/m m kg N*s/m rad")
z = hl.coordinate("z", unit="m")


@pytest.mark.parametrize(
    ("expression", "unit"),
    [
        (k * (x(n) - x_o), "N"),
        (b * (v(t) - z.diff(t)), "N"),
        (m * z.diff(t, 2), "kg*m/s^2"),
        (sp.sqrt(k / m), "1/s"),
        (k * x(n) ** 2 / 2, "J"),
        (hl.when(x(n) >= x_o, m * v(n) ** 2), "N*m"),
        (sp.Abs(x(n)) + sp.Max(x_o, 0), "m"),
        (sp.cos(A) * k * x_o, "N"),
        (hl.laws.delay(b * v(n)), "N"),
        (x(n) / hl.T, "m/s"),
        (sp.sin(sp.atan2(x(n), x_o)) * t, "s"),
    ],
)
def test_the_unit_of_an_expression_is_what_pint_computes(expression, unit):
    registry = pint.get_application_registry()  # a new one takes 0.1 s
    assert registry.Unit(unit_of(expression)).is_compatible_with(unit) or unit_of(expression) == unit
    assert registry.Quantity(1, unit_of(expression)).to(unit).magnitude == pytest.approx(1, abs=1e-15)


@pytest.mark.parametrize(
    ("expression", "words"),
    [
        (k * x(n) + x_o, ["k*x(n) is in N", "x_o is in m"]),
        (k * (x(n) - sp.Float(0.01)), ["0.01 is a bare number", "values=0.01"]),
        (sp.sin(x(n)) * k * x_o, ["sin needs a number without unit", "x(n) is in m"]),
        (hl.when(x(n) >= k, k * x(n)), ["x(n) is in m", "k is in N/m"]),
        (hl.when(x(n) >= x_o, k * x(n), b), ["N", "N*s/m"]),
        (k * x(n) ** x(n), ["power"]),
    ],
)
def test_a_force_with_disagreeing_units_names_the_two_terms(expression, words):
    with pytest.raises(UnitsError) as refusal:
        hl.Scene(force=expression)
    assert all(word in str(refusal.value) for word in words), refusal.value


def test_a_force_that_is_not_a_force_and_an_equation_that_does_not_balance():
    with pytest.raises(UnitsError, match=r"x\(n\) is in m .* in N"):
        hl.Scene(force=x(n))
    with pytest.raises(UnitsError, match=r"N\*s but .* is in N"):
        hl.Scene(force=k * x(n), eom=[sp.Eq(m * z.diff(t), k * z)])
    with pytest.raises(UnitsError, match="initial value of y"):
        hl.Scene(force=k * hl.coordinate("y", unit="m", initial=m))


@pytest.mark.parametrize("unit", ["mm", "N/mm", "deg", "kN", "degC"])
def test_a_multiple_of_an_si_unit_is_refused_where_a_bare_number_would_be_read_in_it(unit):
    with pytest.raises(UnitsError, match="is not SI; declare"):
        hl.parameters("q", units=unit)


def test_a_float_exponent_is_the_fraction_it_stands_for():
    hertz = hl.parameters("k_h", units="N/m^1.5")
    assert unit_of(hertz * x(n) ** 1.5) == "N"
    assert unit_of(x_o**-2.0) == unit_of(x_o**-2)
    with pytest.raises(UnitsError, match="not a fixed fraction"):
        unit_of(x_o ** sp.Float(1.2345))


def test_an_unknown_unit_is_refused():
    with pytest.raises(UnitsError, match="not known"):
        hl.parameters("q", units="furlongs_per_paddle")


@pytest.mark.parametrize(("text", "metres"), [("10 mm", 0.01), ("1 cm", 0.01), ("2 inch", 0.0508), ("0.25 m", 0.25)])
def test_a_value_with_its_unit_is_converted(text, metres):
    assert hl.wall()(x_o=text).values["x_o"] == pytest.approx(metres, rel=1e-15)


def test_a_value_in_the_wrong_unit_is_refused():
    with pytest.raises(UnitsError, match="x_o = '10 N'; needs a quantity in m"):
        hl.wall()(x_o="10 N")
    with pytest.raises(ParameterError, match="needs a number in m"):
        hl.wall()(x_o=None)


def test_names_of_dimensions_round_trip():
    for unit in ("N", "N/m", "N*s/m", "kg", "m/s^2", "1"):
        assert si_name(dimension(unit)) == unit
    assert dimension(si_name(dimension("kg^2*m"))) == dimension("kg^2*m")
