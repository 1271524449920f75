"""Sketches of the glossary: who pushes whom, and what a mechanism looks like."""

import numpy as np
from matplotlib.patches import Circle, FancyBboxPatch, Polygon

from hapticlab.base.drawing import COLD, WARM

INK, SOFT, BODY = "#1b1f24", "#6b7580", "#dbe6f0"


def bare(axes, left, right, bottom, top):
    """Show this part of the plane to scale, without axes."""
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    axes.set_axis_off()


def box(axes, x, y, words, wide=1.7, high=0.8, colour=BODY):
    """Draw a named box around its centre."""
    axes.add_patch(FancyBboxPatch((x - wide / 2, y - high / 2), wide, high, boxstyle="round,pad=0.05", fc=colour, ec=INK))
    axes.text(x, y, words, ha="center", va="center")


def arrow(axes, start, end, words="", colour=INK, above=0.15):
    """Draw an arrow with words above its middle."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": "->", "color": colour, "lw": 1.4, "shrinkA": 0, "shrinkB": 0})
    axes.text((start[0] + end[0]) / 2, (start[1] + end[1]) / 2 + above, words, ha="center", color=colour)


def spring(axes, x1, x2, y, high=0.18):
    """Draw a spring along x."""
    x = np.linspace(x1, x2, 12)
    axes.plot(x, y + high * np.r_[0, 0, [1, -1] * 4, 0, 0], color=INK, lw=1.2)


def damper(axes, x1, x2, y, high=0.18):
    """Draw a damper along x."""
    middle = (x1 + x2) / 2
    axes.plot([x1, middle], [y, y], [middle, middle], [y - high, y + high], color=INK, lw=1.2)
    axes.plot(
        [middle - 0.3, middle + 0.2, middle + 0.2, middle - 0.3], [y + high, y + high, y - high, y - high], color=INK, lw=1.2
    )
    axes.plot([middle + 0.2, x2], [y, y], color=INK, lw=1.2)


def chain(axes):
    bare(axes, -1.2, 8.2, -1.2, 1.2)
    for x, words in ((0, "hand"), (3.5, "handle"), (7, "environ-\nment")):
        box(axes, x, 0, words, high=1.1)
    for x in (0.9, 4.4):
        arrow(axes, (x, 0.3), (x + 1.6, 0.3), "v", COLD)
        arrow(axes, (x + 1.6, -0.3), (x, -0.3), "F", WARM, above=-0.55)


def coupler(axes):
    bare(axes, -1.2, 5.4, -1.1, 1.1)
    box(axes, 0, 0, "handle")
    box(axes, 4.2, 0, "mass")
    spring(axes, 0.9, 3.3, 0.3)
    damper(axes, 0.9, 3.3, -0.3)
    axes.text(2.1, 0.65, "K", ha="center")
    axes.text(2.1, -0.95, "b", ha="center")


def fault(axes):
    bare(axes, -1.2, 8.2, -1.5, 1.3)
    for x, words, colour in ((0, "idle", BODY), (3.5, "run", BODY), (7, "fault", "#f4d9c8")):
        box(axes, x, 0, words, colour=colour)
    arrow(axes, (0.95, 0), (2.55, 0), "start")
    arrow(axes, (4.45, 0), (6.05, 0), "at once", WARM)
    axes.annotate("", (0, -0.5), (7, -0.5), arrowprops={"arrowstyle": "->", "color": INK, "connectionstyle": "arc3,rad=-0.12"})
    axes.text(3.5, -1.4, "a person clears it", ha="center", color=SOFT)


def gap(axes):
    bare(axes, -0.4, 6.4, -0.6, 2.6)
    axes.add_patch(Polygon([(-0.4, 0), (6.4, 0), (6.4, -0.6), (-0.4, -0.6)], fc="#e9ebee", ec="none"))
    axes.plot([-0.4, 6.4], [0, 0], color=INK)
    for x, y in ((1.3, 1.6), (4.6, 0.5)):
        axes.add_patch(Circle((x, y), 0.8, fc=BODY, ec=INK, alpha=0.9))
    arrow(axes, (1.3, 0.4), (1.3, 0.8))
    arrow(axes, (1.3, 0.4), (1.3, 0.0))
    axes.text(1.5, 0.3, "gap > 0", color=COLD)
    axes.text(4.6, 1.5, "gap < 0", ha="center", color=WARM)


def paddle(axes):
    bare(axes, -2.2, 2.6, -1.2, 2.3)
    rim = np.linspace(np.radians(215), np.radians(325), 60)
    axes.add_patch(Polygon([(0, 0.6), *zip(2 * np.cos(rim), 0.6 + 2 * np.sin(rim) + 0.4, strict=True)], fc=BODY, ec=INK))
    axes.plot([0, 0], [0.6, 1.7], color=INK, lw=5, solid_capstyle="round")
    axes.add_patch(Circle((0, 1.8), 0.22, fc="white", ec=INK))
    axes.add_patch(Circle((0, 0.6), 0.1, fc="white", ec=INK))
    axes.add_patch(Circle((0, -1.2), 0.2, fc=WARM, ec=INK))
    axes.set_ylim(-1.6, 2.3)
    axes.text(0.35, 1.75, "handle", va="center")
    axes.text(0, -0.45, "sector", ha="center")
    axes.text(0.35, -1.35, "drum of the motor", va="center", color=WARM)
    arrow(axes, (-0.2, 2.05), (-0.9, 2.05))
    arrow(axes, (0.2, 2.05), (0.9, 2.05))


def proxy(axes):
    bare(axes, -3, 3, -1.5, 1.1)
    axes.add_patch(Polygon([(-3, 0), (3, 0), (3, -1.5), (-3, -1.5)], fc="#e9ebee", ec="none"))
    axes.plot([-3, 3], [0, 0], color=INK)
    y = np.linspace(-1.1, 0, 12)
    axes.plot(0.15 * np.r_[0, 0, [1, -1] * 4, 0, 0], y, color=INK, lw=1.2)
    axes.add_patch(Circle((0, 0.18), 0.18, fc=COLD, ec=INK))
    axes.add_patch(Circle((0, -1.2), 0.18, fc="white", ec=INK))
    axes.text(0.4, 0.25, "proxy", va="center", color=COLD)
    axes.text(0.4, -1.2, "handle", va="center")


def sign(axes):
    bare(axes, -4.6, 4.4, -1.3, 1.3)
    box(axes, 0, 0, "handle")
    axes.add_patch(Polygon([(2.6, -1), (4.2, -1), (4.2, 1), (2.6, 1)], fc="#e9ebee", ec=INK))
    axes.text(3.4, 0, "wall", ha="center", va="center")
    arrow(axes, (0.95, 0.25), (2.5, 0.25), "F", WARM)
    arrow(axes, (-0.95, 0.0), (-3.0, 0.0), "", COLD)
    axes.text(-4.5, 0.25, "-F of the motor", color=COLD)
    arrow(axes, (0.0, -1.1), (1.6, -1.1), "")
    axes.text(1.75, -1.1, "x", va="center")


SKETCHES = {draw.__name__: draw for draw in (chain, coupler, fault, gap, paddle, proxy, sign)}
