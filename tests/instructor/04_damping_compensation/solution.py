"""Answers of lab 04, by the names they have in the notebook."""

import numpy as np

import hapticlab as hl
from hapticlab import n, v, x

prediction_factor = 5
prediction_over = "the handle goes on by itself"
prediction_free_air = 80.0

viscous, dry = hl.parameters("viscous dry", units="1 1")
b, f_c, speed = hl.parameters("b f_c speed", units="N*s/m N m/s")
compensating = hl.Scene(force=-viscous * b * v(n) - dry * f_c * hl.when(v(n) > speed, 1, hl.when(v(n) < -speed, -1, 0)))


def coast(v0, m, b, coulomb):
    """Distance from v0 to rest [m]: the integral of m v/(b v + coulomb)."""
    logarithm = coulomb / b * np.log(1 + b * v0 / coulomb) if coulomb else 0.0
    return m / b * (v0 - logarithm)


def cycle_amplitude(g, k, kept):
    """Amplitude of the limit cycle [m]: A = g/k + r (A + g/k)."""
    return g / k * (1 + kept) / (1 - kept)


def onset(kept):
    """Fraction above which the spring breaks the handle away at each turn: (dry - 1)(1 + r) > 1 - r."""
    return 2 / (1 + kept)


def safe_fractions(b, b_low, b_high, coulomb, coulomb_low, coulomb_high):
    """Lower ends as fractions of the estimates [1]."""
    return {"viscous": b_low / b, "dry": coulomb_low / coulomb}


def stiffest_passive(b, b_added, B, T):
    """Largest passive stiffness [N/m], Eq. (23.10) solved for K."""
    return max(0.0, 2 * (b + b_added - abs(B)) / T)


k, x_o = hl.parameters("k x_o", units="N/m m")
B = hl.parameters("B", units="N*s/m", ranges=(-1, 1))
free_air_wall = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o), B * (x(n) - x(n - 1)) / hl.T))

which_design = "b"
discussion = """
My paddle has a damping of about 0.13 N s/m and a dry friction of about 0.05 N, both known to a few per cent. I compensate 80 %
of the lower ends, and only where x is outside the wall. If the true friction is at the lower end, the handle still loses a
fifth of what it lost before, so it comes to rest. If it falls below the interval by more than a fifth, the handle drifts off
in free air. The limit cycle has an amplitude because the force that is left over supplies an energy per metre while the
damping dissipates more in a larger and faster swing, so that the two balance at one amplitude. Inside the wall the spring
needs the damping of the device for the energy that the hold generates, so a compensation there takes away what it needs.
"""
