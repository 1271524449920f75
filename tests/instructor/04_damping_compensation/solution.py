"""Answers of lab 04, by the names they have in the notebook."""

import numpy as np

import hapticlab as hl
from hapticlab import n, x

prediction = "nothing"  # a text is saved as well

k, x_o = hl.parameters("k x_o", units="N/m m")
half_sample_wall = hl.Scene(force=hl.when(x(n) >= x_o, k * (1.5 * (x(n) - x_o) - 0.5 * (x(n - 1) - x_o))))
ellis_wall = hl.Scene(force=hl.when(x(n) >= x_o, k * (2 * (x(n) - x_o) - 1.5 * (x(n - 1) - x_o) + 0.5 * (x(n - 2) - x_o))))


def nyquist_damping(taps, k, T):
    """Damping that pays for alternating samples [N s/m]: b (2a)^2/T >= 2 k a^2 h."""
    h = np.sum(taps * (-1.0) ** np.arange(len(taps)))
    return k * T * h / 2


def stiffest_passive(b, b_added, B, T):
    """Largest passive stiffness [N/m], Eq. (23.10) solved for K."""
    return max(0.0, 2 * (b + b_added - abs(B)) / T)


prediction_free_air = 700.0

B = hl.parameters("B", units="N*s/m", ranges=(-1, 1))
free_air_wall = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o), B * (x(n) - x(n - 1)) / hl.T))


def deadbeat_forces(m, T, x, v, x_goal, v_goal):
    """The two held forces [N]: F0 + F1 from the velocity, 3 F0 + F1 from the position."""
    both = m * (v - v_goal) / T
    weighted = 2 * m * (x + 2 * T * v - x_goal) / T**2
    return np.array([(weighted - both) / 2, (3 * both - weighted) / 2])


which_law = "a"
discussion = """
For the plain wall with the virtual damper inside it the directive is false: the hold leaks at every frequency alike, and in
slow motion the virtual damper removes what the real one adds, so the limit is that of the damping that is felt. With the
virtual damper in free air only, the directive is nearly true: the two are needed at different positions and meet only at the
crossing; but inside the wall the hand feels the real damper. For the laws that predict the directive is true: they compensate
for slow motion themselves and need the damper only in fast motion, where the virtual damper does not cancel it. A straight
line is furthest from the path where the force jumps or bends the path, at the boundary and at the deepest point: in the
period of the crossing every predictor is wrong.
"""
