"""What a student may write by mistake: every slip gets a refusal in words, and no name hides a measured channel."""

import dataclasses

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.device.simulated.closed_loop import link
from hapticlab.errors import HapticlabError, ParameterError, SceneError, SignalError, UnitsError
from hapticlab.scene.notation.written import RESERVED, check_name

k, m, b, K, x_o, F_0 = hl.parameters("k m b K x_o F_0", units="N/m kg N*s/m N/m m N", values=(100, 0.1, 1, 300, 0.01, 1))
z = hl.coordinate("z", unit="m")
y = hl.signal("y", unit="m")


def test_every_name_of_a_record_and_of_the_loop_is_reserved():
    of_a_record = {f.name for f in dataclasses.fields(hl.records.Telemetry)} | {
        name for name in dir(hl.records.Telemetry) if not name.startswith("_")
    }
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, delay=1e-4, counts_per_metre=1e5, coulomb=0.1, force_max=5)
    loop = link(hl.compile(hl.wall()(k=100), T=1e-3), paddle)
    of_the_loop = {c.name for c in (*loop.inputs, *loop.outputs, *loop.states) if c.name.isidentifier()}
    assert of_a_record | of_the_loop <= RESERVED


TAKEN = ["x", "F", "T", "delay", "channels", "x_true", "fault", "tick", "lambda", "", "a b", "__class__"]


@pytest.mark.parametrize("name", TAKEN)
def test_a_name_that_is_taken_or_no_word_is_refused_everywhere(name):
    declarations = [
        lambda: hl.parameters(name, units="m"),
        lambda: hl.coordinate(name, unit="m"),
        lambda: hl.signal(name, unit="m"),
        lambda: hl.Scene(force=k * x(n), watch={name: k * x(n)}),
    ]
    for declare in declarations[not name or " " in name :]:  # a text without a word, or with two, declares 0 or 2 parameters
        with pytest.raises(SceneError, match="cannot name a (parameter|coordinate|signal|watched channel)"):
            declare()
    assert check_name("k_1", "coordinate") == "k_1"


def test_what_is_watched_without_a_name_is_called_as_written_unless_that_is_taken():
    assert list(hl.Scene(force=k * x(n), watch=[z, x(n - 1), k]).watch) == ["z", "x(n - 1)", "k"]
    with pytest.raises(SceneError, match="a record has a column T of its own. Give the channel another name,"):
        hl.Scene(force=k * x(n), watch=[hl.T])


def scenes():
    force = k * x(n)
    return [
        ({"force": None}, "force = None; needs a number"),
        ({"force": [force]}, "needs a number, or an expression"),
        ({"force": "k*"}, r"force = 'k\*'"),
        ({"force": ""}, "force = ''"),
        ({"force": x}, r"force = x; needs one of its values: write x\(n\)"),
        ({"force": y}, r"write y\(n\)"),
        ({"force": F_0 * sp.I}, "not a real number"),
        ({"force": F_0 * sp.nan}, "not a real number"),
        ({"force": x(n) > 0}, "a condition is not a number"),
        ({"force": sp.Eq(z, x_o)}, r"force = Eq\(z\(t\), x_o\) is an equation; needs an expression,"),
        ({"watch": [None]}, "needs a number"),
        ({"watch": {"q": [1]}}, r"watch q = \[1\]"),
        ({"watch": 5}, "watch = 5; needs a list"),
        ({"watch": None}, "watch = None; needs a list"),
        ({"eom": None}, "eom contains None; needs equations,"),
        ({"eom": 5}, "eom contains 5;"),
        ({"eom": [sp.Eq(y(n), x(n) > x_o)]}, r"eom contains False; one side .* a condition.*hl.when\(condition, 1, 0\)"),
        ({"values": 5}, "values = 5; needs a dict"),
        ({"force": k * x(sp.Symbol("n"))}, "from hapticlab import n"),
        ({"force": k * x_o * sp.Symbol("t", real=True)}, "from hapticlab import t"),
        ({"force": k * z.subs(t, 0)}, r"z is a coordinate, a function of time; write z\(t\)"),
    ]


