"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x

m, K, b_c = hl.parameters("m K b_c", units="kg N/m N*s/m")
z = hl.coordinate("z", unit="m", initial=x(n))


def pendulum(weight, product, z=z, exchanged=False):
    """A pendulum with gravity's sign, the product of the velocities and the masses as given."""
    theta = hl.coordinate("theta", unit="rad", initial=0.3)
    M, l, g, c = hl.parameters("M l g c", units="kg m m/s^2 N*m*s/rad", values=(0.05, 0.15, 9.81, 1e-4))
    F_c = hl.laws.virtual_coupler(z, K=K, b=b_c)
    square = z.diff(t) ** 2 + product * z.diff(t) * l * theta.diff(t) + (l * theta.diff(t)) ** 2
    carriage, bob = (m, M) if exchanged else (M, m)
    energy = carriage * z.diff(t) ** 2 / 2 + bob * square / 2 + weight * bob * g * l * sp.cos(theta)
    model = hl.mechanics.lagrange(energy, dissipation=c * theta.diff(t) ** 2 / 2, forces={z: F_c})
    return hl.Scene(force=F_c, eom=[model], watch=[z, theta])


WRONG = [
    ("euler_step", lambda z, w, x, v, m, K, b_c, T: {"z": z + T * w, "w": w + T * (K * (x - z) + b_c * (v - w)) / m}),
    ("pendulum", pendulum(-1, 2 * sp.cos(hl.coordinate("theta", unit="rad", initial=0.3)))),
    ("pendulum", pendulum(1, 0)),
    ("pendulum", pendulum(1, 2 * sp.cos(hl.coordinate("theta", unit="rad", initial=0.3)), hl.coordinate("z", unit="m"))),
    ("pendulum", pendulum(1, 2 * sp.cos(hl.coordinate("theta", unit="rad", initial=0.3)), exchanged=True)),
    ("coupler_stiffness", lambda b, T, b_c: 2 * b / T),
    ("felt_wall", lambda K, k: K + k),
    ("longest_period", 1.5e-4),
    ("swing_frequency", lambda l, g, M, m, K: np.sqrt(g / l) / (2 * np.pi)),
    ("who_pays", "a"),
]  # fmt: skip
