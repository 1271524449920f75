"""Parameters, coordinates and signals: their ranges, their samples, and what is refused."""

import copy
import math
import pickle
import subprocess
import sys

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.errors import HapticlabError, ParameterError, SignalError


@pytest.mark.parametrize("ahead", [1, 2])
def test_a_future_sample_is_refused_and_the_prediction_taught(ahead):
    with pytest.raises(SignalError, match=r"future.*2\*x\(n\) - x\(n-1\), Eq. \(23.4\)"):
        x(n + ahead)


@pytest.mark.parametrize("argument", [n / 2, n - sp.Rational(1, 2), 3, t - 1, sp.Symbol("q")])
def test_what_is_not_a_sample_is_refused(argument):
    """Not always when written, for SymPy tries arguments of its own; at the latest in a scene."""
    k = hl.parameters("k", units="N/m")
    with pytest.raises(HapticlabError, match="is not a sample|plain SymPy symbol"):
        hl.Scene(force=k * x(argument))


def test_the_velocity_is_the_derivative_of_the_position():
    assert (x(t) ** 2).diff(t) == 2 * x(t) * v(t)


@pytest.mark.parametrize(
    ("name", "unit", "value", "words"),
    [
        ("k", "N/m", -50, "k = -50 N/m; a stiffness needs k >= 0"),
        ("b", "N*s/m", -1, "b = -1 N\\*s/m; a damping needs b >= 0"),
        ("m", "kg", 0, "a mass needs m > 0"),
        ("m", "kg", -0.1, "a mass needs m > 0"),
        ("J", "kg*m^2", 0, "a moment of inertia needs J > 0"),
        ("tau", "s", -1e-3, "a time needs tau >= 0"),
        ("k", "N/m", math.nan, "k = nan; needs a finite number in N/m"),
        ("x_o", "m", math.inf, "x_o = inf; needs a finite number in m"),
    ],
)
def test_a_value_that_is_not_physical_is_refused_by_name(name, unit, value, words):
    parameter = hl.parameters(name, units=unit)
    scene = hl.Scene(force=parameter / parameter * hl.parameters("F_0", units="N") + 0 * parameter, name="s")
    with pytest.raises(ParameterError, match=words):
        parameter.check(value)
    assert name not in scene.parameters  # SymPy cancelled it, and the scene knows only what it uses


def test_a_declared_range_replaces_the_default_and_is_kept():
    k = hl.parameters("k", units="N/m", ranges=(-200, 200))
    assert k.check(-150) == -150
    with pytest.raises(ParameterError, match="k = 250 N/m; it was declared to lie between -200 and 200"):
        k.check(250)
    with pytest.raises(ParameterError, match="is empty"):
        hl.parameters("k", units="N/m", ranges=(2, 1))


@pytest.mark.parametrize(
    ("names", "units", "words"),
    [("k m", "N/m", "2 names .* but 1 units"), ("x", "m", "cannot name a parameter"), ("2k", "N", "cannot name")],
)
def test_a_declaration_that_does_not_add_up_is_refused(names, units, words):
    with pytest.raises(ParameterError, match=words):
        hl.parameters(names, units=units)


def test_values_and_ranges_given_for_a_name_that_is_not_declared_are_refused():
    with pytest.raises(ParameterError, match="q is not among the names k b"):
        hl.parameters("k b", units="N/m N*s/m", values={"q": 1})
    with pytest.raises(ParameterError, match="1 entries for 2 names"):
        hl.parameters("k b", units="N/m N*s/m", values=[1])


def test_parameters_with_different_units_or_ranges_are_different_symbols():
    one, other = hl.parameters("q", units="m"), hl.parameters("q", units="N")
    assert one != other
    assert one == hl.parameters("q", units="m")
    with pytest.raises(ParameterError, match="two different parameters are called q"):
        hl.Scene(force=other + hl.parameters("c", units="N/m") * one)


@pytest.mark.parametrize(
    "thing", [hl.parameters("k", units="N/m", ranges=(0, 5)), hl.coordinate("z", unit="m", initial=x(n)), x(n - 1), v(t)]
)
def test_symbols_survive_pickling_and_copying(thing):
    assert pickle.loads(pickle.dumps(thing)) == thing
    assert copy.deepcopy(thing) == thing
    assert getattr(pickle.loads(pickle.dumps(thing)), "unit", "") == getattr(thing, "unit", "")


def test_a_signal_restored_elsewhere_still_has_no_rate():
    """Another process has no memory of the class: what comes out of the pickle must carry it."""
    code = (
        "import pickle, sys; from hapticlab import t; "
        "y = pickle.loads(sys.stdin.buffer.read()); assert y.diff(t) != 0; assert type(y).unit == 'm'"
    )
    sent = pickle.dumps(hl.signal("y", unit="m")(n - 1))
    subprocess.run([sys.executable, "-c", code], input=sent, check=True)


def test_coordinates_that_differ_only_in_their_start_are_told_apart():
    one, other = hl.coordinate("z", unit="m"), hl.coordinate("z", unit="m", initial=x(n))
    assert type(one).initial == 0
    assert type(other).initial == x(n)
    assert one != other


@pytest.mark.parametrize(
    "wrong",
    [lambda k, y: k * y, lambda k, y: y - k, lambda k, y: -y, lambda k, y: 1 / y, lambda k, y: y > k, lambda k, y: k >= y],
)
def test_arithmetic_and_comparison_on_a_function_that_is_not_applied_is_refused(wrong):
    k = hl.parameters("k", units="N/m")
    for y in (hl.x, hl.v, hl.signal("y", unit="m")):
        with pytest.raises(hl.errors.SignalError, match=rf"{y.__name__} is a function of time; write {y.__name__}\(n\)"):
            wrong(k, y)