@pytest.mark.parametrize("given, words", scenes())
def test_a_scene_made_of_what_is_no_expression_is_refused(given, words):
    with pytest.raises(SceneError, match=words):
        hl.Scene(**{"force": k * x(n), **given})


@pytest.mark.parametrize("value", ["1/0 N/m", "10 N/m; 5", "10 N/m 5", "N/m", "", 10**400, True, [1], 1j])
def test_a_value_that_is_no_quantity_is_refused(value):
    with pytest.raises(HapticlabError, match="k = .*; needs a (quantity|number) in N/m"):
        hl.Scene(force=k * x(n))(k=value)


@pytest.mark.parametrize("unit", ["1/0", "m**", "(m", "m;", "5 m", None, ["m"]])
def test_a_unit_that_is_none_is_refused(unit):
    with pytest.raises(UnitsError, match="is not (known|a text)"):
        hl.coordinate("c", unit=unit)


@pytest.mark.parametrize(
    "options, words",
    [
        ({"values": 5}, r"values = 5 for 2 names \(q r\); give one for each"),
        ({"values": "ab"}, "give one for each"),
        ({"values": {1: 2}}, "1 is not among"),
        ({"ranges": 5}, "ranges = 5"),
        ({"ranges": ("a", "b")}, r"q: range 'a'; needs \(low, high\) in m"),
        ({"ranges": ((1, 2, 3), (1, 2, 3))}, "needs .low, high."),
    ],
)
def test_a_declaration_that_is_no_declaration_is_refused(options, words):
    with pytest.raises(ParameterError, match=words):
        hl.parameters("q r", units="m m", **options)
    with pytest.raises(ParameterError, match="names = .*one text, with spaces between names,"):
        hl.parameters(["q"], units="m")


def test_a_parameter_may_be_called_self():
    assert hl.Scene(force=k * x(n) * hl.parameters("self", units="1"))(self=2).values == {"k": 100.0, "self": 2.0}


def other_declarations():
    return [
        (hl.coordinate("z", unit="rad") * k * x_o, "two different coordinates are called z"),
        (k * hl.coordinate("z", unit="m", initial=x_o), "two different coordinates are called z"),
        (k * hl.signal("z", unit="m")(n), "a coordinate and a signal are called z|a signal and a coordinate"),
        (k * z * hl.parameters("z", units="1"), "a parameter and a coordinate are called z"),
        (k * hl.coordinate("w", unit="m", initial=hl.coordinate("z", unit="m", initial=1 * x_o)), "are called z"),
    ]


@pytest.mark.parametrize("other, words", other_declarations())
def test_two_things_of_one_name_are_refused(other, words):
    with pytest.raises(SceneError, match=words):
        hl.Scene(force=k * z + other)


def test_one_name_is_declared_once_in_a_list():
    with pytest.raises(ParameterError, match="q is declared twice"):
        hl.parameters("q r q", units="m m m")


@pytest.mark.parametrize(
    "equations, words",
    [
        ([sp.Eq(y(n), x(n)), sp.Eq(y(n), 2 * x(n))], r"two equations define y\(n\)"),
        ([sp.Eq(y(n), x(n)), sp.Eq(y(n - 1), x(n))], r"y\(n - 1\) is past and fixed"),
        ([sp.Eq(y(n + 1), y(n) + 2 * x(n))], r"shift the equation: sp.Eq\(y\(n\), .*2\*x\(n - 1\)"),
        ([sp.Eq(x(n), y(n))], r"alone on the left, sp.Eq\(y\(n\), ...\)"),
        ([sp.Eq(2 * y(n), x(n))], "alone on the left"),
    ],
)
def test_an_equation_that_does_not_define_a_signal_once_is_refused(equations, words):
    with pytest.raises(SceneError, match=words):
        hl.Scene(force=k * y(n), eom=equations).explicit()


