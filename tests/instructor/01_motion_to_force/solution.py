"""Answers of lab 01, by the names of the notebook."""

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x

k, b = hl.parameters("k b", units="N/m N*s/m")
m = hl.parameters("m", units="kg")
z = hl.coordinate("z", unit="m", initial=x(n))
K, b_c = hl.parameters("K b_c", units="N/m N*s/m")

prediction = 4.5
thousand = "a"


def spring_damper_force(x, v, k, b):
    """Return the force on the environment [N]: both terms resist."""
    return k * x + b * v


spring_damper = hl.Scene(force=k * x(n) + b * v(n), name="a spring and a damper")


def spring_and_damper(x, v, F):
    """Return stiffness and damping by least squares."""
    (k, b), *_ = np.linalg.lstsq(np.column_stack([x, v]), F, rcond=None)
    return {"k": k, "b": b}


def count_step(m, metres_per_count, T):
    """Return the jump of the force [N]: x(n) alone has moved."""
    return m * metres_per_count / T**2


mass_equation = sp.Eq(m * z.diff(t, 2), K * (x(t) - z) + b_c * (v(t) - z.diff(t)))

mass_on_coupler = hl.Scene(
    force=K * (x(t) - z) + b_c * (v(t) - z.diff(t)),
    eom=[mass_equation],
    watch=[z],
    name="a mass on a coupler",
)


def resonance(m, K, b_c):
    """Return natural frequency [Hz] and damping ratio."""
    return {"f": np.sqrt(K / m) / (2 * np.pi), "zeta": b_c / (2 * np.sqrt(K * m))}


discussion = """
The position of the sensor changes in steps of one count. The second difference divides
such a step by T squared, so a single count becomes 1.28 N for 0.1 kg, fifty times the
force of the motion itself, and this force moves the handle to the next count. The
coupler needs no derivative: the mass has its own state, and integration makes this
state smooth. In return there is a spring between the hand and the mass: the hand feels
quick starts late and softened, the mass oscillates against the coupler and the hand,
and above its resonance the hand feels the spring of the coupler rather than the mass.
"""
