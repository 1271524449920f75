"""Units read without pint, against pint's own answers for the same text."""

import random

import pint
import pytest

from hapticlab.base import metric as table
from hapticlab.base import units
from hapticlab.base.metric import metric

REGISTRY = pint.UnitRegistry()
#: rounding: pint multiplies one size after another, and of a product of six each may be rounded
CLOSE = 1e-14


def by_pint(unit):
    one = REGISTRY.Quantity(1.0, unit)
    return one.to_base_units().magnitude, units._exponents(one)


@pytest.mark.parametrize("unit", sorted(table._SIZES))
def test_every_unit_and_prefix_is_what_pint_says(unit):
    size, exponents = by_pint(unit)
    assert metric(unit) == (pytest.approx(size, rel=1e-15), exponents)


def test_products_and_powers_are_what_pint_says():
    draw, names = random.Random(1), sorted(table._SIZES)
    for _ in range(500):
        text = draw.choice(names)
        for _ in range(draw.choice([1, 2, 3])):
            joint, power = draw.choice(["*", "/", " ", " * ", " / "]), draw.choice(["", "", "^2", "**3", "^-1", "^0.5", "**1.5"])
            text += joint + draw.choice(names) + power
        size, exponents = by_pint(text)
        assert metric(text) == (pytest.approx(size, rel=CLOSE), exponents), text


@pytest.mark.parametrize("number", [1.0, 0.1, 3.0, 7.3, 38.0, 1e-9, 2 / 3])
@pytest.mark.parametrize(
    "units_of_it",
    ["mm m", "cm m", "um m", "ms s", "g kg", "N/mm N/m", "mm/s m/s", "kHz 1/s", "deg rad"],
)
def test_a_converted_value_has_the_bits_that_pint_gives_it(number, units_of_it):
    own, si = units_of_it.split()
    assert units.in_si(f"{number!r} {own}", si, "q") == REGISTRY.Quantity(number, own).to(si).magnitude


@pytest.mark.parametrize(
    "unit", ["", "m*", "*m", "m//s", "m**", "N/m; 5", "2*m", "m 2", "lbf", "°", "N*(m/s)", "m^2^2", "km^", "%"]
)
def test_what_else_is_written_is_left_to_pint(unit):
    assert metric(unit) is None


@pytest.mark.parametrize(
    "text, si, value",
    [
        ("2 lbf", "N", 8.896443230521), ("3 inch", "m", 0.0762), ("16 oz", "kg", 0.45359237),
        ("60 rpm", "rad/s", 6.283185307179586), ("1 lbf/in", "N/m", 175.12683524647636), ("2 min", "s", 120.0),
        ("1 ft", "m", 0.3048), ("180 degrees", "rad", 3.141592653589793), ("5 newton / millimeter", "N/m", 5000.0),
        ("25 degC", "K", 298.15),
    ],
)  # fmt: skip
def test_a_unit_that_only_pint_knows_is_converted_as_before(text, si, value):
    assert units.in_si(text, si, "q") == pytest.approx(value, rel=1e-14)
    assert units.quantity(text, "q")[0] == pytest.approx(value, rel=1e-14)


def test_a_wrong_dimension_is_refused_in_pints_words():
    with pytest.raises(units.UnitsError, match=r"needs a quantity in m, like '2 m' \(Cannot convert from 'newton'"):
        units.in_si("10 N", "m", "x_o")
