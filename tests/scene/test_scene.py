"""Scenes: binding, printing, and every refusal of an equation that cannot be felt."""

import copy
import pickle

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.errors import HapticlabError, MassError, ParameterError, SceneError, SignalError

K, b, m, k, x_o = hl.parameters("K b m k x_o", units="N/m N*s/m kg N/m m")
z = hl.coordinate("z", unit="m")
y = hl.coordinate("y", unit="m")
F_c = K * (x(t) - z) + b * (v(t) - z.diff(t))
mass = hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c)], name="mass")


def test_binding_returns_a_new_scene_and_leaves_the_old_one():
    bound = mass(m=0.1)(K="0.5 N/mm")
    assert bound.values == {"m": 0.1, "K": 500.0}
    assert mass.values == {}
    with pytest.raises(AttributeError):
        mass.name = "other"


def test_what_a_scene_holds_cannot_be_changed_behind_its_checks():
    bound = mass(m=0.1)
    with pytest.raises(TypeError):
        bound.values["m"] = float("nan")
    with pytest.raises(TypeError):
        bound.watch["m"] = K
    assert repr(bound.values) == "{'m': 0.1}"


def test_a_scene_survives_pickling_and_copying_and_can_be_a_key():
    walled = hl.Scene(force=F_c + hl.when(hl.when(z >= x_o, z - x_o) > 0, k * z), eom=mass.eom, watch=[z], values={"m": 0.1})
    for same in (pickle.loads(pickle.dumps(walled)), copy.deepcopy(walled)):
        assert same == walled
        assert {walled: 1}[same] == 1
    assert mass(m=0.1) != mass(m=0.2)


def test_an_unknown_parameter_is_refused_and_the_known_ones_listed():
    with pytest.raises(ParameterError, match=r"no parameter mass; it has K \[N/m\], b \[N\*s/m\], m \[kg\]"):
        mass(mass=1)


def test_defaults_are_bound_until_they_are_overridden():
    g = hl.parameters("g", units="m/s^2", values=9.81)
    weight = hl.Scene(force=m * g)
    assert weight.values == {"g": 9.81}
    assert weight(g=1.62).values == {"g": 1.62}


def test_the_latex_shows_the_force_and_every_equation():
    shown = mass._repr_latex_()
    assert shown.startswith("$")
    assert "F_e" in shown
    felt = r"K \left(x - z\right) + b \left(v - \dot{z}\right)"
    assert f"F_e = {felt} " in shown and rf"m \ddot{{z}} = {felt}" in shown


def test_printing_names_force_equations_and_parameters():
    shown = str(mass(m=0.1))
    assert "F = K*(x(t) - z(t))" in shown.replace("-z(t) + x(t)", "x(t) - z(t)")
    assert "m = 0.1 kg" in shown
    assert "K = ? N/m" in shown


def cases():
    g = sp.Function("g")
    u = hl.signal("u", unit="m")
    return [
        (lambda: hl.Scene(force=sp.Symbol("c") * x(n)), ParameterError, "c is a plain SymPy symbol.*hl.parameters"),
        (lambda: hl.Scene(force=K * g(t)), SceneError, "unknown function g"),
        (lambda: hl.Scene(force=F_c, eom=[F_c]), SceneError, "needs equations"),
        (lambda: hl.Scene(force=F_c, watch="q"), SceneError, "no such coordinate; there are z"),
        (lambda: hl.Scene(force=K * u(t)), SignalError, "discrete-time signal"),
        (lambda: hl.Scene(force=F_c).explicit(), MassError, "no equation determines z"),
        (
            lambda: hl.Scene(force=F_c, eom=[mass.eom[0], sp.Eq(b * z.diff(t), K * z)]).explicit(),
            MassError,
            "2 equations of motion for 1 coordinates",
        ),
        (
            lambda: hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2) ** 2, F_c**2 / m)]).explicit(),
            SceneError,
            "must enter linearly",
        ),
        (
            lambda: hl.Scene(force=F_c, eom=[sp.Eq(m * hl.T * z.diff(t, 3), F_c)]).explicit(),
            MassError,
            "derivative 3",
        ),
        (
            lambda: hl.compile(
                hl.Scene(force=F_c, eom=[sp.Eq(m * (z + y).diff(t, 2), F_c), sp.Eq(2 * m * (z + y).diff(t, 2), F_c)]),
                T=1e-3,
            ),
            MassError,
            "singular mass: .* y and z",
        ),
        (
            lambda: hl.Scene(
                force=F_c,
                eom=[sp.Eq(m * z.diff(t, 2) + K * y.diff(t) * 0, F_c), sp.Eq(m * z.diff(t, 2), K * y)],
            ).explicit(),
            MassError,
            "no equation determines y",
        ),
    ]


@pytest.mark.parametrize(("make", "error", "words"), cases())
def test_what_cannot_be_felt_is_refused_in_words(make, error, words):
    with pytest.raises(error, match=words) as refusal:
        make()
    assert isinstance(refusal.value, HapticlabError)


def test_the_explicit_form_agrees_with_sympy_solving_the_accelerations():
    """A second derivation: SymPy's linear solve of the same equations, at a random configuration."""
    equations = [
        sp.Eq(3 * m * z.diff(t, 2) + m * sp.cos(y / x_o) * y.diff(t, 2), F_c),
        sp.Eq(m * sp.cos(y / x_o) * z.diff(t, 2) + 2 * m * y.diff(t, 2), -K * y - b * y.diff(t)),
    ]
    form = hl.Scene(force=F_c, eom=equations).explicit()
    solved = sp.solve(equations, list(form.unknowns), dict=True)[0]
    generator = np.random.default_rng(5)
    derivatives = [q.diff(t) for q in (z, y)]
    leaves = [*derivatives, x(t), v(t), z, y, K, b, m, x_o]
    at = [(leaf, sp.Float(generator.uniform(0.5, 2), 30)) for leaf in leaves]
    M = sp.Matrix(form.M).subs(at).evalf(30)
    f = sp.Matrix(form.f).subs(at).evalf(30)
    expected = sp.Matrix([solved[a] for a in form.unknowns]).subs(at).evalf(30)
    assert max(abs(e) for e in M.LUsolve(f) - expected) < sp.Float(1e-25)


def test_equations_in_any_order_find_their_own_coordinate():
    swapped = hl.Scene(
        force=F_c,
        eom=[sp.Eq(m * z.diff(t, 2), F_c), sp.Eq(m * y.diff(t, 2), -K * y)][::-1],
    ).explicit()
    assert swapped.coordinates == (y, z)
    assert all(swapped.M[i][i] == m for i in range(2))
    assert swapped.M[0][1] == swapped.M[1][0] == 0


def test_an_angle_that_is_watched_keeps_its_unit():
    swing = hl.library.pendulum_on_the_handle()
    theta = next(q for q in swing.coordinates if q.name == "theta")
    watched = hl.Scene(force=swing.force, eom=swing.eom, watch={"a": theta, "w": theta.diff(t), "twice": 2 * theta})
    assert watched.watch_units == {"a": "rad", "w": "rad/s", "twice": "1"}
