"""The bicycle of J. P. Meijaard et al., Linearized dynamics equations for the balance and steer of a bicycle: a benchmark
and review, Proc. R. Soc. A 463 (2007) 1955-1982: the published linear equations, and the bicycle itself by Kane's method.
"""

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import logm
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

import hapticlab as hl
from hapticlab.compiler.engines.engine import load

t = dynamicsymbols._t
SPEED, G = 5.0, 9.81
# eigenvalues at 5 m/s: weave, capsize, castering (table 2)
PUBLISHED = np.array(
    [-14.07838969279822, -0.77534188219585 - 4.46486771378823j, -0.77534188219585 + 4.46486771378823j, -0.32286642900409]
)
M = np.array([[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]])
C1 = np.array([[0.0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]])
K0 = np.array([[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]])
K2 = np.array([[0.0, 76.59734589573222], [0.0, 2.65431523794604]])


def in_order(values):
    return np.array(sorted(values, key=lambda e: (round(e.real, 6), e.imag)))


def test_published_linear_equations():
    """Lean and steer; what is no energy acts as a torque on a frame."""
    q = sp.Matrix(dynamicsymbols("lean steer"))
    v = sp.Symbol("v")
    N = ReferenceFrame("N")
    frames = [N.orientnew(name, "Axis", [angle, N.x]) for name, angle in zip("AB", q, strict=True)]
    torque = -(v * C1 * q.diff(t) + v**2 * K2 * q)
    L = (q.diff(t).T * M * q.diff(t) - q.T * (G * K0) * q)[0] / 2
    loads = [(frame, e * N.x) for frame, e in zip(frames, torque, strict=True)]
    starts = hl.parameters("a b c d", units="rad rad 1/s 1/s", values=(0, 0, 0, 0))
    initial = dict(zip([*q, *q.diff(t)], starts, strict=True))
    mech = hl.mechanics.from_mechanics(LagrangesMethod(L, q, forcelist=loads, frame=N), values={"v": SPEED}, initial=initial)
    moving = [mech[p] for p in q]
    watch = {f"s{k}": e for k, e in enumerate([*moving, *(p.diff(t) for p in moving)])}
    program = hl.compile(hl.Scene(force=0, eom=[mech], watch=watch), "exact", T=0.05, dtype="float64", live=list("abcd"))
    outputs = load(program).run(2, np.zeros((2, len(program.inputs))), np.eye(4)).outputs
    found = np.log(np.linalg.eigvals(outputs[1, 1:]).astype(complex)) / 0.05
    assert np.abs(in_order(found) - PUBLISHED).max() < 1e-10


