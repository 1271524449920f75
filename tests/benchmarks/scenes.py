"""The scenes the benchmark runs, written as a student would, and the inputs that drive them."""

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x

T = 1e-3


def wall():
    """Return the chapter's wall, Eq. (23.5)."""
    k, x_o = hl.parameters("k x_o", units="N/m m")
    return hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)), name="wall")


def coupler():
    """Return a mass on a virtual coupler (Fig. 23.4) that meets a wall at x_w."""
    z = hl.coordinate("z", unit="m")
    m, b, K, k_w, x_w = hl.parameters("m b K k_w x_w", units="kg N*s/m N/m N/m m")
    F_c = K * (x(t) - z) + b * (v(t) - z.diff(t))
    F_w = hl.when(z >= x_w, k_w * (z - x_w))
    return hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c - F_w)], name="coupler")


COUPLER = {"K": 400.0, "b": 2.0, "k_w": 1000.0, "m": 0.1, "x_w": 0.01}


def ball():
    """Return a ball that bounces on the handle: a penalty contact that does not pull, started 50 mm above."""
    z = hl.coordinate("z", unit="m", initial=0.05)
    m, B, K, g = hl.parameters("m B K g", units="kg N*s/m N/m m/s^2")
    push = hl.when(z <= x(t), sp.Max(0, -K * (z - x(t)) - B * (z.diff(t) - v(t))))
    return hl.Scene(force=push, eom=[sp.Eq(m * z.diff(t, 2), push - m * g)], name="ball")


BALL = {"B": 1.0, "K": 1e4, "g": 9.81, "m": 0.05}


def pendulum(links=8):
    """Return a chain of equal links in absolute angles, its first link twisted by the handle through a spring."""
    q = [hl.coordinate(f"q{k}", unit="rad") for k in range(links)]
    m, l, g, K, r = hl.parameters("m l g K r", units="kg m m/s^2 N*m m")
    torque = K * (x(t) / r - q[0])
    eom = []
    for i in range(links):
        row = m * g * l * (links - i) * sp.sin(q[i]) - (torque if i == 0 else 0)
        for j in range(links):
            mass = m * l**2 * (links - max(i, j))
            cos = sp.cos(q[i]) * sp.cos(q[j]) + sp.sin(q[i]) * sp.sin(q[j]) if i != j else 1
            sin = sp.sin(q[i]) * sp.cos(q[j]) - sp.cos(q[i]) * sp.sin(q[j]) if i != j else 0
            row += mass * (cos * q[j].diff(t, 2) + sin * q[j].diff(t) ** 2)
        eom.append(sp.Eq(row, 0))
    return hl.Scene(force=torque / r, eom=eom, name="pendulum")


PENDULUM = {"K": 0.1, "g": 9.81, "l": 0.2, "m": 0.05, "r": 0.1}


def compiled(scene, dtype="float64", method="rk4", **options):
    """Return the scene's program with one RK4 step a tick, the handle held as the C by hand holds it."""
    return hl.compile(scene, method, T=T, hold="zoh", dtype=dtype, velocity="measured", **options)


def handle(ticks):
    """Return a seeded motion of the handle: x [m] and v [m/s], shape (ticks, 2)."""
    at, phase = np.arange(ticks) * T, np.random.default_rng(1).uniform(0, 6, 5)
    w = np.array([3.0, 7.0, 11.0, 17.0, 29.0])
    angle = w * at[:, None] + phase
    return np.stack([(0.006 * np.sin(angle)).sum(1), (0.006 * w * np.cos(angle)).sum(1)], axis=1)


def paddles():
    """Return the two paddles of the sweep: a bare handle, and one with an encoder in a hand."""
    plain = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)
    hand = hl.Hand(m=0.1, b=2.0, k=200.0, push=1.0)
    held = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, counts_per_metre=50_000, hand=hand)
    return {"wall": plain, "wall, hand, encoder": held}
