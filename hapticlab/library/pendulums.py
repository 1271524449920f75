"""Pendulums carried by the handle: hanging from it, and standing on a cart."""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..scene.mechanics.lagrange import lagrange
from ..scene.notation.symbols import coordinate, n, parameters, t, x
from ..scene.scene import Scene
from .bodies import coupler
from .sketch import Sketch, clearance


def pendulum_on_the_handle() -> Scene:
    """Pendulum hanging from a carriage of mass M that a virtual coupler ties to the handle.

    L = M z'^2/2 + m (z'^2 + 2 l z' theta' cos(theta) + l^2 theta'^2)/2 + m g l cos(theta), theta from below, and c theta'
    in the pivot. Held still, the handle transmits the swing, sqrt(g/l) = 1.29 Hz; moved at that rate it hardly follows:
    the pendulum absorbs the motion. One can pump it, and feel where in the swing that takes work.

    Teaches Lagrange's equations with a moving support, the pendulum's nonlinear period, crane swing; L. D. Landau and E.
    M. Lifshitz, *Mechanics*, sec. 5. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms. On an Uno: semi-implicit Euler at
    500 Hz.

    Returns
    -------
    Scene
        With M, m [kg], l [m], g, c [N m s/rad], and K, b_c of the coupler; theta starts at 0.3 rad.

    Examples
    --------
    >>> import hapticlab as hl
    >>> p = hl.library.pendulum_on_the_handle().values
    >>> print(f"{(p['g'] / p['l']) ** 0.5:.3f} rad/s")
    8.087 rad/s
    """
    z, theta = coordinate("z", unit="m", initial=x(n)), coordinate("theta", unit="rad", initial=0.3)
    M, m, l, g = parameters("M m l g", units="kg kg m m/s^2", values=(0.05, 0.05, 0.15, 9.81), ranges={"l": (0.01, 10)})
    c, F_c = parameters("c", units="N*m*s/rad", values=1e-4), coupler(z)
    dz, w = z.diff(t), theta.diff(t)
    kinetic = M * dz**2 / 2 + m * (dz**2 + 2 * l * dz * w * sp.cos(theta) + (l * w) ** 2) / 2
    motion = lagrange(kinetic + m * g * l * sp.cos(theta), dissipation=c * w**2 / 2, forces={z: F_c})
    return Scene(force=F_c, eom=[motion], watch=[z, theta], name="pendulum on the handle")


def draw_pendulum_on_the_handle(axes, *, x=0.015, z=0.006, theta=0.4, l=0.15, **_):
    """Draw the carriage on its rail beside the handle, the pendulum below it."""
    s, origin = Sketch(axes, -0.075, 0.225, min(-0.19, -l - 0.04), 0.035), 0.085 + clearance(x, z)
    pivot, hangs = np.array([z + origin, 0.0]), np.cos(theta) > 0
    bob = pivot + l * np.array([np.sin(theta), -np.cos(theta)])
    s.pair((x, 0), (pivot[0] - 5 * s.u, 0))
    s.handle(x)
    s.line((min(0.06, pivot[0] - 7 * s.u), -4.2 * s.u), (max(origin + 0.09, pivot[0] + 7 * s.u), -4.2 * s.u), width=1.6)
    s.block(pivot, 10, 8)
    s.text(pivot, "$M$", right=-2.8)
    s.line((pivot[0], 0), (pivot[0], -l - 4 * s.u), width=0.8, color="#8a8a8a", linestyle="--")
    s.rod(pivot, bob, width=2.0)
    s.text((pivot + bob) / 2, "$l$", right=3 if theta >= 0 else -3, up=0.5)
    s.disc(bob, 2.6 * s.u, zorder=5)
    s.text(bob, "$m$", right=5.5)
    s.pin(pivot)
    s.angle(pivot, (0.45 if hangs else 0.3) * l / s.u, -np.pi / 2, -np.pi / 2 + theta, r"$\theta$")
    s.coordinate("$z$", z, (9 if hangs else -12) * s.u, origin=origin)


def cart_pole() -> Scene:
    """Cart and pole: a pendulum upright on a cart of mass M that a virtual coupler ties to the handle; balance it.

    L = M z'^2/2 + m (z'^2 + 2 l z' theta' cos(theta) + l^2 theta'^2)/2 - m g l cos(theta), theta from the top, and
    c theta' in the hinge. With the cart held, the pole falls as e^(t sqrt(g/l)); one has about 3 sqrt(l/g) to act, so
    a longer pole is easier. A hand that pushes back where it feels the pole lean balances it.

    Teaches an unstable equilibrium, its eigenvalues, and stabilisation by a human operator; K. J. Astrom and R. M.
    Murray, *Feedback Systems*, 2008, sec. 2.2. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms. On an Uno: semi-implicit
    Euler at 500 Hz.

    Returns
    -------
    Scene
        With M, m [kg], l [m], g, c [N m s/rad], and K, b_c of the coupler; theta starts at 0.01 rad.

    Examples
    --------
    >>> import hapticlab as hl
    >>> p = hl.library.cart_pole()(l=1).values
    >>> print(f"falls by e in {(p['l'] / p['g']) ** 0.5:.2f} s")
    falls by e in 0.32 s
    """
    z, theta = coordinate("z", unit="m", initial=x(n)), coordinate("theta", unit="rad", initial=0.01)
    M, m, l, g = parameters("M m l g", units="kg kg m m/s^2", values=(0.1, 0.05, 0.3, 9.81), ranges={"l": (0.01, 10)})
    c, F_c = parameters("c", units="N*m*s/rad", values=1e-3), coupler(z)
    dz, w = z.diff(t), theta.diff(t)
    kinetic = M * dz**2 / 2 + m * (dz**2 + 2 * l * dz * w * sp.cos(theta) + (l * w) ** 2) / 2
    motion = lagrange(kinetic - m * g * l * sp.cos(theta), dissipation=c * w**2 / 2, forces={z: F_c})
    return Scene(force=F_c, eom=[motion], watch=[z, theta], name="cart and pole")


def draw_cart_pole(axes, *, x=0.03, z=0.015, theta=0.35, l=0.3, **_):
    """Draw the cart on the ground beside the handle, the pole above it."""
    s, origin = Sketch(axes, -0.13, 0.37, -0.085, max(0.335, l + 0.035)), 0.15 + clearance(x, z)
    hinge, stands = np.array([z + origin, 0.0]), np.cos(theta) > 0
    bob = hinge + l * np.array([np.sin(theta), np.cos(theta)])
    s.ground((min(0.07, hinge[0] - 10 * s.u), -0.035), (max(origin + 0.18, hinge[0] + 10 * s.u), -0.035))
    s.pair((x, 0), (hinge[0] - 8 * s.u, 0))
    s.handle(x)
    s.block(hinge, 16, 8)
    s.text(hinge, "$M$", right=-4.5)
    for side in (-5, 5):
        s.disc(hinge + [side * s.u, -5.5 * s.u], 1.5 * s.u)
    s.line(hinge, hinge + [0, 0.75 * l], width=0.8, color="#8a8a8a", linestyle="--")
    s.rod(hinge, bob, width=2.5)
    s.text(hinge + 0.4 * (bob - hinge), "$l$", right=3 if theta >= 0 else -3)
    s.disc(bob, 2.2 * s.u, zorder=5)
    s.text(bob, "$m$", right=5)
    s.pin(hinge)
    s.angle(hinge, (0.6 if stands else 0.3) * l / s.u, np.pi / 2, np.pi / 2 - theta, r"$\theta$")
    s.coordinate("$z$", z, -13 * s.u, origin=origin)
