"""Published examples of Kane's method, taken as they are, against SymPy's own matrices integrated at 1e-12."""

import numpy as np
import pytest
import sympy as sp
from independent import check, motion, run
from sympy.physics.mechanics import KanesMethod, Particle, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia
from sympy.physics.mechanics.models import multi_mass_spring_damper, n_link_pendulum_on_cart

import hapticlab as hl

t = dynamicsymbols._t


def pendulum_on_cart(n):
    """PyDy's n-link pendulum on a cart (pydy.models, now sympy.physics.mechanics.models)."""
    kane = n_link_pendulum_on_cart(n)
    g, l, m = sp.Symbol("g"), sp.symbols(f"l:{n}"), sp.symbols(f"m:{n + 1}")
    values = {g: 9.81} | {e: 0.3 - 0.04 * k for k, e in enumerate(l)} | {e: 0.2 + 0.1 * k for k, e in enumerate(m)}
    starts = [0.05, *(0.4 + 0.3 * k for k in range(n)), 0.2, *(-1.0 + 0.7 * k for k in range(n))]
    return kane, values, starts


def taken(kane, values, starts, **given):
    states = [*kane.q, *kane.u]
    return hl.mechanics.from_mechanics(kane, values=values, initial=dict(zip(states, starts, strict=True)), **given)


def watched(mech, kane):
    return {f"s{k}": mech[s] for k, s in enumerate([*kane.q, *kane.u])}


def compare(kane, values, starts, T, duration, error, inputs=None, **given):
    mech = taken(kane, values, starts, replace=inputs, **given)
    every = values | (inputs or {})
    check(mech, watched(mech, kane), lambda at: motion(kane, every, starts, at), T, duration, error)
    return mech


def test_two_links_on_a_cart_that_is_pushed():
    kane, values, starts = pendulum_on_cart(2)
    (F,) = dynamicsymbols("F,")
    mech = compare(kane, values, starts, 0.005, 0.1, 1e-7, {F: sp.cos(7 * t) - 3 * kane.q[0]})
    assert mech.orders == (2, 2, 2)


@pytest.mark.slow
def test_five_links_on_a_cart():
    kane, values, starts = pendulum_on_cart(5)
    compare(kane, values, starts, 0.002, 0.1, 1e-6, {dynamicsymbols("F"): sp.S.Zero})


def test_chain_of_springs_and_dampers():
    """PyDy's multi_mass_spring_damper, three masses hung in gravity, one pushed."""
    kane = multi_mass_spring_damper(3, apply_gravity=True, apply_external_forces=True)
    m, k, c, f = sp.symbols("m:3"), sp.symbols("k:3"), sp.symbols("c:3"), dynamicsymbols("f:3")
    values = dict(zip([*m, *k, *c], [0.2, 0.3, 0.1, 60, 40, 50, 0.1, 0.2, 0.05], strict=True)) | {sp.Symbol("g"): 9.81}
    starts = [0.01, 0.03, -0.02, 0.1, -0.3, 0.2]
    pushes = dict(zip(f, [sp.S.Zero, 0.4 * sp.sin(11 * t), sp.S.Zero], strict=True))
    mech = compare(kane, values, starts, 0.005, 0.1, 2e-6, pushes)
    assert [str(q) for q in mech.coordinates] == ["x0(t)", "x1(t)", "x2(t)"]


def test_one_mass_in_closed_form():
    """PyDy's tutorial: mass, spring and damper; underdamped free motion."""
    kane = multi_mass_spring_damper(1)
    values = dict(zip(sp.symbols("m0 k0 c0"), [0.5, 80.0, 1.2], strict=True))
    mech = taken(kane, values, [0.02, 0.1], units={"m0": "kg", "k0": "N/m", "c0": "N*s/m", "x0": "m"})
    decay = 1.2 / (2 * 0.5)
    omega = np.sqrt(80.0 / 0.5 - decay**2)

    def closed(at):
        return (np.exp(-decay * at) * (0.02 * np.cos(omega * at) + (0.1 + decay * 0.02) / omega * np.sin(omega * at)))[:, None]

    check(mech, {"z": mech["x0"]}, closed, 0.01, 0.3, 1e-7)
    assert np.abs(run(mech, {"z": mech["x0"]}, 0.05, 1.0, "taylor") - closed(0.05 * np.arange(21))).max() < 1e-13


