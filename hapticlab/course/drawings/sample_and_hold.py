"""What sampling and holding do to the force of a virtual wall, over time, Fig. 23.6."""

import math

from .pen import COLD, GREY, WARM, arrow, line, sheet, words

TITLE = "Sample and hold: position and force over time"
ALT = (
    "Two curves over time. Above, the handle enters a wall and leaves it on a smooth curve x(t); a dot marks each sample x(n), "
    "one per period T. Below, the force of an ideal spring follows that curve. The force of the motor is a staircase: it "
    "jumps to k x(n) at each sample and stays constant until the next. So it lies below the ideal force on the way in, "
    "and above it on the way out."
)
PERIODS, BEGIN, STEP = 10, 1.6, 1.0


def draw():
    """Draw position above and force below, on one time line."""
    figure, axes = sheet(7.2, 3.9, (0, 14.4), (0, 7.8))
    for low, top, name in ((4.5, 7.5, "$x$"), (0.7, 3.9, "$F_e$")):
        arrow(axes, (1.1, low), (13.2, low))
        arrow(axes, (1.1, low - 0.2), (1.1, top))
        words(axes, 0.75, top - 0.2, name)
    words(axes, 13.7, 0.7, "time $t$")
    words(axes, 0.75, 4.5, "$x_o$")
    times = [k / 20 for k in range(20 * PERIODS + 1)]
    line(axes, [(_across(t), 4.5 + _depth(t)) for t in times])
    line(axes, [(_across(t), 0.7 + _depth(t)) for t in times], GREY, dashes="--")
    stairs = [(_across(t), 0.7 + _depth(n)) for n in range(PERIODS) for t in (n, n + 1)]
    line(axes, [*stairs, (_across(PERIODS), 0.7)], WARM, width=2)
    for n in range(PERIODS + 1):
        line(axes, [(_across(n), 0.7), (_across(n), 4.5 + _depth(n))], GREY, width=0.6, dashes=":")
        axes.plot(_across(n), 4.5 + _depth(n), "o", color=COLD, markersize=6)
    arrow(axes, (_across(3), 4.15), (_across(4), 4.15), both=True, width=1.1)
    words(axes, _across(4) + 0.12, 4.17, "$T$", at="left")
    words(axes, _across(2) - 0.15, 6.2, "sample $x(n)$", at="right")
    words(axes, _across(7) + 0.2, 6.75, "handle $x(t)$", at="left")
    line(axes, [(10.7, 3.4), (11.2, 3.4)], WARM, width=2)
    words(axes, 11.35, 3.4, "held by the motor", at="left", size=9.5)
    line(axes, [(10.7, 2.8), (11.2, 2.8)], GREY, dashes="--")
    words(axes, 11.35, 2.8, "ideal spring", at="left", size=9.5)
    return figure


def _across(periods):
    return BEGIN + STEP * periods


def _depth(periods):
    """Return the depth in the wall after so many periods, drawn larger than life."""
    return 2.5 * math.sin(math.pi * periods / PERIODS)
