"""What symbols of SymPy become: names, units, values, starts, inputs, and what is refused."""

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import KanesMethod, LagrangesMethod, Particle, Point, ReferenceFrame, dynamicsymbols
from sympy.physics.mechanics.models import n_link_pendulum_on_cart

import hapticlab as hl
from hapticlab import t, v, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import MassError, ParameterError, SceneError, UnitsError
from hapticlab.scene.notation.derivative import Rate

m, k, g = sp.symbols("m k g")
q, F = dynamicsymbols("q F")


def sprung(force=0, m=m, k=k, q=q):
    N, P = ReferenceFrame("N"), Point("P")
    P.set_vel(N, q.diff(t) * N.x)
    loads = [(P, force * N.x)] if force != 0 else None
    return LagrangesMethod(m * q.diff(t) ** 2 / 2 - k * q**2 / 2, [q], forcelist=loads, frame=N)


def by_kane(force=0, q=q, u=None, kd=None):
    u = u or dynamicsymbols("u")
    N, P = ReferenceFrame("N"), Point("P")
    P.set_vel(N, u * N.x)
    kane = KanesMethod(N, [q], [u], kd_eqs=[kd or q.diff(t) - u])
    kane.kanes_equations([Particle("a", P, m)], [(P, (force - k * q) * N.x)])
    return kane


def test_names_that_a_scene_has_itself_are_changed_and_said():
    clash = dynamicsymbols("x")
    mech = hl.mechanics.from_mechanics(sprung(m=sp.Symbol("T"), k=sp.Symbol("F"), q=clash))
    assert [type(e).__name__ for e in mech.coordinates] == ["x_1"]
    assert mech[clash] == mech["x_1"]
    assert mech[sp.Symbol("T")].name == "T_1"
    assert set(mech.notes) == {
        "x(t) of the model is called x_1 here", "T of the model is called T_1 here", "F of the model is called F_1 here"
    }  # fmt: skip
    program = hl.compile(hl.Scene(force=0, eom=[mech], watch=["x_1"], values={"T_1": 1, "F_1": 2}), T=1e-3)
    assert set(mech.notes) <= set(program.notes)


@pytest.mark.parametrize(
    ("given", "made"), [(r"\omega_0", "omega_0"), ("q_{1}", "q_1"), ("lambda", "lambda_1"), ("2l", "q2l"), ("k'", "k")]
)
def test_names_that_are_no_words_are_made_words(given, made):
    symbol = sp.Symbol(given)
    assert hl.mechanics.from_mechanics(sprung(k=symbol))[symbol].name == made


def test_a_constant_and_a_coordinate_of_one_name():
    mech = hl.mechanics.from_mechanics(sprung(m=sp.Symbol("q")))
    assert {type(mech[q]).__name__, mech[sp.Symbol("q")].name} == {"q", "q_1"}


def test_a_name_of_two_symbols_is_no_key():
    with pytest.raises(SceneError, match="values has 'm', the name of two symbols of the model. Give the symbol itself"):
        hl.mechanics.from_mechanics(sprung(k=sp.Symbol("m", positive=True)), values={"m": 1})
    mech = hl.mechanics.from_mechanics(sprung(k=sp.Symbol("m", positive=True)), values={m: 1, sp.Symbol("m", positive=True): 2})
    assert {p.name: p.value for p in (mech[m], mech[sp.Symbol("m", positive=True)])} == {"m": 1.0, "m_1": 2.0}


def test_units_values_and_starts_by_symbol_or_name():
    mech = hl.mechanics.from_mechanics(
        sprung(), units={q: "m", "m": "kg", k: "N/m"}, values={"m": "100 g", k: 40}, initial={"q": "5 mm", q.diff(t): 0.2}
    )
    assert (mech[m].unit, mech[m].value, mech[k].value) == ("kg", 0.1, 40.0)
    assert float(type(mech[q]).initial.value) == 0.005
    assert float(type(mech[q]).rate.value) == 0.2
    hl.compile(hl.Scene(force=0, eom=[mech], watch=[mech.energy]), T=1e-3)


def test_units_that_are_all_given_are_checked():
    with pytest.raises(UnitsError, match="L: "):
        hl.mechanics.from_mechanics(sprung(), units={"q": "m", "m": "kg", "k": "N"})
    with pytest.raises(UnitsError, match="equation of q: "):
        hl.mechanics.from_mechanics(by_kane(), units={"q": "m", "m": "kg", "k": "N"})
    hl.mechanics.from_mechanics(by_kane(), units={"q": "m", "m": "kg", "k": "N/m"})


def test_a_start_may_be_of_constants_and_parameters():
    a = hl.parameters("a", units="1", values=0.3)
    mech = hl.mechanics.from_mechanics(sprung(), values={m: 1, k: 2}, initial={q: m + a})
    program = hl.compile(hl.Scene(force=0, eom=[mech], watch=["q"]), T=1e-3, dtype="float64")
    assert load(program).run(1, np.zeros((1, len(program.inputs)))).outputs[0, 1, 0] == pytest.approx(1.3, rel=1e-15)