def double_pendulum():
    """The double pendulum of SymPy's documentation (Linearization, test_kane.test_pend): two particles on rods."""
    q, u = dynamicsymbols("q1 q2"), dynamicsymbols("u1 u2")
    l, m, g = sp.symbols("l m g")
    N = ReferenceFrame("N")
    A, B = (N.orientnew(name, "Axis", [angle, N.z]) for name, angle in zip("AB", q, strict=True))
    A.set_ang_vel(N, u[0] * N.z)
    B.set_ang_vel(N, u[1] * N.z)
    O, P, R = Point("O"), Point("P"), Point("R")
    P.set_pos(O, l * A.x)
    R.set_pos(P, l * B.x)
    O.set_vel(N, 0)
    P.v2pt_theory(O, N, A)
    R.v2pt_theory(P, N, B)
    kane = KanesMethod(N, q, u, kd_eqs=[q[0].diff() - u[0], q[1].diff() - u[1]])
    particles = [Particle("ParP", P, m), Particle("ParR", R, m)]
    kane.kanes_equations(particles, [(P, m * g * N.x), (R, m * g * N.x)])
    return kane, {l: 0.25, m: 0.3, g: 9.81}


def test_double_pendulum():
    kane, values = double_pendulum()
    compare(kane, values, [0.7, -0.4, 0.3, 2.0], 0.005, 0.1, 3e-7)


r, m, g = sp.symbols("r m g")
DISC = {r: 0.1, m: 0.4, g: 9.81}


def turned(q, u):
    """Return the frames of a disc by its heading, lean and spin, and what is zero by the speeds of its body."""
    N = ReferenceFrame("N")
    Y = N.orientnew("Y", "Axis", [q[0], N.z])
    L = Y.orientnew("L", "Axis", [q[1], Y.x])
    R = L.orientnew("R", "Axis", [q[2], L.y])
    w = R.ang_vel_in(N)
    R.set_ang_vel(N, u[0] * L.x + u[1] * L.y + u[2] * L.z)
    return N, Y, L, R, [(R.ang_vel_in(N) - w).dot(axis) for axis in L]


def rigid(centre, L, R):
    """Return the disc as a body."""
    return RigidBody("D", centre, R, m, (inertia(L, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2), centre))


def disc(auxiliary=False):
    """The rolling disc of SymPy's documentation, by Kane's method; with speeds that measure the forces of the ground."""
    q, u, extra, f = (dynamicsymbols(names) for names in ("q1:4", "u1:4", "u4:7", "f1:4"))
    N, Y, L, R, turning = turned(q, u)
    C = Point("C")
    C.set_vel(N, extra[0] * L.x + extra[1] * Y.z.cross(L.x) + extra[2] * Y.z if auxiliary else 0)
    centre = C.locatenew("Dmc", r * L.z)
    centre.v2pt_theory(C, N, R)
    kane = KanesMethod(N, q, u, kd_eqs=turning, u_auxiliary=extra if auxiliary else None)
    loads = [(centre, -m * g * Y.z)]
    loads += [(C, f[0] * L.x + f[1] * Y.z.cross(L.x) + f[2] * Y.z)] if auxiliary else []
    kane.kanes_equations([rigid(centre, L, R)], loads)
    return kane, DISC


STARTS = [0.2, 0.3, 0.1, 0.4, 12.0, -0.5]


@pytest.mark.parametrize("auxiliary", [False, True])
@pytest.mark.always("True")
def test_rolling_disc(auxiliary):
    kane, values = disc(auxiliary)
    mech = compare(kane, values, STARTS, 0.005, 0.1, 1e-6)
    assert mech.orders == (1,) * 6


