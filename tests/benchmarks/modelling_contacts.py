"""A column of balls with a penalty contact below each, by hapticlab, CasADi, numba and MuJoCo.

m x_i'' = F_i - F_(i+1) - m g with F_i = k max(-gap_i, 0). MuJoCo takes the same law as springs with a dead band along
tendons; its own contacts follow another law, so their row is checked for the weight that the floor carries.
"""

from dataclasses import dataclass

import numpy as np
from modelling_peers import Made, casadi_made, declared, numba_made, scene_made

G, RADIUS, STIFFNESS = 9.81, 0.02, 1e4


@dataclass(frozen=True)
class Column:
    """Balls above each other on a floor, as many contacts as balls."""

    contacts: int
    h: float = 1e-4

    def numbers(self):
        """Return masses [kg], heights of the centres [m] and velocities [m/s]: some touch, some do not."""
        random = np.random.default_rng(self.contacts)
        heights = RADIUS * (2 * np.arange(self.contacts) + 1) + np.cumsum(random.uniform(-0.9e-3, 2e-3, self.contacts))
        return random.uniform(0.05, 0.15, self.contacts), heights, random.uniform(-0.2, 0.2, self.contacts)

    @property
    def parameters(self):
        return np.array([*self.numbers()[0], STIFFNESS, RADIUS, G])

    def gaps(self, x, radius):
        """Return the gap below each ball."""
        return [x[0] - radius, *(b - a - 2 * radius for a, b in zip(x, x[1:], strict=False))]

    def forces(self, x, k, radius, positive):
        """Return the force on each ball but gravity, ``positive`` being max(., 0)."""
        push = [*(k * positive(-gap) for gap in self.gaps(x, radius)), 0]
        return [below - above for below, above in zip(push, push[1:], strict=False)]

    def reference(self):
        """Return the accelerations by NumPy."""
        m, x, _ = self.numbers()
        gap = np.diff(x, prepend=-RADIUS) - 2 * RADIUS
        push = np.append(STIFFNESS * np.clip(-gap, 0, None), 0)
        return -np.diff(push) / m - G

    def absolute(self, x):
        return np.asarray(x)


def hapticlab(model):
    """hl.mechanics.lagrange of the balls, a penalty contact below each."""
    import hapticlab as hl

    m, x0, v0 = model.numbers()
    N, names = model.contacts, [f"x{i}" for i in range(model.contacts)]
    k, radius, g = hl.parameters("k radius g", units="N/m m m/s^2", values=[STIFFNESS, RADIUS, G])
    m = declared("m", ["kg"] * N, m)
    starts = zip(names, declared("a", ["m"] * N, x0), declared("r", ["m/s"] * N, v0), strict=True)
    x = [hl.coordinate(name, unit="m", initial=a, rate=r) for name, a, r in starts]
    L = sum(mass * a.diff(hl.t) ** 2 / 2 - mass * g * a for mass, a in zip(m, x, strict=True))
    contacts = [hl.contact.Contact(gap, hl.contact.penalty(k=k), name=f"c{i}") for i, gap in enumerate(model.gaps(x, radius))]
    scene = hl.Scene(force=k * sum(x), eom=[hl.mechanics.lagrange(L, contacts=contacts)])
    return scene_made(scene, names, v0, model.h)


def casadi(model, c_code=False):
    """Written by hand in CasADi's SX, its VM or its C through gcc -O3."""
    import casadi as ca

    N = model.contacts
    x, v, m = (ca.SX.sym(name, N) for name in "xvm")
    k, radius, g = (ca.SX.sym(name) for name in ("k", "radius", "g"))
    push = model.forces(ca.vertsplit(x), k, radius, lambda a: ca.fmax(a, 0))
    a = ca.cse(ca.vertcat(*(f / mass - g for f, mass in zip(push, ca.vertsplit(m), strict=True))))
    return casadi_made(ca, x, v, ca.vertcat(m, k, radius, g), a, model, c_code)


def numba(model):
    """Written by hand as a loop over the contacts."""
    from numba import njit

    N = model.contacts

    @njit
    def rates(y, p):
        k, radius, g = p[N], p[N + 1], p[N + 2]
        r = np.empty(2 * N)
        above = 0.0
        for i in range(N - 1, -1, -1):
            gap = y[i] - y[i - 1] - 2 * radius if i else y[0] - radius
            push = k * max(-gap, 0.0)
            r[i], r[N + i] = y[N + i], (push - above) / p[i] - g
            above = push
        return r

    return numba_made(rates, model)


def mujoco(model, own=False):
    """MuJoCo with the same law, as springs with a dead band; or with contacts of its ``own``, another law.

    Its own law gives no accelerations to compare: instead of them comes the force [N] on the floor of balls at rest.
    """
    import mujoco as mj

    m, x, v = (a.tolist() for a in model.numbers())
    geom = f'<geom type="sphere" size="{RADIUS}" contype="0" conaffinity="0"/>'
    bodies = "".join(
        f'<body name="b{i}"><joint name="x{i}" type="slide" axis="0 0 1"/>{geom}'
        f'<inertial pos="0 0 0" mass="{mass}" diaginertia="1e-6 1e-6 1e-6"/></body>'
        for i, mass in enumerate(m)
    )
    below = [None, *range(len(m) - 1)]
    floor, pairs = "", ""
    if own:
        floor = '<geom name="floor" type="plane" size="1 1 1" contype="0" conaffinity="0"/>'
        bodies = bodies.replace("<geom", '<geom name="g{}"').format(*range(len(m)))
        names = ["floor" if i is None else f"g{i}" for i in below]
        pairs = "".join(f'<pair geom1="{a}" geom2="g{i}" condim="1"/>' for i, a in enumerate(names))
        pairs = f"<contact>{pairs}</contact>"
    else:
        for i, a in enumerate(below):
            minus = "" if a is None else f'<joint joint="x{a}" coef="-1"/>'
            apart = RADIUS if a is None else 2 * RADIUS
            pairs += f'<fixed stiffness="{STIFFNESS}" springlength="{apart} 1e9"><joint joint="x{i}" coef="1"/>{minus}</fixed>'
        pairs = f"<tendon>{pairs}</tendon>"
    made = mj.MjModel.from_xml_string(
        f'<mujoco><option gravity="0 0 -{G}" timestep="{model.h}" integrator="RK4"/>'
        f"<worldbody>{floor}{bodies}</worldbody>{pairs}</mujoco>"
    )
    data = mj.MjData(made)

    def run(steps, integrator=mj.mjtIntegrator.mjINT_RK4):
        made.opt.integrator = integrator
        mj.mj_resetData(made, data)
        data.qpos[:], data.qvel[:] = x, v
        mj.mj_step(made, data, steps)
        return np.stack([data.qpos, data.qvel])

    def accelerations():
        run(0)
        mj.mj_forward(made, data)
        return data.qacc.copy()

    def weight():
        made.opt.timestep = 2e-3
        run(5000, mj.mjtIntegrator.mjINT_EULER)
        made.opt.timestep, force = model.h, np.zeros(6)
        mj.mj_contactForce(made, data, 0, force)
        return force[:1]

    semi = lambda steps: run(steps, mj.mjtIntegrator.mjINT_EULER)  # noqa: E731
    return Made(weight if own else accelerations, run, semi_implicit=semi)
