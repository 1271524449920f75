"""Answers of lab 13."""

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x

prediction_noticed = "CDE"
prediction_saved = 60


def needed(uses, force):
    """Return 1 for each state that the force needs: those in it, and again and again those that they use."""
    found = np.array(force) > 0
    for _ in range(len(found)):
        found = found | (found @ (np.array(uses) > 0))
    return found.astype(int)


def felt_ratio(full, smaller, least, weber, rows):
    """Return the largest rms difference over its threshold, window by window."""
    full, smaller = np.asarray(full, float), np.asarray(smaller, float)
    found = []
    for first in range(0, len(full) - rows + 1, rows):
        window = slice(first, first + rows)
        apart = np.sqrt(np.mean((smaller[window] - full[window]) ** 2))
        found.append(apart / max(least, weber * np.sqrt(np.mean(full[window] ** 2))))
    return max(found)


def shaken(A, p, speed, m, b, k):
    """Return the amplitude of a mass on a spring and a damper, at the frequency with which grooves pass."""
    omega = 2 * np.pi * speed / p
    return A / abs(k - m * omega**2 + 1j * b * omega)


def speed_noticed(b, c, least, weber):
    """Return the higher of two speeds: c v^2 = least, and c v^2 = weber (b v + c v^2)."""
    return max((least / c) ** 0.5, weber * b / ((1 - weber) * c))


def highest_frequency(m_1, m_2, k, weber):
    """Return where m_2 r^2/(1 - r^2) is the part weber of m_1 + m_2/(1 - r^2)."""
    r_squared = weber * (m_1 + m_2) / (m_2 + weber * m_1)
    return (r_squared * k / m_2) ** 0.5 / (2 * np.pi)


m_1, m_2 = hl.parameters("m_1 m_2", units="kg kg", values=(0.05, 0.1))
K, b_c = hl.parameters("K b_c", units="N/m N*s/m", values=(200, 0.5))
z = hl.coordinate("z", unit="m", initial=x(n))
F_c = hl.laws.virtual_coupler(z, K=K, b=b_c)
rigid = hl.Scene(force=F_c, eom=[sp.Eq((m_1 + m_2) * z.diff(t, 2), F_c)])
hides = "c"
discussion = (
    "I would send scene A without its tail, because the force is the same at every sample and two thirds of the cycles are free, "
    "and scene B with declared ranges. Scene C keeps the drag, as my hand moves faster than a tenth of a metre per second, and "
    "scene E keeps its grooves on this encoder, although the force threshold is never reached. Scene D may lose its spring for "
    "slow motion below two hertz. I would not trust the thresholds for a person with a more sensitive hand, since they come "
    "from other people and other handles, and would let this person compare both scenes blindly."
)