def held_disc():
    """The same disc in six coordinates: it touches the ground (configuration) and does not slip (rates)."""
    q, u = dynamicsymbols("q1:7"), dynamicsymbols("u1:7")
    N, _, L, R, turning = turned(q, u)
    O, centre = Point("O"), Point("Dmc")
    centre.set_pos(O, q[3] * N.x + q[4] * N.y + q[5] * N.z)
    centre.set_vel(N, u[3] * N.x + u[4] * N.y + u[5] * N.z)
    O.set_vel(N, 0)
    C = centre.locatenew("C", -r * L.z)
    slip = C.v2pt_theory(centre, N, R)
    kane = KanesMethod(
        N, q_ind=q[:5], u_ind=u[:3], q_dependent=q[5:], u_dependent=u[3:],
        configuration_constraints=[q[5] - r * sp.cos(q[1])], velocity_constraints=[slip.dot(axis) for axis in N],
        kd_eqs=[*turning, *(u[k] - q[k].diff() for k in (3, 4, 5))],
    )  # fmt: skip
    kane.kanes_equations([rigid(centre, L, R)], [(centre, -m * g * N.z)])
    return kane, DISC, slip


@pytest.mark.wide
def test_rolling_disc_with_dependent_speeds():
    kane, values, slip = held_disc()
    q, u = list(kane.q), list(kane.u)
    at = {**dict(zip([*q[:3], *u[:3]], STARTS, strict=True)), **values}
    rolling = sp.solve([slip.dot(axis).xreplace(at) for axis in kane._inertial], u[3:])
    starts = [*STARTS[:3], 0.0, 0.0, 0.1 * np.cos(0.3), *STARTS[3:], *(float(rolling[s]) for s in u[3:])]
    mech = taken(kane, values, starts)
    assert mech.orders == (2,) * 6
    assert len(mech.constraints) == 3

    def reference(at):
        return motion(kane, values, starts, at)[:, :6]

    watch = {f"q{k}": mech[p] for k, p in enumerate(q)} | {"height": mech.constraints[0], "spin": mech[u[1]]}
    touching = check(mech, watch, reference, 0.005, 0.05, 1e-6)
    assert np.abs(touching[:, 0]).max() < 1e-14
    assert touching[0, 1] == pytest.approx(12.0, rel=1e-14)


def test_rolling_disc_and_its_path():
    """Coordinates of the path beside the angles: more coordinates than speeds."""
    q, u = dynamicsymbols("q1:6"), dynamicsymbols("u1:4")
    inner, values = disc()
    turning = inner.kindiffdict()
    spun = turning[inner.q[2].diff(t)]
    path = [q[3].diff(t) - r * spun * sp.cos(q[0]), q[4].diff(t) - r * spun * sp.sin(q[0])]
    kane = KanesMethod(
        inner._inertial, q, u, kd_eqs=[*(rate - value for rate, value in turning.items()), *path]
    )  # fmt: skip
    kane.kanes_equations(inner.bodies, inner.loads)
    compare(kane, values, [0.2, 0.3, 0.1, 0.0, 0.0, 0.4, 12.0, -0.5], 0.005, 0.05, 1e-6)


def test_what_cannot_be_projected_is_said_and_small():
    """A bob on a rod in x and y, and a counter of its x: three coordinates for two speeds, one of them dependent."""
    q, u, (l, m, g) = dynamicsymbols("q1:4"), dynamicsymbols("u1:3"), sp.symbols("l m g")
    N, P = ReferenceFrame("N"), Point("P")
    P.set_vel(N, u[0] * N.x + u[1] * N.y)
    kane = KanesMethod(
        N, [q[0], q[2]], u[:1], kd_eqs=[q[0].diff() - u[0], q[2].diff() - 2 * u[0], q[1].diff() - u[1]],
        q_dependent=[q[1]], configuration_constraints=[q[0] ** 2 + q[1] ** 2 - l**2],
        u_dependent=u[1:], velocity_constraints=[q[0] * u[0] + q[1] * u[1]],
    )  # fmt: skip
    kane.kanes_equations([Particle("bob", P, m)], [(P, -m * g * N.y)])
    starts = [0.0, 0.0, -0.3, 0.5, 0.0]
    values = {l: 0.3, m: 0.2, g: 9.81}
    mech = taken(kane, values, starts)
    assert mech.notes[-1].startswith("constraints on speeds are enforced by their rate alone")
    rod = sum(mech[p] ** 2 for p in q[:2]) - 0.09
    watch = {f"s{k}": mech[s] for k, s in enumerate([*kane.q, *kane.u])} | {"rod": rod}
    drift = check(mech, watch, lambda at: motion(kane, values, starts, at), 0.02, 0.2, 1e-5)
    assert 1e-9 < np.abs(drift).max() < 1e-6
