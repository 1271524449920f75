"""Published examples of Lagrange's method, taken as they are, against SymPy's own matrices or a closed form."""

import numpy as np
import sympy as sp
from independent import check, motion, run
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk
from sympy.physics.mechanics import LagrangesMethod, Particle, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia
from sympy.physics.mechanics import Lagrangian as lagrangian

import hapticlab as hl

t = dynamicsymbols._t


def taken(method, values, starts, **given):
    states = [*method.q, *(p.diff(t) for p in method.q)]
    return hl.mechanics.from_mechanics(method, values=values, initial=dict(zip(states, starts, strict=True)), **given)


def compare(method, values, starts, T, duration, error, inputs=None, **given):
    """Check a model against its own SymPy equations, formed only after hapticlab has taken it."""
    mech = taken(method, values, starts, replace=inputs, **given)
    assert method.eom is None
    method.form_lagranges_equations()
    every, n = values | (inputs or {}), 2 * len(method.q)
    watch = {f"s{k}": e for k, e in enumerate([*(mech[p] for p in method.q), *(mech[p].diff(t) for p in method.q)])}
    check(mech, watch, lambda at: motion(method, every, starts, at)[:, :n], T, duration, error)
    return mech


def double_pendulum():
    """The double pendulum of SymPy's test_lagrange.test_dub_pen: angles from the vertical, two particles."""
    q, (l1, l2, m1, m2, g) = dynamicsymbols("q1 q2"), sp.symbols("l1 l2 m1 m2 g")
    N = ReferenceFrame("N")
    A, B = (N.orientnew(name, "Axis", [angle, N.z]) for name, angle in zip("AB", q, strict=True))
    O = Point("O")
    O.set_vel(N, 0)
    P, R = O.locatenew("P", l1 * A.x), Point("R")
    R.set_pos(P, l2 * B.x)
    P.v2pt_theory(O, N, A)
    R.v2pt_theory(P, N, B)
    particles = [Particle("ParP", P, m1), Particle("ParR", R, m2)]
    particles[0].potential_energy = -m1 * g * l1 * sp.cos(q[0])
    particles[1].potential_energy = -m2 * g * (l1 * sp.cos(q[0]) + l2 * sp.cos(q[1]))
    method = LagrangesMethod(lagrangian(N, *particles), q, bodies=particles, frame=N)
    return method, {l1: 0.3, l2: 0.2, m1: 0.25, m2: 0.15, g: 9.81}


def test_double_pendulum_gives_the_same_by_lagrange():
    method, values = double_pendulum()
    compare(method, values, [0.7, -0.4, 0.3, 2.0], 0.005, 0.1, 3e-7)


def test_mass_spring_damper_with_loads():
    """The example of SymPy's LagrangesMethod: a mass on a spring, its damper a load; in closed form."""
    z, (m, k, b) = dynamicsymbols("z"), sp.symbols("m k b")
    N, P = ReferenceFrame("N"), Point("P")
    P.set_vel(N, z.diff() * N.x)
    body = Particle("Pa", P, m)
    body.potential_energy = k * z**2 / 2
    method = LagrangesMethod(lagrangian(N, body), [z], forcelist=[(P, -b * z.diff() * N.x)], frame=N)
    units = {z: "m", m: "kg", k: "N/m", b: "N*s/m"}
    mech = taken(method, {m: 0.5, k: 80.0, b: 1.2}, ["20 mm", 0.1], units=units)
    rate, omega = 1.2, np.sqrt(80.0 / 0.5 - 1.2**2)

    def closed(at):
        turned = 0.02 * np.cos(omega * at) + (0.1 + rate * 0.02) / omega * np.sin(omega * at)
        return (np.exp(-rate * at) * turned)[:, None]

    check(mech, {"z": mech[z]}, closed, 0.01, 0.3, 1e-7)
    assert np.abs(run(mech, {"z": mech[z]}, 0.05, 1.0, "taylor") - closed(0.05 * np.arange(21))).max() < 1e-13


def nonminimal_pendulum():
    """SymPy's documentation, Linearization: a pendulum in x and y, a rod as a constraint with its multiplier."""
    q, (L, m, g) = dynamicsymbols("q1:3"), sp.symbols("L m g")
    N, pN, P = ReferenceFrame("N"), Point("N*"), Point("P1")
    pN.set_vel(N, 0)
    P.set_pos(pN, q[0] * N.x + q[1] * N.y)
    P.set_vel(N, P.pos_from(pN).dt(N))
    body = Particle("pP", P, m)
    rod = sp.Matrix([q[0] ** 2 + q[1] ** 2 - L**2])
    method = LagrangesMethod(lagrangian(N, body), q, hol_coneqs=rod, forcelist=[(P, m * g * N.x)], frame=N)
    return method, {L: 0.3, m: 0.2, g: 9.81}


def test_pendulum_in_two_coordinates():
    method, values = nonminimal_pendulum()
    angle, l, g = 0.8, 0.3, 9.81
    k, omega = np.sin(angle / 2), np.sqrt(g / l)
    mech = taken(method, values, [l * np.cos(angle), l * np.sin(angle), 0.0, 0.0])
    assert method.eom is None

    def closed(at):
        swung = 2 * np.arcsin(k * ellipj(ellipk(k**2) - omega * at, k**2)[0])
        return l * np.column_stack([np.cos(swung), np.sin(swung)])

    watch = {"down": mech["q1"], "aside": mech["q2"], "rod": mech.constraints[0]}
    assert np.abs(check(mech, watch, closed, 0.02, 0.4, 1e-6)).max() < 1e-13


