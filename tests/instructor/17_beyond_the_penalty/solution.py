"""Answers of lab 17."""

import numpy as np

prediction_through = 1.0
prediction_cheaper = "constraint"
prediction_grating = "coarse"


def lever(F, m_1, m_2, N):
    """Return what follows from m_1 a = F - N (m_2 N a)."""
    acceleration = F / (m_1 + N**2 * m_2)
    return {"acceleration": acceleration, "reaction": m_2 * N * acceleration}


def stiffest_spring(m_1, m_2, N, T):
    """Return the stiffness of omega T = 2, omega^2 = k (1/m_2 + N^2/m_1)."""
    return 4 / (T**2 * (1 / m_2 + N**2 / m_1))


def proxy(x, x_o):
    """Return the handle, stopped at the plate on the side on which it starts."""
    x = np.asarray(x, float)
    return np.minimum(x, x_o) if x[0] < x_o else np.maximum(x, x_o)


def rubbed(x, K, F_c):
    """Return the pull to a proxy that is dragged along at F_c/K."""
    z, forces = x[0], []
    for handle in x:
        z = min(max(z, handle - F_c / K), handle + F_c / K)
        forces.append(K * (handle - z))
    return np.array(forces)


def sampled_frequency(v, p, T):
    """Return the distance of v/p from the nearest multiple of 1/T."""
    return abs(v / p - round(v / p * T) / T)


def largest_amplitude(b, T, p):
    """Return the amplitude whose slope 2 pi A/p is 2b/T."""
    return b * p / (np.pi * T)


def hand_force(a, v, m, b, f_c, M):
    """Return device and body on the one display, the body alone on the other."""
    return {"impedance": (m + M) * a + b * v + f_c, "admittance": M * a}


displays = "b"
discussion = (
    "The hinge of the door is a constraint, because the door turns about one point and must not drift, and it costs cycles "
    "but no step. The membrane is a thin plate with a proxy, limited by the stiffness that my paddle keeps stable in a "
    "pinch; beyond it I would feel chatter. The sandpaper is a fine grating as a force field, limited by its slope, so that "
    "the finest pitch that I can feel and that stays passive is near half a millimetre at this speed; beyond it the handle "
    "buzzes. I would build all of it as an admittance display only on a geared arm with a force sensor, and then nothing "
    "may be lighter than its least body."
)
