"""Pendulums carried by the handle: hanging from it, and standing on a cart."""

from __future__ import annotations

import sympy as sp

from ..scene.mechanics.lagrange import lagrange
from ..scene.notation.symbols import coordinate, n, parameters, t, x
from ..scene.scene import Scene
from .bodies import coupler


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