def bicycle():
    """The bicycle itself: four rigid bodies, wheels that do not slip; x ahead, z down, as in the paper."""
    psi, phi, theta, delta = q = dynamicsymbols("psi phi theta delta")
    u = dynamicsymbols("u_psi u_phi u_theta u_delta u_R u_F")
    w, c, tilt, r_R, r_F = 1.02, 0.08, np.pi / 10, 0.3, 0.35
    N, rear, front = (ReferenceFrame(name) for name in ("N", "rear", "front"))
    Y = N.orientnew("Y", "Axis", [psi, N.z])
    L = Y.orientnew("L", "Axis", [phi, Y.x])
    B = L.orientnew("B", "Axis", [theta, L.y])
    axis = sp.sin(tilt) * B.x + sp.cos(tilt) * B.z
    H = B.orientnew("H", "Axis", [delta, axis])
    Y.set_ang_vel(N, u[0] * N.z)
    L.set_ang_vel(Y, u[1] * Y.x)
    B.set_ang_vel(L, u[2] * L.y)
    H.set_ang_vel(B, u[3] * axis)
    rear.set_ang_vel(B, u[4] * B.y)
    front.set_ang_vel(H, u[5] * H.y)
    ground = Point("ground")
    ground.set_vel(N, 0)
    hub = ground.locatenew("hub", -r_R * L.z)
    hub.v2pt_theory(ground, N, rear)
    frame = hub.locatenew("frame", 0.3 * B.x + (r_R - 0.9) * B.z)
    steer = hub.locatenew("steer", (w + c) * B.x + r_R * B.z)
    fork = steer.locatenew("fork", (0.9 - w - c) * H.x - 0.7 * H.z)
    wheel = steer.locatenew("wheel", -c * H.x - r_F * H.z)
    down = Y.z - Y.z.dot(H.y) * H.y
    touch = wheel.locatenew("touch", r_F * down / sp.sqrt(1 - Y.z.dot(H.y) ** 2))
    for point, base, body in ((frame, hub, B), (steer, hub, B), (fork, steer, H), (wheel, steer, H), (touch, wheel, front)):
        point.v2pt_theory(base, N, body)
    bodies = [
        RigidBody("R", hub, rear, 2.0, (inertia(B, 0.0603, 0.12, 0.0603), hub)),
        RigidBody("B", frame, B, 85.0, (inertia(B, 9.2, 11.0, 2.8, 0, 0, 2.4), frame)),
        RigidBody("H", fork, H, 4.0, (inertia(H, 0.05892, 0.06, 0.00708, 0, 0, -0.00756), fork)),
        RigidBody("F", wheel, front, 3.0, (inertia(H, 0.1405, 0.28, 0.1405), wheel)),
    ]
    slip = [touch.vel(N).dot(e) for e in Y]
    kane = KanesMethod(
        N, q_ind=[psi, phi, delta], q_dependent=[theta], configuration_constraints=[touch.pos_from(ground).dot(Y.z)],
        u_ind=[u[1], u[3], u[4]], u_dependent=[u[0], u[2], u[5]], velocity_constraints=slip,
        kd_eqs=[p.diff(t) - s for p, s in zip(q, u[:4], strict=True)], constraint_solver="CRAMER",
    )  # fmt: skip
    kane.kanes_equations(bodies, [(body.masscenter, body.mass * G * N.z) for body in bodies])
    return kane, q, u, slip


@pytest.mark.slow
def test_bicycle_by_kane():
    """Its motion near the upright one, from small leans, steers and rates, has the published eigenvalues."""
    kane, q, u, slip = bicycle()
    names = [f"{type(s).__name__}_0" for s in (*q, *u)]
    units = ["1"] * 4 + ["1/s"] * 6
    ahead = dict(zip(names, [0.0] * 8 + [-SPEED / 0.3, -SPEED / 0.35], strict=True))
    starts = hl.parameters(" ".join(names), units=" ".join(units), values=ahead)
    mech = hl.mechanics.from_mechanics(kane, initial=dict(zip([*q, *u], starts, strict=True)))
    assert len(mech.constraints) == 3
    states = [mech[q[1]], mech[q[3]], mech[q[1]].diff(t), mech[q[3]].diff(t)]
    watch = {f"s{k}": e for k, e in enumerate(states)} | {"height": mech.constraints[0]}
    scene = hl.Scene(force=0, eom=[mech], watch=watch)
    program = hl.compile(scene, "rk4", T=2e-3, dtype="float64", live=names)
    solved = sp.lambdify([[*q, *u]], slip)
    eps, lanes = 1e-4, []
    for k in (1, 3, 5, 7):
        for sign in (eps, -eps):
            at = np.array(list(ahead.values()))
            at[k] += sign
            for _ in range(3):  # slip is linear in the speeds that follow
                off = np.array(solved(at))
                J = np.column_stack([np.array(solved(at + np.eye(10)[j])) - off for j in (4, 6, 9)])
                at[[4, 6, 9]] -= np.linalg.solve(J, off)
            lanes.append(at)
    order = [names.index(channel.name) for channel in program.parameters]
    outputs = load(program).run(101, np.zeros((101, len(program.inputs))), np.array(lanes).T[order]).outputs
    flow = (outputs[100, 1:5, ::2] - outputs[100, 1:5, 1::2]) / (2 * eps)
    assert np.abs(in_order(np.linalg.eigvals(logm(flow) / 0.2)) - PUBLISHED).max() < 1e-4
    assert np.abs(outputs[1:, 5]).max() < 1e-12
