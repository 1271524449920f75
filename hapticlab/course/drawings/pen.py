"""What all drawings are made of: shapes, arrows and words on empty axes, in colours that read on white and on black."""

import math

from ...base.drawing import house_style, new_figure

#: black on paper; on a page the colour of its text
INK = "#010101"
#: mid tones: each has a contrast of 3 at least on white and on the dark of JupyterLab
WARM, COLD, GREY = "#d0611f", "#3f83c8", "#808080"


def sheet(width, height, across, up):
    """Return an empty figure, width and height in inches, and its axes, which show these ranges with equal scales."""
    with house_style():
        figure = new_figure(width=width, height=height)
        figure.set_layout_engine("none")
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set(xlim=across, ylim=up, aspect="equal")
        axes.set_axis_off()
    return figure, axes


def shape(axes, points, colour=INK, *, fill=None, hatch=None, dashed=False):
    """Draw a closed outline through points, filled or hatched if asked."""
    xs, ys = zip(*points, strict=True)
    inside = {"facecolor": fill or "none", "alpha": 0.2, "edgecolor": "none"}
    if fill:
        axes.fill(xs, ys, **inside)
    style = {"facecolor": "none", "edgecolor": colour, "linewidth": 1.4, "hatch": hatch}
    axes.fill(xs, ys, linestyle="--" if dashed else "-", **style)


def box(axes, left, bottom, width, height, **style):
    """Draw a rectangle."""
    right, top = left + width, bottom + height
    shape(axes, [(left, bottom), (right, bottom), (right, top), (left, top)], **style)


def arc(centre, radius, begin, end):
    """Return points on an arc about a centre, between angles in degrees."""
    angles = [math.radians(begin + (end - begin) * k / 60) for k in range(61)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def line(axes, points, colour=INK, *, width=1.4, dashes="-"):
    """Draw a line through points."""
    axes.plot(*zip(*points, strict=True), color=colour, linewidth=width, linestyle=dashes, solid_capstyle="butt")


def arrow(axes, begin, end, colour=INK, *, width=1.6, both=False):
    """Draw an arrow from one point to another."""
    style = {"arrowstyle": "<|-|>" if both else "-|>", "color": colour, "linewidth": width}
    axes.annotate("", end, begin, arrowprops={**style, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 14})


def words(axes, x, y, text, colour=INK, *, size=10.5, at="center", bold=False):
    """Write words; ``at`` says which side of them is at x."""
    weight = "bold" if bold else "normal"
    axes.text(x, y, text, color=colour, fontsize=size, ha=at, va="center", fontweight=weight, linespacing=1.35)


def named(axes, text, words_at, part_at, *, at="center"):
    """Write the name of a part, with a thin line from the name to the part."""
    line(axes, [words_at, part_at], GREY, width=0.9)
    axes.plot(*part_at, "o", color=GREY, markersize=3)
    gap = {"center": 0.0, "left": 0.08, "right": -0.08}[at]
    words(axes, words_at[0] + gap, words_at[1], text, at=at)
