"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np
import sympy as sp

import hapticlab as hl


def one_round(uses, force):
    found = np.array(force) > 0
    return (found | (found @ (np.array(uses) > 0))).astype(int)


def backwards(uses, force):
    found = np.array(force) > 0
    for _ in found:
        found = found | ((np.array(uses) > 0) @ found)
    return found.astype(int)


def windows(full, smaller, rows):
    whole = len(full) // rows * rows
    return [np.asarray(F, float)[:whole].reshape(-1, rows) for F in (full, smaller)]


def rms(values, **options):
    return np.sqrt(np.mean(np.asarray(values) ** 2, **options))


def over_all(full, smaller, least, weber, rows):
    return rms(np.subtract(smaller, full)) / max(least, weber * rms(full))


def by_means(full, smaller, least, weber, rows):
    full, smaller = windows(full, smaller, rows)
    return np.max(abs(np.mean(smaller - full, axis=1)) / np.maximum(least, weber * abs(np.mean(full, axis=1))))


def sums(full, smaller, least, weber, rows):
    full, smaller = windows(full, smaller, rows)
    return np.max(rms(smaller - full, axis=1) / (least + weber * rms(full, axis=1)))


def in_hertz(A, p, speed, m, b, k):
    f = speed / p
    return A / abs(k - m * f**2 + 1j * b * f)


def rigid_with(mass):
    z = hl.coordinate("z", unit="m", initial=hl.x(hl.n))
    K, b_c = hl.parameters("K b_c", units="N/m N*s/m", values=(200, 0.5))
    F = hl.laws.virtual_coupler(z, K=K, b=b_c)
    return hl.Scene(force=F, eom=[sp.Eq(mass * z.diff(hl.t, 2), F)])


m_1, m_2 = hl.parameters("m_1 m_2", units="kg kg", values=(0.05, 0.1))

WRONG = [
    ("needed", one_round),
    ("needed", backwards),
    ("needed", lambda uses, force: np.array(force)),
    ("felt_ratio", over_all),
    ("felt_ratio", by_means),
    ("felt_ratio", sums),
    ("shaken", in_hertz),
    ("shaken", lambda A, p, speed, m, b, k: A / k),
    ("speed_noticed", lambda b, c, least, weber: (least / c) ** 0.5),
    ("speed_noticed", lambda b, c, least, weber: min((least / c) ** 0.5, weber * b / ((1 - weber) * c))),
    ("speed_noticed", lambda b, c, least, weber: max((least / c) ** 0.5, weber * b / c)),
    ("highest_frequency", lambda m_1, m_2, k, weber: (k / m_2) ** 0.5 / (2 * np.pi)),
    ("highest_frequency", lambda m_1, m_2, k, weber: (weber * k / m_2) ** 0.5 / (2 * np.pi)),
    ("highest_frequency", lambda m_1, m_2, k, weber: (weber * (m_1 + m_2) / (m_2 + weber * m_1) * k / m_2) ** 0.5),
    ("rigid", rigid_with(m_1)),
    ("rigid", rigid_with(m_2)),
    ("rigid", rigid_with(m_1 * m_2 / (m_1 + m_2))),
    ("hides", "a"),
    ("hides", "b"),
    ("hides", "d"),
]  # fmt: skip
