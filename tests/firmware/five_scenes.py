"""Five scenes of growing cost, as a student writes them, and the motion of the handle that drives them."""

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import t, v, x

MOVE = 0.01  # how far the handle moves [m]


def wall():
    """Return the chapter's wall with its damper, Eq. (23.5)."""
    return hl.wall("backward_difference")(k=150, B=1, x_o=0.002), {}


def mass_and_wall():
    """Return a mass on a virtual coupler (Fig. 23.4) with a spring of its own and a wall."""
    z = hl.coordinate("z", unit="m")
    m, b, K, k, k_w, x_w = hl.parameters("m b K k k_w x_w", units="kg N*s/m N/m N/m N/m m")
    F = K * (x(t) - z) + b * (v(t) - z.diff(t))
    F_w = hl.when(z >= x_w, k_w * (z - x_w))
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - k * z - F_w)], name="mass, spring, damper and wall")
    return scene(m=0.1, b=2, K=400, k=50, k_w=1000, x_w=0.004), {"method": "semi_implicit_euler"}


def cart_pole(start=0.4):
    """Return a cart on a virtual coupler with a hanging pole."""
    s, a = hl.coordinate("s", unit="m"), hl.coordinate("a", unit="rad", initial=start)
    M, m, l, g, K = hl.parameters("M m l g K", units="kg kg m m/s^2 N/m")
    F = K * (x(t) - s)
    along = (M + m) * s.diff(t, 2) + m * l * (sp.cos(a) * a.diff(t, 2) - sp.sin(a) * a.diff(t) ** 2)
    swing = l * a.diff(t, 2) + sp.cos(a) * s.diff(t, 2) + g * sp.sin(a)
    scene = hl.Scene(force=F, eom=[sp.Eq(along, F), sp.Eq(swing, 0)], name="cart-pole")
    return scene(M=0.5, m=0.1, l=0.3, g=9.81, K=300), {"method": "semi_implicit_euler"}


def pendulum(start=0.3):
    """Return a pendulum whose pivot is turned by the handle through a spring."""
    q = hl.coordinate("q", unit="rad", initial=start)
    m, l, g, K, r = hl.parameters("m l g K r", units="kg m m/s^2 N*m m")
    torque = K * (x(t) / r - q)
    scene = hl.Scene(force=torque / r, eom=[sp.Eq(m * l**2 * q.diff(t, 2), torque - m * g * l * sp.sin(q))], name="pendulum")
    return scene(m=0.05, l=0.2, g=9.81, K=0.1, r=0.05), {"method": "rk4"}


def double_pendulum(start=0.3):
    """Return two equal links in absolute angles, the first turned by the handle through a spring."""
    a, b = hl.coordinate("a", unit="rad", initial=start), hl.coordinate("b", unit="rad", initial=-0.2)
    m, l, g, K, r = hl.parameters("m l g K r", units="kg m m/s^2 N*m m")
    torque = K * (x(t) / r - a)
    cos, sin = sp.cos(a - b), sp.sin(a - b)
    first = 2 * a.diff(t, 2) + cos * b.diff(t, 2) + sin * b.diff(t) ** 2 + 2 * g / l * sp.sin(a)
    second = b.diff(t, 2) + cos * a.diff(t, 2) - sin * a.diff(t) ** 2 + g / l * sp.sin(b)
    scene = hl.Scene(force=torque / r, eom=[sp.Eq(m * l**2 * first, torque), sp.Eq(second, 0)], name="double pendulum")
    return scene(m=0.05, l=0.2, g=9.81, K=0.1, r=0.05), {"method": "rk4"}


SCENES = (wall, mass_and_wall, cart_pole, pendulum, double_pendulum)


def compiled(make, T=1e-3, **changed):
    """Return a scene's program for a board."""
    scene, options = make()
    return hl.compile(scene, T=T, **{**options, **changed})


def handle(ticks, T=1e-3, seed=1):
    """Return a seeded motion of the handle [m] in whole counts of 13 um, as a sensor gives it."""
    phase = np.random.default_rng(seed).uniform(0, 6, 5)
    angle = np.array([3.0, 7.0, 11.0, 17.0, 29.0]) * (np.arange(ticks) * T)[:, None] + phase
    position = 0.4 * MOVE * np.sin(angle).sum(1)
    return np.round(position / 13e-6)[:, None] * 13e-6
