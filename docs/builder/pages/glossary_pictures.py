"""Small drawings of the glossary, each made by code: force over position, and what is seen over time or in a plane.

A picture is a function of the axes. :func:`figure` draws one by its name, the same bytes every time.
"""

import math

import numpy as np
from matplotlib.figure import Figure

from hapticlab.base.drawing import COLD, WARM

from .glossary_sketches import SKETCHES

INK, SOFT = "#1b1f24", "#6b7580"
SIZE = 3.4, 1.9


def figure(name):
    """Return the picture of that name as a figure without numbers: what counts is the shape."""
    made = Figure(figsize=SIZE, layout="constrained", facecolor="white")
    axes = made.add_subplot()
    axes.spines[["top", "right"]].set_visible(False)
    axes.set(xticks=[], yticks=[])
    PICTURES[name](axes)
    return made


def curve(axes, x, y, colour=INK, **style):
    """Draw a line."""
    axes.plot(x, y, color=colour, **{"lw": 1.8, **style})


def named(axes, x, y):
    """Name both axes."""
    axes.set_xlabel(x, color=SOFT)
    axes.set_ylabel(y, color=SOFT)


def cross(axes):
    """Draw both axes through zero."""
    axes.axhline(0, color=SOFT, lw=0.8)
    axes.axvline(0, color=SOFT, lw=0.8)


def aliasing(axes):
    t = np.linspace(0, 8, 600)
    n = np.arange(9)
    curve(axes, t, np.sin(2 * math.pi * 0.875 * t), SOFT, lw=1)
    curve(axes, t, -np.sin(2 * math.pi * 0.125 * t), COLD)
    axes.plot(n, np.sin(2 * math.pi * 0.875 * n), "o", color=WARM)
    named(axes, "time", "position")


def backlash(axes):
    curve(axes, [0, 1, 4, 3, 0], [0, 0, 3, 3, 0])
    curve(axes, [1, 4], [0, 3], WARM)
    axes.annotate("", (1, -0.35), (0, -0.35), arrowprops={"arrowstyle": "<->", "color": SOFT})
    axes.text(0.5, -0.9, "play", ha="center", color=SOFT)
    axes.set_ylim(-1.2, 3.4)
    named(axes, "handle", "load")


def buzz(axes):
    t = np.linspace(0, 6, 600)
    curve(axes, t, 1 + np.sign(np.sin(2 * math.pi * t)), WARM, lw=1.2)
    curve(axes, t, -2 + 0.25 * np.sin(2 * math.pi * t), COLD)
    axes.text(6.1, 1, "F", color=WARM, va="center")
    axes.text(6.1, -2, "x", color=COLD, va="center")
    named(axes, "time", "")


def chatter(axes):
    t = np.linspace(0, 6, 600)
    curve(axes, t, 1 + 0.6 * np.exp(-t) * np.cos(2 * math.pi * 1.6 * t), COLD)
    curve(axes, t, 1 + 0.12 * np.exp(np.minimum(t, 5) / 1.7) * np.cos(2 * math.pi * 1.6 * t), WARM, lw=1.2)
    axes.axhline(0, color=SOFT, lw=0.8, ls="--")
    axes.text(0, 0.08, "boundary", color=SOFT)
    named(axes, "time", "x")


def coulomb(axes):
    cross(axes)
    curve(axes, [-2, 0, 0, 2], [-1, -1, 1, 1], WARM)
    axes.text(2.1, 1, "$f_c$", va="center")
    named(axes, "velocity", "friction")


def count(axes):
    x = np.linspace(0, 5, 501)
    curve(axes, x, x, SOFT, lw=1)
    curve(axes, x, np.floor(x), WARM)
    axes.annotate("", (5.15, 4), (5.15, 3), arrowprops={"arrowstyle": "<->", "color": INK})
    axes.text(5.3, 3.5, "1 count", va="center")
    axes.set_xlim(0, 7)
    named(axes, "position", "as it is read")


def dead_band(axes):
    cross(axes)
    curve(axes, [-1, -0.2, 0.2, 1], [-1, 0, 0, 1], WARM)
    named(axes, "duty", "force")


def dead_zone(axes):
    cross(axes)
    curve(axes, [-3, -1, 1, 3], [-2, 0, 0, 2], WARM)
    axes.text(1, -0.6, "$w$", ha="center")
    axes.text(-1, 0.25, "$-w$", ha="center")
    named(axes, "x", "F")


