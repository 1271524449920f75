"""Force fields along the handle's path, without states: detents, texture, a virtual fixture, a buckling beam.

Each is the slope of a potential U(x), F = dU/dx. Sampled and held, it is passive for any hand on a paddle with
b >= K T/2, where K is the steepest slope of F: the proof of Eq. (23.10) needs no more than that slope.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..scene.notation.symbols import n, parameters, when, x
from ..scene.scene import Scene
from .sketch import SOFT, Sketch

TWO_PI = 2 * sp.pi


def detents() -> Scene:
    """Detents, as of a knob that clicks: F = A sin(2 pi x/p), minima of U at every multiple of the pitch p.

    One feels stable places p apart and has to overcome A in between. The handle rings in a detent with
    sqrt(2 pi A/(p m)).

    Teaches equilibria and their stability from a potential, and the pendulum equation in another guise; S. H. Strogatz,
    *Nonlinear Dynamics and Chaos*, sec. 2.7 and 6.7. Needs b >= pi A T/p = 0.19 N s/m at T = 1 ms. On an Uno: 1000 Hz.

    Returns
    -------
    Scene
        With A [N], the force that leaves a detent, and the pitch p [m].

    Examples
    --------
    >>> import math
    >>> import hapticlab as hl
    >>> q = hl.library.detents().values
    >>> print(f"{2 * math.pi * q['A'] / q['p']:.0f} N/m in a detent")
    377 N/m in a detent
    """
    A, p = parameters("A p", units="N m", values=(0.6, 0.01), ranges=[(0, 20), (1e-4, 1)])
    return Scene(force=A * sp.sin(TWO_PI * x(n) / p), name="detents")


def draw_detents(axes, *, x=0.013, A=0.6, p=0.01, **_):
    """Draw the potential as a track on which the handle's roller rests."""
    s = Sketch(axes, -0.058, 0.058, -0.0125, 0.0175)
    height = 0.01 * A * p / 0.006  # the potential's swing is A p/pi

    def track(at):
        return -0.5 * height * np.cos(2 * np.pi * at / p)

    s.track(track, x, "$U(x)$")
    low = -0.5 * height - 2 * s.u
    first = -2 * p
    for place in (first, first + p):
        s.line((place, low - s.u), (place, -0.5 * height - 0.5 * s.u), width=0.8, color=SOFT)
    s.arrow((first, low), (first + p, low))
    s.text((first + p / 2, low), "pitch $p$", up=-2.2)


def texture() -> Scene:
    """Texture on one half of the path, from the slope of its height: F = A (sin(2 pi x/p_1) + sin(2 pi x/p_2)), x >= 0.

    The left half is smooth. Two gratings whose pitches have no common multiple nearby feel rough rather than ribbed;
    bind p_2 = p_1 for a ribbed one. Nothing moves sideways but the force, and yet one feels height.

    Teaches the lateral-force illusion, spatial against temporal frequency (v/p, sampled at 1/T: keep v below p/(2 T)),
    and why fine textures buzz; M. Minsky et al., *Feeling and seeing*, SI3D 1990. Needs b >= pi A T (1/p_1 + 1/p_2) =
    0.27 N s/m at T = 1 ms. On an Uno: 1000 Hz.

    Returns
    -------
    Scene
        With A [N] and the pitches p_1, p_2 [m].

    Examples
    --------
    >>> import hapticlab as hl
    >>> sorted(hl.library.texture().values)
    ['A', 'p_1', 'p_2']
    """
    A = parameters("A", units="N", values=0.1, ranges=(0, 20))
    p_1, p_2 = parameters("p_1 p_2", units="m m", values=(0.003, 0.00185), ranges=[(1e-4, 1), (1e-4, 1)])
    F = A * (sp.sin(TWO_PI * x(n) / p_1) + sp.sin(TWO_PI * x(n) / p_2))
    return Scene(force=when(x(n) >= 0, F), name="texture")


def draw_texture(axes, *, x=0.0135, p_1=0.003, p_2=0.00185, **_):
    """Draw the height that the force imitates, with the handle's stylus on it."""
    s = Sketch(axes, -0.058, 0.058, -0.0125, 0.0175)

    def track(at):
        bumps = p_1 * (1 - np.cos(2 * np.pi * at / p_1)) + p_2 * (1 - np.cos(2 * np.pi * at / p_2))
        return np.where(at >= 0, 0.3 * bumps, 0.0)

    s.track(track, x, "$U(x)$")
    s.text((-0.03, 0), "smooth", up=-4)
    s.text((0.03, 0), "$p_1,\\ p_2$", up=-4)


