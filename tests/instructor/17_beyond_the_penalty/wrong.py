"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np


def ratio_once(F, m_1, m_2, N):
    a = F / (m_1 + N * m_2)
    return {"acceleration": a, "reaction": m_2 * N * a}


def masses_added(F, m_1, m_2, N):
    a = F / (m_1 + m_2)
    return {"acceleration": a, "reaction": m_2 * a}


def reaction_on_first(F, m_1, m_2, N):
    a = F / (m_1 + N**2 * m_2)
    return {"acceleration": a, "reaction": N * m_2 * N * a}


def as_at_rest(F, m_1, m_2, N):
    return {"acceleration": F / (m_1 + N**2 * m_2), "reaction": F / N}


def nearest_surface(x, x_o):
    x = np.asarray(x, float)
    out, side = [], 1 if x[0] < x_o else -1
    for handle in x:
        out.append(min(handle, x_o) if side > 0 else max(handle, x_o))
        if abs(handle - x_o) > 0.005:
            side = 1 if handle < x_o else -1
            out[-1] = handle
    return np.array(out)


def one_side(x, x_o):
    return np.minimum(x, x_o)


def never_back(x, x_o):
    z, out = x[0], []
    for handle in x:
        z = z if z == x_o else min(handle, x_o) if x[0] < x_o else max(handle, x_o)
        out.append(z)
    return np.array(out)


def from_the_start(x, K, F_c):
    return np.clip(K * (np.asarray(x) - x[0]), -F_c, F_c)


def by_the_sign(x, K, F_c):
    return F_c * np.sign(np.diff(x, prepend=x[0]))


def jumping(x, K, F_c):
    z, forces = x[0], []
    for handle in x:
        if abs(K * (handle - z)) > F_c:
            z = handle
        forces.append(K * (handle - z))
    return np.array(forces)


def hand_alone(a, v, m, b, f_c, M):
    return {"impedance": m * a + b * v + f_c, "admittance": M * a}


def no_friction(a, v, m, b, f_c, M):
    return {"impedance": (m + M) * a + b * v, "admittance": M * a}


def device_shown(a, v, m, b, f_c, M):
    return {"impedance": (m + M) * a + b * v + f_c, "admittance": (m + M) * a}


WRONG = [
    ("lever", ratio_once),
    ("lever", masses_added),
    ("lever", reaction_on_first),
    ("lever", as_at_rest),
    ("stiffest_spring", lambda m_1, m_2, N, T: 4 * m_2 / T**2),
    ("stiffest_spring", lambda m_1, m_2, N, T: 4 * (m_1 + m_2) / T**2),
    ("stiffest_spring", lambda m_1, m_2, N, T: 4 / (T**2 * (1 / m_2 + 1 / m_1))),
    ("stiffest_spring", lambda m_1, m_2, N, T: 1 / (T**2 * (1 / m_2 + N**2 / m_1))),
    ("proxy", lambda x, x_o: np.asarray(x, float)),
    ("proxy", one_side),
    ("proxy", never_back),
    ("rubbed", from_the_start),
    ("rubbed", by_the_sign),
    ("rubbed", jumping),
    ("rubbed", lambda x, K, F_c: K * (np.asarray(x) - x[0])),
    ("sampled_frequency", lambda v, p, T: v / p),
    ("sampled_frequency", lambda v, p, T: min(v / p, 1 / (2 * T))),
    ("sampled_frequency", lambda v, p, T: v / p % (1 / T)),
    ("largest_amplitude", lambda b, T, p: 2 * b * p / T),
    ("largest_amplitude", lambda b, T, p: b * p / (2 * np.pi * T)),
    ("largest_amplitude", lambda b, T, p: 2 * b / T),
    ("hand_force", hand_alone),
    ("hand_force", no_friction),
    ("hand_force", device_shown),
    ("displays", "a"),
    ("displays", "c"),
    ("displays", "d"),
]
