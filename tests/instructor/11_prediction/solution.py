"""Answers of lab 11, by the names they have in the notebook."""

import numpy as np

import hapticlab as hl
from hapticlab import n, x

prediction = "nothing"  # a text is saved as well
prediction_late = 16.0

k, x_o = hl.parameters("k x_o", units="N/m m")
half_sample_wall = hl.Scene(force=hl.when(x(n) >= x_o, k * (1.5 * (x(n) - x_o) - 0.5 * (x(n - 1) - x_o))))
ellis_wall = hl.Scene(force=hl.when(x(n) >= x_o, k * (2 * (x(n) - x_o) - 1.5 * (x(n - 1) - x_o) + 0.5 * (x(n - 2) - x_o))))


def look_ahead(T, delay):
    """The weights of k (x(n) + s (x(n) - x(n-1))) with k s T = k (T/2 + delay)."""
    s = 0.5 + delay / T
    return np.array([1 + s, -s])


def nyquist_damping(taps, k, T):
    """Damping that pays for alternating samples [N s/m]: b (2a)^2/T >= 2 k a^2 h."""
    h = np.sum(taps * (-1.0) ** np.arange(len(taps)))
    return k * T * h / 2


def deadbeat_forces(m, T, x, v, x_goal, v_goal):
    """The two held forces [N]: F0 + F1 from the velocity, 3 F0 + F1 from the position."""
    both = m * (v - v_goal) / T
    weighted = 2 * m * (x + 2 * T * v - x_goal) / T**2
    return np.array([(weighted - both) / 2, (3 * both - weighted) / 2])


which_law = "a"
discussion = """
A straight line is furthest from the path where the force jumps or bends the path: at the boundary, where the force begins in
the middle of a period, and at the deepest point, where the velocity changes its sign. In the period of the crossing every
predictor is wrong, also the one with a model; only a dead-beat pair corrects this period, and it needs a fine position. At
the deepest point the straight line is wrong by half the acceleration times the square of the time that it looks ahead, so
the error grows with the delay, and the law with a model is right there. For my paddle I would choose the law with a model
first, since the table of the last section shows a leak of less than a tenth of that of the plain law and the program costs
only a few instructions more. Then I would buy a finer encoder, since one count is worth 1 + 2 s counts of force and the
stiffest wall without a buzz is far below the linear limit. A faster computer also helps the hold and the delay, but makes
the dead-beat pair worse.
"""
