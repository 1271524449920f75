"""Answers of lab 06, by the names of the notebook."""

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x

z = hl.coordinate("z", unit="m", initial=x(n))
theta = hl.coordinate("theta", unit="rad", initial=0.3)
M, m, l, g, c = hl.parameters("M m l g c", units="kg kg m m/s^2 N*m*s/rad", values=(0.05, 0.05, 0.15, 9.81, 1e-4))
K, b_c = hl.parameters("K b_c", units="N/m N*s/m")
F_c = hl.laws.virtual_coupler(z, K=K, b=b_c)

prediction = 1.64
who_pays = "c"


def euler_step(z, w, x, v, m, K, b_c, T):
    """Return the new position and velocity: velocity first, position with the new velocity."""
    w = w + T * (K * (x - z) + b_c * (v - w)) / m
    return {"z": z + T * w, "w": w}


pendulum = hl.Scene(
    force=F_c,
    eom=[
        hl.mechanics.lagrange(
            M * z.diff(t) ** 2 / 2
            + m * ((z + l * sp.sin(theta)).diff(t) ** 2 + (l * sp.cos(theta)).diff(t) ** 2) / 2
            + m * g * l * sp.cos(theta),
            dissipation=c * theta.diff(t) ** 2 / 2,
            forces={z: F_c},
        )
    ],
    watch=[z, theta],
    name="my pendulum",
)


def coupler_stiffness(b, T, b_c):
    """Return the K for which b = K T/2 + b_c [N/m]."""
    return 2 * (b - b_c) / T


def felt_wall(K, k):
    """Return the stiffness of two springs in series [N/m]."""
    return K * k / (K + k)


K_WALL = 2000.0
K_FELT = 800.0
longest_period = 2 * (0.1 - 0.02) * (1 / K_FELT - 1 / K_WALL)


def swing_frequency(l, g, M, m, K):
    """Return the root of the smaller w^2 of M l w^4 - ((M + m) g + K l) w^2 + K g = 0, in Hz."""
    half = ((M + m) * g + K * l) / 2
    squared = (half - np.sqrt(half**2 - M * l * K * g)) / (M * l)
    return np.sqrt(squared) / (2 * np.pi)


discussion = """
The wall is felt through the coupler in series, so 2000 N/m at the hand needs a coupler stiffer still, while b = 0.1 N s/m at
T = 1 ms allows 200 N/m at most, without any damper of its own. A coupler of 4000 N/m before a wall of 4000 N/m feels like
2000. It needs b > K T/2 = 2 N s/m at 1 ms: twenty times the damping, which the hand feels as drag unless a negative virtual
damper takes it out again at low frequencies. Or it needs T = 2 b/K = 0.05 ms, a loop at 20 kHz, which the board cannot run.
In between, 4 kHz and b = 0.5 N s/m do it, too.
"""