def test_disc_that_rolls_down_a_slope():
    """SymPy's test_lagrange.test_disc_on_an_incline_plane: rolling as a constraint; a = 2/3 g sin(alpha)."""
    y, theta = dynamicsymbols("y theta")
    m, g, R, l, alpha = sp.symbols("m g R l alpha")
    N = ReferenceFrame("N")
    A = N.orientnew("A", "Axis", [sp.pi / 2 - alpha, N.z])
    B = A.orientnew("B", "Axis", [-theta, A.z])
    Do = Point("Do")
    Do.set_vel(N, y.diff(t) * A.x)
    I = m * R**2 / 2 * (B.z | B.z)
    D = RigidBody("D", Do, B, m, (I, Do))
    D.potential_energy = m * g * (l - y) * sp.sin(alpha)
    method = LagrangesMethod(lagrangian(N, D), [y, theta], hol_coneqs=[y - R * theta])
    mech = taken(method, {m: 0.3, g: 9.81, R: 0.05, l: 1.0, alpha: 0.4}, [0.0, 0.0, 0.0, 0.0])
    got = run(mech, {"y": mech[y], "turned": mech[theta]}, 0.01, 0.3)
    at = 0.01 * np.arange(31)
    assert np.abs(got - (9.81 * np.sin(0.4) / 3 * at**2)[:, None] * [1, 1 / 0.05]).max() < 1e-13


def test_disc_that_rolls_upright():
    """SymPy's test_lagrange.test_rolling_disc: three angles, no constraint left."""
    q, (r, m, g) = dynamicsymbols("q1:4"), sp.symbols("r m g")
    N = ReferenceFrame("N")
    Y = N.orientnew("Y", "Axis", [q[0], N.z])
    L = Y.orientnew("L", "Axis", [q[1], Y.x])
    R = L.orientnew("R", "Axis", [q[2], L.y])
    C = Point("C")
    C.set_vel(N, 0)
    centre = C.locatenew("Dmc", r * L.z)
    centre.v2pt_theory(C, N, R)
    body = RigidBody("D", centre, R, m, (inertia(L, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2), centre))
    body.potential_energy = m * g * r * sp.cos(q[1])
    method = LagrangesMethod(lagrangian(N, body), q)
    compare(method, {r: 0.1, m: 0.4, g: 9.81}, [0.2, 0.3, 0.1, -0.5, 0.4, 12.0], 0.005, 0.05, 1e-6)


def test_chaplygin_sleigh():
    """A knife edge (Neimark and Fufaev 1972; Bloch 2003, sec. 1.7): forward speed and turning keep v^2 + k^2 w^2 = const."""
    (x, y, theta), (m, I, a) = dynamicsymbols("x y theta"), sp.symbols("m I a")
    gx, gy = x + a * sp.cos(theta), y + a * sp.sin(theta)  # the mass centre, a ahead of the edge
    L = m * (gx.diff(t) ** 2 + gy.diff(t) ** 2) / 2 + I * theta.diff(t) ** 2 / 2
    edge = [x.diff(t) * sp.sin(theta) - y.diff(t) * sp.cos(theta)]
    method = LagrangesMethod(L, [x, y, theta], nonhol_coneqs=edge)
    starts = [0.0, 0.0, 0.3, 0.5 * np.cos(0.3), 0.5 * np.sin(0.3), 4.0]
    mech = taken(method, {m: 0.5, I: 2e-3, a: 0.08}, starts)
    assert [str(q) for q in mech.coordinates] == ["x_1(t)", "y(t)", "theta(t)"]
    assert mech.notes == ("x(t) of the model is called x_1 here",)
    M = 2e-3 + 0.5 * 0.08**2

    def rate(_, s):  # the reduced equations: v' = a w^2, (I + m a^2) w' = -m a v w
        return [s[2] * np.cos(s[4]), s[2] * np.sin(s[4]), 0.08 * s[3] ** 2, -0.5 * 0.08 * s[2] * s[3] / M, s[3]]

    def reduced(at):
        done = solve_ivp(rate, (0, at[-1]), [0, 0, 0.5, 4.0, 0.3], "DOP853", at, rtol=1e-12, atol=1e-14)
        return done.y[[0, 1, 4]].T

    check(mech, {"px": mech[x], "py": mech[y], "turned": mech[theta]}, reduced, 0.02, 0.4, 1e-6)


def test_pendulum_whose_support_is_shaken():
    """Kapitza's pendulum: the support's motion is an input, and its rate is in the Lagrangian."""
    phi, s, (m, l, g) = dynamicsymbols("phi"), dynamicsymbols("s"), sp.symbols("m l g")
    N, P = ReferenceFrame("N"), Point("P")
    P.set_vel(N, l * phi.diff(t) * sp.cos(phi) * N.x + (s.diff(t) + l * phi.diff(t) * sp.sin(phi)) * N.y)
    body = Particle("bob", P, m)
    body.potential_energy = m * g * (s - l * sp.cos(phi))
    method = LagrangesMethod(lagrangian(N, body), [phi])
    shaken = {s: 0.01 * sp.sin(2 * sp.pi * 25 * t)}
    mech = taken(method, {m: 0.1, l: 0.1, g: 9.81}, [3.0, 0.2], replace=shaken)

    def rate(at, state):
        lifted = 9.81 - 0.01 * (50 * np.pi) ** 2 * np.sin(50 * np.pi * at)
        return [state[1], -lifted / 0.1 * np.sin(state[0])]

    def reference(at):
        return solve_ivp(rate, (0, at[-1]), [3.0, 0.2], "DOP853", at, rtol=1e-12, atol=1e-14).y[:1].T

    check(mech, {"phi": mech[phi]}, reference, 0.001, 0.05, 1e-6)