def _held(axes, late=0.0):
    t = np.linspace(0, 5, 300)
    n = np.arange(6)
    curve(axes, t, np.sin(0.5 * t), COLD, lw=1.2)
    axes.step(n + late, np.sin(0.5 * n), where="post", color=WARM, lw=1.8)
    axes.plot(n, np.sin(0.5 * n), "o", color=COLD, ms=4)
    named(axes, "time", "F")


def hold(axes):
    _held(axes)
    axes.annotate("", (3, 0.25), (2, 0.25), arrowprops={"arrowstyle": "<->", "color": INK})
    axes.text(2.5, 0.0, "T", ha="center")


def delay(axes):
    _held(axes, late=0.4)
    axes.annotate("", (2.4, 0.25), (2, 0.25), arrowprops={"arrowstyle": "<->", "color": INK, "shrinkA": 0, "shrinkB": 0})
    axes.text(2.5, 0.0, "delay")


def staircase(axes):
    way_in = np.array([0, 0.8, 1.7, 2.4, 2.9, 3.1])
    way_out = way_in[::-1]
    curve(axes, [0, 3.2], [0, 3.2], SOFT, lw=1)
    axes.step(way_in, way_in, where="post", color=COLD, lw=1.6)
    axes.step(way_out, way_out, where="post", color=WARM, lw=1.6)
    axes.text(2.1, 0.7, "in", color=COLD)
    axes.text(0.9, 2.0, "out", color=WARM)
    named(axes, "x", "F")


def hysteresis(axes):
    curve(axes, [0, 2.6, 2.6, 4], [0, 2.6, 1.4, 2.8], COLD)
    curve(axes, [2.6, 1.4, 1.4], [1.4, 0.2, 1.4], WARM)
    axes.fill([1.4, 2.6, 2.6, 1.4], [1.4, 2.6, 1.4, 0.2], color="#f4d9c8", lw=0)
    axes.text(2.0, 1.35, "energy", ha="center", fontsize=8)
    named(axes, "x", "F")


def limit_cycle(axes):
    for start in (0.25, 2.2):
        r, angle, step = start, 0.0, 0.02
        path = []
        for _ in range(900):
            path.append((r * math.cos(angle), -r * math.sin(angle)))
            r += step * 0.5 * r * (1 - r * r) / (1 + r)
            angle += step
        curve(axes, *np.array(path).T, SOFT, lw=0.9)
    circle = np.linspace(0, 2 * math.pi, 200)
    curve(axes, np.cos(circle), np.sin(circle), WARM, lw=2.2)
    axes.set_aspect("equal")
    named(axes, "x", "v")


def nyquist_disk(axes):
    angle = np.linspace(0, 2 * math.pi, 200)
    axes.fill(np.cos(angle), np.sin(angle), color="#dbe6f0", ec=COLD)
    w = np.linspace(0.02, math.pi, 200)
    curve(axes, 0.75 * np.cos(w) - 0.1, -0.55 * np.sin(w) * np.exp(-0.15 * w), WARM)
    cross(axes)
    axes.set_aspect("equal")
    named(axes, "Re", "Im")


def psychometric(axes):
    level = np.linspace(0, 4, 200)
    curve(axes, level, 0.5 + 0.48 / (1 + np.exp(-3 * (level - 1.6))), COLD)
    axes.plot([0, 1.6, 1.6], [0.74, 0.74, 0.5], color=SOFT, ls="--", lw=1)
    axes.text(1.65, 0.52, "threshold")
    named(axes, "difference", "right answers")


def pwm(axes):
    edges, values = [], []
    for k in range(6):
        width = 0.15 + 0.13 * k
        edges += [k, k, k + width, k + width]
        values += [0, 1, 1, 0]
    curve(axes, [*edges, 6], [*values, 0], lw=1.2)
    curve(axes, np.arange(6) + 0.5, 0.15 + 0.13 * np.arange(6), WARM, ls="--")
    named(axes, "time", "voltage")


