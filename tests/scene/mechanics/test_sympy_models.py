"""Published examples built of joints, by SymPy's System and by Kane's method."""

import numpy as np
import pytest
import sympy as sp
from independent import check, motion
from scipy.special import ellipj, ellipk
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    PinJoint,
    PrismaticJoint,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)  # fmt: skip
from sympy.physics.mechanics.system import System

import hapticlab as hl
from hapticlab.errors import SceneError

t = dynamicsymbols._t


def cart_and_pendulum(speeds):
    """The example of SymPy's System: a sliding cart and a hinged rod, in gravity, the cart pushed by F(t)."""
    g, l, mc, mp = sp.symbols("g l mc mp")
    qc, qp, F = dynamicsymbols("qc qp F")
    uc, up = dynamicsymbols("uc up") if speeds else (qc.diff(t), qp.diff(t))
    rail, cart, pole = RigidBody("rail"), RigidBody("cart", mass=mc), RigidBody("pole", mass=mp)
    pole.central_inertia = inertia(pole.frame, mp * l**2 / 12, 0, mp * l**2 / 12)
    system = System.from_newtonian(rail)
    slider = PrismaticJoint("slider", rail, cart, qc, uc, joint_axis=rail.x)
    pin = PinJoint("pin", cart, pole, qp, up, joint_axis=cart.z, child_point=l / 2 * pole.y)
    system.add_joints(slider, pin)
    system.apply_uniform_gravity(-g * rail.y)
    system.add_loads((cart.masscenter, F * rail.x))
    return system, {g: 9.81, l: 0.4, mc: 0.3, mp: 0.2}, {F: -5 * qc}


@pytest.mark.parametrize("method", [KanesMethod, LagrangesMethod])
@pytest.mark.always("KanesMethod")
def test_cart_and_pendulum(method):
    system, values, push = cart_and_pendulum(method is KanesMethod)
    if method is LagrangesMethod:
        system.form_eoms(LagrangesMethod)  # which hands the loads over, gravity among them
    starts = [0.1, 0.8, -0.2, 1.0]
    initial = dict(zip([*system.q, *(q.diff(t) for q in system.q)], starts, strict=True))
    mech = hl.mechanics.from_mechanics(system, values=values, initial=initial, replace=push)
    watch = {f"s{k}": mech[q] for k, q in enumerate(system.q)}
    check(mech, watch, lambda at: motion(system.eom_method, values | push, starts, at)[:, :2], 0.01, 0.2, 1e-6)


def test_simple_pendulum_of_a_joint():
    """A rod on one pin; its swing is an elliptic function."""
    g, l, m = sp.symbols("g l m")
    q, u = dynamicsymbols("q u")
    wall, rod = RigidBody("wall"), RigidBody("rod", mass=m)
    rod.central_inertia = inertia(rod.frame, m * l**2 / 12, 0, m * l**2 / 12)
    system = System.from_newtonian(wall)
    system.add_joints(PinJoint("pin", wall, rod, q, u, joint_axis=wall.z, child_point=l / 2 * rod.y))
    system.apply_uniform_gravity(-g * wall.y)
    units = {q: "rad", g: "m/s^2", l: "m", m: "kg"}
    mech = hl.mechanics.from_mechanics(system, units=units, values={g: 9.81, l: 0.4, m: 0.1}, initial={q: 1.0})
    k, omega = np.sin(0.5), np.sqrt(1.5 * 9.81 / 0.4)

    def closed(at):
        return 2 * np.arcsin(k * ellipj(ellipk(k**2) - omega * at, k**2)[0])[:, None]

    check(mech, {"q": mech[q]}, closed, 0.01, 0.3, 1e-6)


def four_bar():
    """The four-bar linkage of SymPy's documentation (Multi Degree of Freedom Holonomic System)."""
    q, u = dynamicsymbols("q1:4"), dynamicsymbols("u1:4")
    l, rho = sp.symbols("l1:5"), sp.symbols("rho")
    N = ReferenceFrame("N")
    links = []
    for k, length in enumerate(l, 1):
        link = RigidBody(f"link{k}", frame=N if k == 1 else None, mass=rho * length)
        link.central_inertia = inertia(link.frame, 0, 0, rho * length**3 / 12)
        links.append(link)
    for k in range(3):
        PinJoint(
            f"J{k + 1}", links[k], links[k + 1], q[k], u[k], parent_point=l[k] / 2 * links[k].x,
            child_point=-l[k + 1] / 2 * links[k + 1].x, joint_axis=links[k].z,
        )  # fmt: skip
    first, last = links[0], links[3]
    loop = last.masscenter.pos_from(first.masscenter) + l[0] / 2 * first.x + l[3] / 2 * last.x
    closing = [loop.dot(first.x), loop.dot(first.y)]
    kane = KanesMethod(
        first.frame, q_ind=[q[0]], u_ind=[u[0]], q_dependent=q[1:], u_dependent=u[1:],
        kd_eqs=[a.diff(t) - b for a, b in zip(q, u, strict=True)], configuration_constraints=closing,
        velocity_constraints=[e.diff(t) for e in closing],
        forcelist=[(links[1].masscenter, -9.81 * links[1].mass * first.y)], bodies=links,
    )  # fmt: skip
    kane.kanes_equations()
    return kane, closing, dict(zip([*l, rho], [0.3, 0.1, 0.35, 0.25, 2.0], strict=True))


@pytest.mark.wide
def test_four_bar_linkage():
    kane, closing, values = four_bar()
    q, u = list(kane.q), list(kane.u)
    gap, J = (sp.lambdify([q], m.xreplace(values)) for m in (sp.Matrix(closing), sp.Matrix(closing).jacobian(q)))
    at = np.array([0.8, 1.8, 2.0])
    for _ in range(9):
        at[1:] -= np.linalg.solve(J(at)[:, 1:], gap(at)[:, 0])
    rates = [6.0, *np.linalg.solve(J(at)[:, 1:], -6.0 * J(at)[:, 0])]
    starts = [*at, *rates]
    mech = hl.mechanics.from_mechanics(kane, values=values, initial=dict(zip([*q, *u], starts, strict=True)))
    assert len(mech.constraints) == 2  # the rates of the loop are not asked for a second time
    assert mech.constraints[0].count(sp.cos) == 3  # cos(q1 + q2) instead of products, and so a closed form
    watch = {f"q{k}": mech[p] for k, p in enumerate(q)} | {"right": mech.constraints[0], "up": mech.constraints[1]}
    residuals = check(mech, watch, lambda at: motion(kane, values, starts, at)[:, :3], 0.01, 0.2, 1e-5)
    assert np.abs(residuals).max() < 1e-13


def test_what_is_no_system_is_refused():
    with pytest.raises(SceneError, match=r"Symbol: needs a LagrangesMethod, KanesMethod or System .*hl.mechanics.lagrange"):
        hl.mechanics.from_mechanics(sp.Symbol("L"))