@pytest.mark.parametrize("method", [sprung, by_kane])
def test_an_input_that_nobody_gave_is_refused(method):
    with pytest.raises(SceneError, match=r"F\(t\): neither a coordinate nor a speed, so an input .* replace=\{F\(t\): ...\}"):
        hl.mechanics.from_mechanics(method(F))


@pytest.mark.parametrize("method", [sprung, by_kane])
def test_a_coupler_as_an_input(method):
    """F = K (x - q) felt at the handle: the same motion as the equation by hand."""
    K = hl.parameters("K", units="N/m", values=300.0)
    mech = hl.mechanics.from_mechanics(
        method(F), replace={F: K * (x(t) - q)}, units={q: "m", m: "kg", k: "N/m"}, values={m: 0.1, k: 40.0}
    )
    z, M, c = hl.coordinate("z", unit="m"), *hl.parameters("M c", units="kg N/m", values=(0.1, 40.0))
    by_hand = sp.Eq(M * z.diff(t, 2), K * (x(t) - z) - c * z)
    lead = 0.01 * np.sin(np.arange(50) / 9)[:, None]
    felt = [
        load(hl.compile(hl.Scene(force=K * (x(t) - p), eom=[e]), T=1e-3, dtype="float64")).run(50, lead).outputs[:, 0]
        for p, e in ((mech[q], mech), (z, by_hand))
    ]
    np.testing.assert_allclose(felt[0], felt[1], rtol=1e-12, atol=1e-15)


def test_a_coordinate_that_is_the_handle():
    """The cart of a pendulum in the hand: Kane's equations less those of the cart, and Lagrange's of the pendulum."""
    kane = n_link_pendulum_on_cart(1)
    values = {"m1": 0.2, "l0": 0.3, "g": 9.81}
    mech = hl.mechanics.from_mechanics(kane, replace={"q0": x(t), "F": 0, "m0": 1}, values=values, initial={"q1": 0.5})
    assert [str(p) for p in mech.coordinates] == ["q1(t)"]
    phi, (mass, l, grav) = hl.coordinate("phi", unit="rad", initial=0.5), hl.parameters("w l a", units="kg m m/s^2")
    vx, vy = v(t) - l * sp.cos(phi) * phi.diff(t), -l * sp.sin(phi) * phi.diff(t)
    L = mass * (vx**2 + vy**2) / 2 - mass * grav * l * sp.cos(phi)
    lead = 0.01 * np.sin(np.arange(60) / 9)[:, None]
    runs = []
    for model, name, bound in ((mech, "q1", {}), (hl.mechanics.lagrange(L), "phi", {"w": 0.2, "l": 0.3, "a": 9.81})):
        scene = hl.Scene(force=0, eom=[model], watch=[name], values=bound)
        runs.append(load(hl.compile(scene, T=1e-3, dtype="float64")).run(60, lead).outputs[:, 1])
    np.testing.assert_allclose(runs[0], runs[1], rtol=1e-11)
    assert np.ptp(runs[0]) > 0.02


def test_a_coordinate_of_ones_own():
    z = hl.coordinate("z", unit="m", initial=hl.x(hl.n), range=(-0.1, 0.1))
    M = hl.parameters("M", units="kg", values=0.5)
    mech = hl.mechanics.from_mechanics(by_kane(), replace={q: z, m: M}, values={k: 3})
    assert mech.coordinates == (z,)
    assert mech[dynamicsymbols("u")] == z.diff(t)
    assert mech.M == ((M,),)


def test_words_of_a_scene_in_a_model_stay_what_they_are():
    z, (M, K) = hl.coordinate("z", unit="m"), hl.parameters("k K", units="kg N/m")
    mech = hl.mechanics.from_mechanics(sprung(K * (x(t) - z), m=M, q=z), values={k: 3}, units={k: "N/m"})
    assert mech.coordinates == (z,)
    assert mech[k].name == "k_1"  # the model's k; a parameter of that name was there
    assert mech.forces[0][1].doit() == K * (x(t) - z)
    with pytest.raises(UnitsError, match="force on z"):
        hl.mechanics.from_mechanics(sprung(M * z, m=M, q=z), units={k: "N/m"})


def test_speeds_that_are_no_rates_are_states_of_their_own():
    u = dynamicsymbols("u")
    mech = hl.mechanics.from_mechanics(by_kane(u=u, kd=q.diff(t) - 2 * u), values={m: 0.5, k: 8.0}, initial={q: 1.0, u: 0.25})
    assert mech.orders == (1, 1)
    program = hl.compile(hl.Scene(force=0, eom=[mech], watch=["q", "u"]), "exact", T=0.1, dtype="float64", live=())
    got = load(program).run(20, np.zeros((20, len(program.inputs)))).outputs[:, 1:, 0]
    at, w = 0.1 * np.arange(20), np.sqrt(32.0)  # q'' = 2 u' = -2 (k/m) q
    np.testing.assert_allclose(got[:, 0], np.cos(w * at) + 0.5 / w * np.sin(w * at), atol=1e-12)
    with pytest.raises(SceneError, match=r"q\(t\) is replaced, which needs speeds that are rates"):
        hl.mechanics.from_mechanics(by_kane(u=u, kd=q.diff(t) - 2 * u), replace={q: x(t)})