def virtual_fixture() -> Scene:
    """Virtual fixtures: a guide that draws the handle to x_g from as far as w, and a forbidden region beyond x_o.

    With d = x - x_g: F = k d for \\|d\\| <= w/2, k (w sign(d) - d) up to w, none beyond; and k_w (x - x_o) for x >= x_o.
    One feels nothing, is drawn in, rests at x_g, and cannot pass x_o.

    Teaches guidance against forbidden regions, and that a smooth onset costs no more stiffness than its slope; L. B.
    Rosenberg, *Virtual fixtures*, VRAIS 1993. Needs b >= k_w T/2 = 0.2 N s/m at T = 1 ms. On an Uno: 1000 Hz.

    Returns
    -------
    Scene
        With x_g, w [m], k of the guide, and k_w [N/m], x_o [m] of the wall.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.library.virtual_fixture()(x_g="-10 mm").values["x_g"]
    -0.01
    """
    k, k_w = parameters("k k_w", units="N/m N/m", values=(150, 400))
    x_g, w, x_o = parameters("x_g w x_o", units="m m m", values=(0, 0.02, 0.035), ranges=[None, (1e-3, 0.1), None])
    d = x(n) - x_g
    guide = when(sp.Abs(d) <= w / 2, k * d, k * (sp.Max(w - sp.Abs(d), 0) * sp.sign(d)))
    return Scene(force=guide + when(x(n) >= x_o, k_w * (x(n) - x_o)), name="virtual fixture")


def draw_virtual_fixture(axes, *, x=-0.006, x_g=0.0, w=0.02, x_o=0.035, k=150.0, k_w=400.0, **_):
    """Draw the potential: a well at x_g, level ground, the wall that begins at x_o."""
    s = Sketch(axes, -0.058, 0.058, -0.0125, 0.0175)

    def track(at):
        d = np.abs(at - x_g)
        near, far = d**2 / 2, w**2 / 4 - np.maximum(w - d, 0) ** 2 / 2
        well = k * (np.where(d <= w / 2, near, far) - w**2 / 4)
        wall = 0.5 * k_w * np.maximum(at - x_o, 0) ** 2
        return np.minimum(0.6, 0.0055 / np.maximum(k * w**2 / 4, 1e-9)) * (well + wall)  # the well stays above its letters

    s.track(track, x, "$U(x)$")
    for place, name in ((x_g, "$x_g$"), (x_o, "$x_o$")):
        s.line((place, -0.0072), (place, track(place)), width=0.8, color=SOFT)
        s.text((place, -0.0072), name, up=-1.8)
    s.arrow((x_g, -0.0064), (x_g + w, -0.0064), "$w$")


def buckling_beam() -> Scene:
    """Buckling beam pressed in the middle, its load P in parts of the critical one: F = k (1 - P) x + k_3 x^3.

    Below P = 1 it is a hardening spring about x = 0. Beyond, the middle is unstable and two stable states appear at
    x = +-sqrt(k (P - 1)/k_3): the handle snaps from one to the other. Set P live to feel the pitchfork open.

    Teaches bifurcation, bistability and negative stiffness; S. H. Strogatz, *Nonlinear Dynamics and Chaos*, sec. 3.4
    (pitchfork) and 12.5 (the double well). Needs b >= T/2 times the steepest slope, k (1 - P) + 3 k_3 x^2 = 330 N/m at
    50 mm: 0.17 N s/m at T = 1 ms. On an Uno: 1000 Hz.

    Returns
    -------
    Scene
        With P (0 to 3), k [N/m], k_3 [N/m^3].

    Examples
    --------
    >>> import hapticlab as hl
    >>> q = hl.library.buckling_beam().values
    >>> round((q["k"] * (q["P"] - 1) / q["k_3"]) ** 0.5, 6)
    0.03
    """
    P = parameters("P", units="1", values=1.5, ranges=(0, 3))
    k, k_3 = parameters("k k_3", units="N/m N/m^3", values=(90, 5e4), ranges=[None, (0, 1e7)])
    return Scene(force=k * (1 - P) * x(n) + k_3 * x(n) ** 3, name="buckling beam")


def draw_buckling_beam(axes, *, x=0.024, P=1.5, k=90.0, k_3=5e4, **_):
    """Draw the beam upright between its loads, its middle at the handle, and the other state dashed."""
    s = Sketch(axes, -0.09, 0.09, -0.04, 0.046)
    u, half = s.u, 0.027
    along = np.linspace(-half, half, 25)
    shape = np.cos(0.5 * np.pi * along / half)
    rest = np.sqrt(np.maximum(k * (P - 1) / np.where(k_3 > 0, k_3, np.inf), 0.0))
    for state in (rest, -rest):
        s.line(*np.column_stack([state * shape, along]).tolist(), width=1.0, color=SOFT, linestyle="--")
    s.line(*np.column_stack([x * shape, along]).tolist(), width=4.0, zorder=3)
    s.pin((0, -half), fixed=True)
    s.pin((0, half))
    s.arrow((0, half + 5.6 * u), (0, half + u))
    s.text((0, half + 4 * u), "$P\\,P_{cr}$", right=5)
    s.handle(x, below=11.2)
