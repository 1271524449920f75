"""Masses, springs and dampers behind the handle: a mass-spring-damper, two masses, the tuned absorber."""

from __future__ import annotations

import math

import sympy as sp

from ..scene.laws.chapter_laws import virtual_coupler
from ..scene.notation.symbols import coordinate, n, parameters, t, x
from ..scene.scene import Scene


def coupler(z):
    """Force K (x - z) + b_c (x' - z') of a virtual coupler from the handle to a body at z, Fig. 23.4.

    K = 200 N/m and b_c = 0.1 N s/m: with T = 1 ms passive on a paddle with b >= K T/2 + b_c = 0.2 N s/m, and a few
    hundredths more for the estimated velocity that the body sees.
    """
    K, b_c = parameters("K b_c", units="N/m N*s/m", values=(200, 0.1))
    return virtual_coupler(z, K=K, b=b_c)


def mass_spring_damper() -> Scene:
    """Mass-spring-damper behind a virtual coupler: m z'' + b z' + k z = F_c, F_c = K (x - z) + b_c (x' - z').

    One feels a spring when moving slowly, next to nothing near sqrt(k/m) = 5 Hz, and a mass beyond. Held still, the
    handle transmits the ringing of the mass on k and K together, sqrt((k + K)/m).

    Teaches natural frequency, damping ratio and impedance; any textbook of system dynamics, such as K. Ogata, *System
    Dynamics*, ch. 3. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms. On an Uno: semi-implicit Euler at 1000 Hz.

    Returns
    -------
    Scene
        With m, b, k of the body, K, b_c of the coupler; z starts at the handle.

    Examples
    --------
    >>> import hapticlab as hl
    >>> scene = hl.library.mass_spring_damper()(k=250)
    >>> (scene.values["k"] / scene.values["m"]) ** 0.5
    50.0
    """
    z = coordinate("z", unit="m", initial=x(n))
    m, b, k = parameters("m b k", units="kg N*s/m N/m", values=(0.1, 0.1, 100))
    F_c = coupler(z)
    return Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c - k * z - b * z.diff(t))], watch=[z], name="mass-spring-damper")


def two_masses() -> Scene:
    """Two masses joined by a spring, the first behind a virtual coupler: m_1 z_1'' = F_c - F_k, m_2 z_2'' = F_k.

    F_k = k (z_1 - z_2) + b (z_1' - z_2'). Pushed slowly the handle carries both masses; shaken at the antiresonance
    sqrt(k/m_2) = 3.6 Hz the second mass holds the first still; let go, they ring against each other with
    sqrt(k (1/m_1 + 1/m_2)) while their centre moves on.

    Teaches modes, the rigid-body mode, resonance and antiresonance (non-collocated control); J. P. Den Hartog,
    *Mechanical Vibrations*, ch. 3. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms. On an Uno: semi-implicit Euler at
    800 Hz.

    Returns
    -------
    Scene
        With m_1, m_2, k, b, and K, b_c of the coupler; both masses start at the handle.

    Examples
    --------
    >>> import hapticlab as hl
    >>> p = hl.library.two_masses().values
    >>> round((p["k"] * (1 / p["m_1"] + 1 / p["m_2"])) ** 0.5, 6)
    38.729833
    """
    z_1, z_2 = (coordinate(name, unit="m", initial=x(n)) for name in ("z_1", "z_2"))
    m_1, m_2, k, b = parameters("m_1 m_2 k b", units="kg kg N/m N*s/m", values=(0.05, 0.1, 50, 0.02))
    F_c, F_k = coupler(z_1), k * (z_1 - z_2) + b * (z_1.diff(t) - z_2.diff(t))
    eom = [sp.Eq(m_1 * z_1.diff(t, 2), F_c - F_k), sp.Eq(m_2 * z_2.diff(t, 2), F_k)]
    return Scene(force=F_c, eom=eom, watch=[z_1, z_2], name="two masses")


def tuned_absorber() -> Scene:
    """Tuned vibration absorber: a machine shaken by F_0 sin(Omega t), a small mass m_2 on k_2 hung on it.

    m_1 z_1'' = F_0 sin(Omega t) - k_1 z_1 - b_1 z_1' - F_2 + F_c, m_2 z_2'' = F_2, F_2 = k_2 (z_1 - z_2) + b_2 (...).
    One feels the machine through a virtual coupler. Where Omega = sqrt(k_2/m_2) the buzz in the handle dies: m_2 swings
    with F_0/k_2 and its spring cancels the excitation, whatever the hand does. Detune Omega by 20 % and it is back.

    Teaches the absorber's null, the two resonances beside it, and why b_2 > 0 trades the null for width; J. P. Den
    Hartog, *Mechanical Vibrations*, sec. 3.2. Needs b >= K T/2 + b_c, 0.2 N s/m at T = 1 ms, to be passive but for F_0,
    which feeds energy. On an Uno: semi-implicit Euler at 500 Hz.

    Returns
    -------
    Scene
        With m_1, b_1, k_1, m_2, b_2, k_2, F_0, Omega [rad/s], and K, b_c of the coupler. Tuned as it comes.

    Examples
    --------
    >>> import hapticlab as hl
    >>> p = hl.library.tuned_absorber().values
    >>> p["Omega"] == (p["k_2"] / p["m_2"]) ** 0.5
    True
    """
    z_1, z_2 = coordinate("z_1", unit="m"), coordinate("z_2", unit="m")
    m_1, b_1, k_1 = parameters("m_1 b_1 k_1", units="kg N*s/m N/m", values=(0.15, 0.3, 150))
    m_2, b_2, k_2 = parameters("m_2 b_2 k_2", units="kg N*s/m N/m", values=(0.03, 0, 30))
    F_0, Omega = parameters("F_0 Omega", units="N rad/s", values=(0.3, math.sqrt(30 / 0.03)), ranges=[None, (0, 500)])
    F_c, F_2 = coupler(z_1), k_2 * (z_1 - z_2) + b_2 * (z_1.diff(t) - z_2.diff(t))
    F_1 = F_0 * sp.sin(Omega * t) - k_1 * z_1 - b_1 * z_1.diff(t)
    eom = [sp.Eq(m_1 * z_1.diff(t, 2), F_1 - F_2 + F_c), sp.Eq(m_2 * z_2.diff(t, 2), F_2)]
    return Scene(force=F_c, eom=eom, watch=[z_1, z_2], name="tuned absorber")