def test_driven_motions_are_differentiated():
    s = dynamicsymbols("s")
    L = m * (q.diff(t) + s.diff(t)) ** 2 / 2 - k * q**2 / 2
    f = hl.parameters("f", units="1/s", values=2.0)
    mech = hl.mechanics.from_mechanics(LagrangesMethod(L, [q]), replace={s: sp.sin(2 * sp.pi * f * t)})
    assert mech.lagrangian.has(Rate)
    assert mech.equations[0].rhs.has(sp.sin)
    with pytest.raises(SceneError, match="needs an acceleration of"):
        hl.mechanics.from_mechanics(LagrangesMethod(L, [q]), replace={s: q.diff(t)})


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"units": {"w": "m"}}, r"units has w, which is not in these equations. They contain q, k, m"),
        ({"values": {q: 1}}, r"values has q\(t\), which moves. Give its start in initial=\{q\(t\):"),
        ({"values": {m: 1}, "replace": {m: 2}}, r"m is replaced by 2, which has a unit and a value of its own."),
        ({"replace": {k: 3 * q}}, r"k is a constant where the equations were formed, and 3\*q\(t\) changes"),
        ({"replace": {k: v(t)}}, r"k is a constant where the equations were formed"),
        ({"initial": {m: 1}}, r"initial has m, which does not move"),
        ({"initial": {q: 1}, "replace": {q: x(t)}}, r"q\(t\) is replaced by x\(t\); declare its start there"),
        ({"replace": {q: "z"}}, r"replace\[q\(t\)\] = 'z'; needs a number, or an expression"),
    ],
)
def test_what_is_refused(given, words):
    with pytest.raises(SceneError, match=words):
        hl.mechanics.from_mechanics(sprung(), **given)


def test_speeds_follow_coordinates():
    with pytest.raises(SceneError, match=r"replace has u\(t\), the rate of q\(t\). Replace q\(t\) instead"):
        hl.mechanics.from_mechanics(by_kane(), replace={"u": x(t)})
    with pytest.raises(SceneError, match=r"initial has both Derivative\(q\(t\), t\) and u\(t\), which are one"):
        hl.mechanics.from_mechanics(by_kane(), initial={"u": 1, q.diff(t): 1})


def test_another_time_is_refused():
    with pytest.raises(SceneError, match="t is not the time of SymPy's dynamicsymbols."):
        hl.mechanics.from_mechanics(sprung(m=sp.Symbol("t", positive=True)))
    with pytest.raises(SceneError, match=r"h\(q\(t\)\) is not a function of time alone"):
        hl.mechanics.from_mechanics(sprung(m=sp.Function("h")(q)))


def test_a_coordinate_of_nothing():
    y = dynamicsymbols("y")
    with pytest.raises(MassError, match=r"no energy, load or constraint contains y\(t\),"):
        hl.mechanics.from_mechanics(LagrangesMethod(m * q.diff(t) ** 2, [q, y]))


def test_loads_without_a_frame():
    method = sprung(F)
    method.inertial = None
    with pytest.raises(SceneError, match="loads but no frame"):
        hl.mechanics.from_mechanics(method, replace={F: 0})


def test_kane_before_its_equations():
    N, u = ReferenceFrame("N"), dynamicsymbols("u")
    with pytest.raises(SceneError, match=r"has formed no equations; call kanes_equations\(bodies, loads\) first"):
        hl.mechanics.from_mechanics(KanesMethod(N, [q], [u], kd_eqs=[q.diff(t) - u]))


@pytest.mark.parametrize(("method", "name"), [(sprung, "_L"), (by_kane, "_k_nh")])
def test_another_sympy_is_refused(method, name):
    model = method()
    delattr(model, name)
    with pytest.raises(SceneError, match=f"SymPy .* stores no {name} in a .*; install sympy 1.14"):
        hl.mechanics.from_mechanics(model)


def test_masses_are_masses():
    with pytest.raises(ParameterError, match="m = -1 kg; a mass needs m > 0"):
        hl.mechanics.from_mechanics(sprung(), units={m: "kg"}, values={m: -1})


def test_a_model_of_kane_is_shown_as_equations():
    mech = hl.mechanics.from_mechanics(by_kane())
    (equation,) = mech.equations
    mass, stiffness, z = mech[m], mech[k], mech[q]
    assert equation == sp.Eq(mass * z.diff(t, 2), -stiffness * z)
    assert r"m \ddot{q} = - k q" in mech._repr_latex_()
    assert str(mech) == "M a = f of 1 coordinates"