def test_a_rate_that_a_first_order_equation_would_lose_is_refused():
    s = hl.coordinate("s", unit="m", rate=hl.parameters("r", units="m/s"))
    with pytest.raises(SceneError, match="s has an equation of first order.*rate=r would have no effect."):
        hl.Scene(force=k * s, eom=[sp.Eq(b * s.diff(t), k * (x(t) - s))]).explicit()


@pytest.mark.parametrize(
    "condition, words",
    [
        (x(n) == x_o, r"write sp.Eq\(a, b\)"),
        (x(n), "write one, such as x"),
        (k, "k is not a condition"),
        ((y(n - 1) == 1) & (x(n) > k), r"False for every motion.*Python's ==.*write sp.Eq\(s\(n-1\), 1\)"),
        ("x>0", "is not a condition"),
        (None, "None is not a condition"),
    ],
)
def test_a_condition_that_is_none_is_refused(condition, words):
    with pytest.raises(SceneError, match=words):
        hl.when(condition, F_0)


@pytest.mark.parametrize(
    "rate, words",
    [
        (b * x(n).diff(t), r"x\(n\) has no derivative.*write v\(n\)"),
        ((b * x(n)).diff(t), r"write v\(n\)"),
        (b * x(n).diff(n), "has no derivative"),
        ((b * y(n - 1)).diff(t), r"write \(y\(n\) - y\(n-1\)\)/T"),
        (b * hl.laws.delay(x(n)).diff(t), r"delay\(x\(n\)\) has no derivative"),
        (b * hl.when(x(n) >= x_o, x(n)).diff(t), "has no derivative"),
        (m * x(t).diff(t, 2), r"acceleration of the handle.*write \(v\(n\) - v\(n-1\)\)/T"),
        (m * v(t).diff(t), "acceleration of the handle"),
        (b * sp.Derivative(x(t), t), r"Write v\(t\),"),
    ],
)
def test_a_rate_nobody_measures_is_refused_and_not_taken_for_zero(rate, words):
    with pytest.raises(SignalError, match=words):
        hl.Scene(force=rate)


def test_sympy_may_simplify_substitute_and_compare_samples():
    law = k * x(n) * sp.sin(v(n) / v(n - 1)) ** 2 + k * x(n) * sp.cos(v(n) / v(n - 1)) ** 2
    assert sp.simplify(law) == k * x(n)
    assert (x(n) + x(n - 1)).subs({x(n): x(n - 1), x(n - 1): x(n)}, simultaneous=True) == x(n) + x(n - 1)
    assert ((x(n) + 1) ** 2).equals(x(n) ** 2 + 2 * x(n) + 1)
    assert (x(t) + x(n)).subs(t, 0).has(x(n))
    cases = hl.when(x(n) >= x_o, k * x(n))
    assert sp.simplify(cases + k * x(n) - cases) == k * x(n)
    assert cases.subs(k, K) == hl.when(x(n) >= x_o, K * x(n))


def test_cases_are_set_as_sympy_sets_its_own():
    cases = hl.when(x(n) >= x_o, k * x(n))
    own = sp.Piecewise((k * x(n), x(n) >= x_o), (0, True), evaluate=False)
    assert sp.latex(cases) == sp.latex(own)
    assert sp.pretty(cases) == sp.pretty(own)
    assert str(cases) == str(own)


def test_a_potential_with_cases_has_a_force():
    potential = hl.when(hl.when(z > 0, z) > 0, k * z**2 / 2)
    assert potential.diff(z) == hl.when(hl.when(z > 0, z) > 0, k * z)


def test_the_delay_of_a_number_is_the_number_and_a_condition_has_none():
    assert hl.laws.delay(3) == 3
    with pytest.raises(SignalError, match=r"write hl.laws.delay\(hl.when\(x\(n\) > 0, 1, 0\)\) > 0"):
        hl.laws.delay(x(n) > 0)


def test_numpy_numbers_are_numbers():
    assert hl.Scene(force=np.float64(2.0) * k * x(n))(k=np.float32(3)).values == {"k": 3.0}
