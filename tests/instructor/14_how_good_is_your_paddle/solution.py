"""Answers of lab 14."""

from math import cos, pi, sqrt

import numpy as np

prediction_stiffest = 1500
prediction_first = "oscillation"
prediction_filter = "wider, when the damper buzzes"


def buzz_border(count, felt):
    """Return the stiffness whose jump over one count has the power of a sinusoid of the felt amplitude."""
    return sqrt(2) * felt / count


def border(b, B, late, f, gain, lag):
    """Return the stiffness that takes away all damping, of which a late damper gives the part in phase."""
    return (b + B * gain * cos(2 * pi * f * lag)) / late


def choose(lag, noise, cycles, B, felt, most_cycles):
    """Return the number of the earliest estimator that is quiet and cheap enough."""
    able = (sqrt(2) * B * np.array(noise) <= felt) & (np.array(cycles) <= most_cycles)
    return int(np.argmin(np.where(able, lag, np.inf))) if able.any() else -1


when_a_filter_helps = "b"


def effective(f, real, imaginary):
    """Return stiffness and damping of the spring and damper that have this impedance at each frequency."""
    return {"stiffness": -2 * np.pi * np.array(f) * np.array(imaginary), "damping": np.array(real)}


def same_up_to(f, off, weber):
    """Return the last frequency before the first value outside."""
    outside = np.flatnonzero(np.array(off) > weber)
    last = outside[0] if len(outside) else len(f)
    return float(f[last - 1]) if last else 0.0


def same_damping(b, B, late, weber):
    """Return the stiffness whose loss of damping is the fraction of all damping."""
    return weber * (b + B) / late


discussion = (
    "My page says that Eq. (23.10) guarantees 200 N/m, that the plain spring comes to rest up to about 2000 N/m in my pinch, and "
    "that one count buzzes only above 5500 N/m. The oscillation is the lower border, so a finer encoder would change nothing for "
    "a plain spring. I would sample twice as fast: this doubles the guarantee and nearly doubles the border of the oscillation, "
    "but one count then moves a damper's force twice as far, and the board has half as many cycles for each tick. In a lighter "
    "hand the border of 2000 N/m would fall, while the guarantee and the border of one count would stay."
)
