"""A name of hapticlab that was given another value is told where the scene can see it."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.errors import HapticlabError

k = hl.parameters("k", units="N/m")


@pytest.mark.parametrize(
    ("force", "words"),
    [
        (lambda: k * 0.01, "neither x\\(n\\) nor v\\(n\\). Was x or v given another value\\? Write from hapticlab import x,"),
        (lambda: k * sp.Symbol("x"), "x is a different symbol with this name. Write from hapticlab import x"),
        (lambda: k * sp.Function("x")(t), "x\\(t\\) is a different function with this name. Write from hapticlab import x"),
        (lambda: k * x(sp.Symbol("n")), "n is a different symbol with this name. Write from hapticlab import n"),
        (lambda: k * x(np.linspace(0, 1, 3)), r"Was n or t given another value\? Write from hapticlab import n,"),
        (lambda: k * x(5), "x\\(5\\) is not a sample"),
        (lambda: k * x, "x is a function of time; write x\\(n\\)"),
    ],
)
def test_a_shadowed_name_is_told(force, words):
    with pytest.raises(HapticlabError, match=words):
        hl.Scene(force=force())


@pytest.mark.parametrize("name", ["x", "v", "n", "t", "T"])
@pytest.mark.parametrize("declare", [hl.coordinate, hl.signal, lambda name, unit: hl.parameters(name, units=unit)])
def test_no_declaration_shadows_them(declare, name):
    with pytest.raises(
        HapticlabError, match=f"'{name}' cannot name .*, because a scene or its record already uses the name {name}. Use {name}_1"
    ):
        declare(name, unit="m")


@pytest.mark.parametrize("unit", ["deg", "degree", "°"])
def test_a_degree_is_declared_as_a_radian(unit):
    with pytest.raises(
        HapticlabError, match=f"unit '{unit}' is not SI; declare rad and bind a value with its unit, as in '10 {unit}'"
    ):
        hl.coordinate("q", unit=unit)


def test_a_unit_that_is_right_needs_no_hint():
    with pytest.raises(HapticlabError) as refused:
        hl.Scene(force=k * x(n) ** 2 + hl.parameters("F_0", units="N") * n)
    assert "was x" not in str(refused.value)
