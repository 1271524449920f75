"""Contacts and their laws: units, refusals in the student's words, never pulling, Hunt and Crossley's restitution."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.special import lambertw

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import SceneError, SignalError, UnitsError
from hapticlab.scene.contact.contact import Contact, friction
from hapticlab.scene.contact.instant_laws import impulse, micro_impulse, rigid
from hapticlab.scene.contact.penalty_laws import hunt_crossley, penalty

Q = hl.coordinate("q", unit="m")
ANGLE = hl.coordinate("theta", unit="rad")
K, B, C, F_C, MU, KH, KR = hl.parameters("k b c F_c mu k_h k_r", units="N/m N*s/m s/m N 1 N/m^1.5 N*m/rad")
E = hl.parameters("e", units="1", values=0.8, ranges=(0, 1))
FLOOR = Contact(Q, impulse(e=0.5), name="floor")


@pytest.mark.parametrize("made, message", [
    (lambda: impulse(e=1.3), r"e = 1.3; restitution lies in 0..1: above 1 every bounce would supply energy to the user"),
    (lambda: impulse(e=-0.1), r"e = -0.1; restitution lies in 0..1: below 0 the bodies would pass"),
    (lambda: impulse(e=MU), r"e = mu, declared within -inf..inf.*hl.parameters\('mu', units='1', ranges=\(0, 1\)\)"),
    (lambda: impulse(e=E, impacts="both"), r"impacts = 'both'; needs 'sequential' .* or 'simultaneous'"),
    (lambda: impulse(e=E, rest_speed=0), r"rest_speed = 0; needs the speed below which a contact rests, > 0 m/s"),
    (lambda: impulse(e=E, mu=-0.2), r"mu = -0.2; a contact needs a friction coefficient mu >= 0: friction opposes the slip"),
    (lambda: penalty(k=-50), r"k = -50; a contact needs a stiffness k >= 0: a negative one is not passive"),
    (lambda: hunt_crossley(k=KH, c=C, exponent=0.5), r"exponent = 0.5; needs a fraction n >= 1, such as 3/2"),
    (lambda: micro_impulse(e=E, envelope="0 mm"), r"envelope = 0; needs the distance at which bodies are regarded as in contact"),
    (lambda: Contact(K * Q, rigid()), r"contact: gap: k\*q\(t\) is neither a length nor an angle; a gap is a distance in m "
                                      r"or an angle in rad"),
    (lambda: Contact(sp.Integer(1) * K / K, rigid()), r"gap = 1 contains neither a coordinate nor x\(t\), so nothing can "
                                                      r"close the gap."),
    (lambda: Contact(Q.diff(t), rigid(), "stop"), r"stop: gap = .* contains a velocity; a gap is a distance"),
    (lambda: Contact(Q, 3), r"law = 3; needs penalty, hunt_crossley, impulse, micro_impulse or rigid"),
    (lambda: Contact(-x(t), impulse(e=E), "wall"), r"wall: gap = -x\(t\) contains only the handle, whose velocity no "
                                                   r"impulse can reverse.* hl.laws.proxy_wall"),
    (lambda: Contact(Q, impulse(e=E, mu=MU)), r"friction mu = mu needs a direction; give slip="),
    (lambda: Contact(Q, penalty(k=K), slip=v(t)), r"a penalty has no friction of its own; add hl.contact.friction\(slip=..."),
    (lambda: Contact(Q >= 0, rigid()), r"gap = q\(t\) >= 0 is a condition; a contact needs the distance itself, .*apart. "
                                       r"Write q\(t\)"),
    (lambda: Contact(Q <= 0, rigid()), r"a contact needs the distance itself, .*apart. Write -q\(t\)"),
    (lambda: penalty(k="-50 N/m"), r"k = -50; a contact needs a stiffness k >= 0"),
    (lambda: friction(slip=v(t), coulomb="2 N", breakaway="1 N"), r"breakaway = \(1 N\) < coulomb = \(2 N\); a breakaway "
                                                                  r"force is at least as"),
    (lambda: hl.Scene(FLOOR), r"force is the contact or friction floor itself; its force is floor.force"),
    (lambda: K * Q + FLOOR, r"floor is a Contact, not a force; its force is an expression, floor.force"),
    (lambda: friction(slip=v(t), coulomb=F_C) - K * Q, r"friction is a friction, not a force; .*friction.force"),
    (lambda: hl.Scene(0, [FLOOR]), r"eom contains floor, which is not an equation.*hl.mechanics.lagrange\(L, contacts=\[...\]\)"),
    (lambda: friction(slip=Q.diff(t) ** 2, coulomb=F_C), r"slip = .* is not linear in the velocities"),
    (lambda: friction(slip=Q, coulomb=F_C), r"slip = q\(t\) contains no velocity; needs a relative velocity such as "
                                            r"q.diff\(t\) - v\(t\)"),
    (lambda: friction(slip=v(t), coulomb=F_C, breakaway=F_C, stick_speed=1), r"stick_speed replaces sticking.*only one of "
                                                                             r"the two"),
])  # fmt: skip
def test_what_cannot_be_a_contact_is_refused_in_words(made, message):
    with pytest.raises(SceneError, match=message):
        made()


@pytest.mark.parametrize("made, message", [
    (lambda: Contact(Q, penalty(k=B)), r"contact, k: b is in N\*s/m but .* in N/m"),
    (lambda: Contact(Q, penalty(k=50)), r"k = 50 has no unit; needs N/m: '50 N/m', or hl.parameters\('k', units='N/m', v"),
    (lambda: Contact(Q, penalty(k="50 N")), r"contact, k: \(50 N\) is in N but"),
    (lambda: Contact(Q, penalty(k="hard")), r"k = 'hard'; needs a number and its unit"),
    (lambda: Contact(Q, hunt_crossley(k=1e5, c=0)), r"needs N/m\^1.5: '100000 N/m\^1.5'"),
    (lambda: friction(slip=Q.diff(hl.t), coulomb=1), r"coulomb = 1 has no unit; needs N: '1 N'"),
    (lambda: Contact(ANGLE, penalty(k=K)), r"k: k is in N/m but .* in N\*m/rad"),
    (lambda: Contact(Q, hunt_crossley(k=KH, c=C, exponent=2)), r"k gap\^2"),
    (lambda: Contact(Q, hunt_crossley(k=KH, c=B)), r"1/c"),
    (lambda: Contact(Q, impulse(e=E, rest_speed=K)), r"rest_speed"),
    (lambda: friction(slip=v(t), coulomb=K), r"friction, coulomb: k is in N/m"),
])  # fmt: skip
def test_units_are_checked_against_the_gap(made, message):
    with pytest.raises(UnitsError, match=message):
        made()


def test_a_sample_is_no_gap():
    with pytest.raises(
        SignalError, match=r"gap contains the sample x\(n\), but a contact also acts between samples. Write x\(t\)"
    ):
        Contact(Q - x(n), rigid())


def test_what_fits_is_taken():
    assert Contact(ANGLE - sp.pi / 3, penalty(k=KR)).unit == "N*m"
    assert Contact(Q - x(t), impulse(e=E, rest_speed="5 mm/s")).contact_law.rest_speed.value == 0.005
    stop = Contact(Q, impulse(e=0.5), name="stop")
    assert not stop.is_force and type(stop.force).role == "reaction" and type(stop.impulse).unit == "N*s"
    assert friction(slip=ANGLE.diff(t), coulomb=KR).unit == "N*m"
    assert hash(stop) == hash(Contact(Q, impulse(e=0.5), name="stop"))


def test_texts_with_units_are_taken_as_the_other_laws_take_them():
    """A spring pressed 2 mm into its contact, its stiffness in N/mm, pushes as the parameter of 1000 N/m does."""
    pushes = []
    for k_c in ("1 N/mm", hl.parameters("k_c", units="N/m", values=1000)):
        pad = Contact(Q, penalty(k=k_c), name="pad")
        start = hl.coordinate("q", unit="m", initial=-0.002)
        scene = hl.Scene(pad.force.xreplace({Q: start}), [sp.Eq(start.diff(t), 0)])
        pushes.append(load(hl.compile(scene, T=1e-3, dtype="float64")).run(1, np.zeros((1, 1))).outputs[0, 0, 0])
    assert pushes[0] == pushes[1] == pytest.approx(2.0, rel=1e-15)
    assert penalty(k="5 N*m/rad").k.unit == "N*m/rad" and penalty(k="0 N/m").k == 0
    stiff = hunt_crossley(k="100 N/mm^1.5", c="0.2 s/m").k
    assert float(stiff.value) == pytest.approx(100 * 1e3**1.5, rel=1e-12)
    assert Contact(Q, hunt_crossley(k=stiff, c="0.2 s/m")).contact_law.k == stiff
    assert friction(slip=v(t), coulomb="1 N", stick_speed="5 mm/s").stick_speed.value == 0.005


def test_a_contact_called_floor_does_not_print_as_the_function():
    assert str(2 * FLOOR.force) == "2*N_floor(t)" and sp.latex(FLOOR.force) == r"N_{\mathrm{floor}}"
    assert sp.latex(FLOOR.force**2) == r"N_{\mathrm{floor}}^{2}"
    assert str(friction(slip=v(t), coulomb=F_C, name="brake").force) == "F_brake(t)"
    model = hl.mechanics.lagrange(hl.parameters("m", units="kg") * Q.diff(t) ** 2, contacts=[FLOOR])
    assert list(hl.Scene(0, [model], watch=[FLOOR.force]).watch) == ["floor"]
    assert "e=0.5," in repr(FLOOR) and repr(penalty(k="2.5 N/m", b=B)) == "penalty(k=(2.5 N/m), b=b)"


LAWS = [
    (penalty(k=K, b=B), lambda d, w: max(0.0, 900.0 * d + 4.0 * w)),
    (hunt_crossley(k=KH, c=C), lambda d, w: 2e4 * d**1.5 * max(0.0, 1.0 + 0.3 * w)),
]
VALUES = {K: 900.0, B: 4.0, KH: 2e4, C: 0.3}


@pytest.mark.parametrize("law, expected", LAWS)
def test_a_force_law_pushes_inside_and_never_pulls(law, expected):
    gap, rate = sp.symbols("gap rate", real=True)
    force = sp.lambdify((gap, rate), law.force(gap, rate).xreplace(VALUES))
    for d in (0.001, 0.02):
        for w in (-30.0, -2.0, 0.0, 2.0):
            assert force(-d, -w) == pytest.approx(expected(d, w), rel=1e-14, abs=1e-15)
            assert force(-d, -w) >= 0


def bounced(cv, exponent):
    """Return e by integrating the penetration itself: m = 1, k = 1, at speed v = 1, so that c = cv."""

    def motion(_, y):
        d = max(y[0], 0.0)
        return [y[1], -(d**exponent) * max(0.0, 1.0 + cv * y[1])]

    def out(_, y):
        return y[0]

    out.terminal, out.direction = True, -1
    end = solve_ivp(motion, (0, 50), [1e-12, 1.0], method="DOP853", events=out, rtol=1e-12, atol=1e-13)
    return -end.y_events[0][0][1]


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("cv", [0.05, 0.7])
def test_hunt_crossleys_restitution_is_that_of_an_integration(cv, exponent):
    assert hunt_crossley.restitution(cv) == pytest.approx(bounced(cv, exponent), abs=2e-10)


@pytest.mark.parametrize("cv", [1e-7, 9.9e-5, 1.1e-4, 0.01, 1.0, 40.0, 1e4])
def test_hunt_crossleys_restitution_is_lamberts_function(cv):
    """(1 - y) exp(-(1 - y)) = exp(-(1 + A)), with A = c v - ln(1 + c v) and y = c e v."""
    import mpmath

    with mpmath.workdps(60):
        A = mpmath.mpf(cv) - mpmath.log1p(cv)
        expected = float((1 + mpmath.lambertw(-mpmath.exp(-(1 + A)), 0)) / cv)
    # y and 1 - y are carried as one number: where y is near 1 its last digits are those of 1
    assert hunt_crossley.restitution(cv) == pytest.approx(expected, rel=3e-11)
    if cv >= 0.01:
        assert expected == pytest.approx(float((1 + lambertw(-np.exp(-1 - float(A))).real) / cv), rel=1e-6)


def test_little_damping_gives_hunt_and_crossleys_own_relation():
    """e = 1 - alpha v with lambda = 3/2 alpha k, so alpha = 2/3 c."""
    cv = 1e-5
    assert 1 - hunt_crossley.restitution(cv) == pytest.approx(2 / 3 * cv, rel=1e-4)


def test_a_contact_is_felt_as_its_force_along_the_gap():
    k, z = hl.parameters("k", units="N/m", values=200), hl.coordinate("z", unit="m")
    lever = Contact(z - 3 * x(t), penalty(k=k), name="lever")
    force = hl.compile(hl.Scene(lever.felt.subs(z, 0).doit()), T=1e-3, dtype="float64")
    # the handle at 10 mm is 30 mm deep at the end of a lever of ratio 3: 3 * 200 N/m * 30 mm
    assert load(force).run(1, [[0.01]]).outputs[0, 0, 0] == pytest.approx(18.0, rel=1e-12)