def root_locus(axes):
    angle = np.linspace(0, 2 * math.pi, 200)
    curve(axes, np.cos(angle), np.sin(angle), SOFT, lw=1)
    gain = np.linspace(0, 1, 60)
    for side in (1, -1):
        curve(axes, 0.95 - 0.35 * gain**2, side * 1.05 * gain, WARM)
    axes.plot([0.95], [0], "x", color=INK)
    axes.set_aspect("equal")
    named(axes, "Re z", "Im z")


def saturation(axes):
    cross(axes)
    curve(axes, [-2, -1, 1, 2], [-1, -1, 1, 1], WARM)
    axes.text(2.05, 1, "$F_{max}$", va="center")
    named(axes, "computed F", "at the motor")


def up_down(axes):
    level = [8, 7, 6, 5, 4, 3, 4, 3, 4, 5, 4, 3, 4, 3, 4]
    axes.step(range(len(level)), level, where="mid", color=COLD)
    axes.axhline(3.8, color=WARM, ls="--", lw=1)
    named(axes, "trial", "level")


def stick_slip(axes):
    curve(axes, [0, 4], [0, 4], SOFT, lw=1)
    curve(axes, [0, 1, 1.15, 2, 2.15, 3, 3.15, 4], [0, 0, 1.1, 1.1, 2.1, 2.1, 3.1, 3.1], WARM)
    axes.text(2.4, 3.4, "handle", color=SOFT, ha="right")
    axes.text(3.3, 2.3, "block", color=WARM)
    named(axes, "time", "position")


def unilateral(axes):
    cross(axes)
    curve(axes, [-2, 0, 2], [0, 0, 2], WARM)
    axes.text(0.1, -0.45, "$x_o$")
    axes.set_ylim(-0.6, 2.1)
    named(axes, "x", "F")


def velocity(axes):
    t = np.linspace(0, 3, 100)
    curve(axes, t, t**2 / 3, SOFT, lw=1.2)
    n = np.arange(4)
    axes.plot(n, n**2 / 3, "o", color=COLD)
    curve(axes, [1.5, 3.2], [4 / 3 - 0.5 * 5 / 3, 3 + 0.2 * 5 / 3], WARM)
    curve(axes, [2.4, 3.2], [3 - 0.6 * 2, 3 + 0.2 * 2], COLD, ls="--")
    axes.text(1.55, 0.35, "chord", color=WARM, ha="right", va="bottom")
    axes.text(2.3, 3.1, "tangent", color=COLD, ha="right")
    named(axes, "time", "x")


def fixture(axes):
    cross(axes)
    curve(axes, [-3, -2, -1, 0, 1, 2, 2, 3], [0, 0, -1, 0, 1, 0, 0, 3], WARM)
    axes.text(0.1, -0.9, "guide")
    axes.text(2.05, -0.9, "wall")
    named(axes, "x", "F")


def wall_map(axes):
    B = np.linspace(0, 4, 100)
    passive, stable = 1.9 - 0.4 * B, 2.2 + 2.2 * np.sin(0.8 * B)  # Eq. (23.10): K T/2 < b - |B|
    axes.fill_between(B, 0, np.minimum(passive, stable), color="#dbe6f0", lw=0)
    axes.fill_between(B, np.minimum(passive, stable), stable, color="#f3f6fa", lw=0)
    curve(axes, B, stable, WARM)
    axes.text(0.5, 0.5, "passive")
    axes.text(1.4, 2.3, "stable")
    axes.text(0.1, 4.3, "chatters", color=WARM)
    axes.set_ylim(0, 5)
    named(axes, "B", "K")


def z_width(axes):
    B = np.linspace(0, 4, 100)
    K = 1 + 3.4 * np.sin(0.72 * B)
    axes.fill_between(B, 0, np.maximum(K, 0), color="#dbe6f0", lw=0)
    curve(axes, B, np.maximum(K, 0), COLD)
    axes.text(1.3, 1.5, "Z-width")
    named(axes, "B", "largest K")


_CURVES = (
    aliasing, backlash, buzz, chatter, coulomb, count, dead_band, dead_zone, delay, fixture, hold, hysteresis, limit_cycle,
    nyquist_disk, psychometric, pwm, root_locus, saturation, staircase, stick_slip, unilateral, up_down, velocity, wall_map,
    z_width,
)  # fmt: skip
#: name of a picture -> what draws it
PICTURES = {**{draw.__name__: draw for draw in _CURVES}, **SKETCHES}
