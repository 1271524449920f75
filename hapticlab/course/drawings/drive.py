"""From the force at the handle to the current of the motor, and from the turn of its shaft to a count; not to scale."""

import math

from .pen import COLD, GREY, INK, WARM, arc, arrow, box, line, named, shape, sheet, words

TITLE = "The drive: motion to the sensor, force from the motor (not to scale)"
ALT = (
    "The drive of a paddle in three parts. On the left the handle turns about a pivot: the fingers are at the distance r_h above "
    "it, and feel the position x and the force F. Below the pivot the rim of the sector, of radius r_s, touches the drum on the "
    "shaft of the motor, of radius r_d, which turns by the angle theta with the torque tau. In the middle the sensor counts the "
    "turn of the shaft, and the motor makes the torque tau from the current i by the torque constant k_t. On the right the "
    "board reads the counts and gives the duty d to the amplifier, which drives the current through the motor."
)
PIVOT, DRUM = (3.0, 4.2), (3.0, 0.95)


def draw():
    """Draw handle, sector and drum on the left; sensor, motor, amplifier and board as boxes on the right."""
    figure, axes = sheet(7.2, 4.2, (0, 14.4), (0, 8.4))
    rim = arc(PIVOT, 2.6, 270 - 42, 270 + 42)
    shape(axes, [PIVOT, *rim], fill=GREY)
    shape(axes, arc(DRUM, 0.65, 0, 360), fill=WARM)
    shape(axes, arc(DRUM, 0.08, 0, 360), fill=INK)
    line(axes, [PIVOT, (PIVOT[0], 7.3)], width=4)
    shape(axes, arc(PIVOT, 0.12, 0, 360), fill=INK)
    line(axes, [PIVOT, _rim(238)], GREY, dashes=":")
    words(axes, 1.55, 3.25, "$r_s$")
    line(axes, [(2.2, 4.2), (2.2, 7.3)], GREY, dashes=":")
    words(axes, 1.85, 5.75, "$r_h$")
    line(axes, [DRUM, arc(DRUM, 0.65, -50, 0)[0]], GREY, dashes=":")
    words(axes, 3.85, 0.3, "$r_d$")
    arrow(axes, (3.1, 7.3), (4.5, 7.3), INK)
    words(axes, 4.6, 7.3, "$x$, $v$, $F$", at="left")
    words(axes, 3.35, 6.3, "handle", at="left", size=9.5)
    named(axes, "pivot", (4.1, 4.75), PIVOT, at="left")
    words(axes, 3.0, 2.7, "sector", size=9.5)
    turned = arc(DRUM, 0.9, 130, 225)  # the rim of the sector goes to the left where the fingers go to the right
    line(axes, turned[:-4], INK)
    arrow(axes, turned[-8], turned[-1], INK)
    words(axes, 1.9, 0.95, r"$\theta$, $\tau$", at="right")
    words(axes, 1.75, 0.35, "drum", at="right", size=9.5)
    for left, bottom, text, under in (
        (6.6, 5.2, "sensor", r"counts $\theta$"),
        (6.6, 2.2, "motor", r"$\tau = k_t\, i$"),
        (10.9, 2.2, "amplifier", "supply $V$"),
    ):
        box(axes, left, bottom, 2.6, 1.5)
        words(axes, left + 1.3, bottom + 1.0, text, bold=True)
        words(axes, left + 1.3, bottom + 0.45, under, size=9.5)
    box(axes, 10.9, 5.2, 2.6, 1.5, fill=COLD)
    words(axes, 12.2, 6.2, "board", bold=True)
    words(axes, 12.2, 5.65, "runs the scene", size=9.5)
    arrow(axes, (9.2, 5.95), (10.9, 5.95), COLD)
    words(axes, 10.05, 6.35, "counts", size=9.5)
    arrow(axes, (12.2, 5.2), (12.2, 3.7), COLD)
    words(axes, 12.35, 4.45, "duty $d$", at="left", size=9.5)
    arrow(axes, (10.9, 2.95), (9.2, 2.95), WARM)
    words(axes, 10.05, 3.35, "current $i$", size=9.5)
    line(axes, [DRUM, (5.6, DRUM[1]), (5.6, 5.95)], GREY, width=2.5)
    for height in (2.95, 5.95):
        line(axes, [(5.6, height), (6.6, height)], GREY, width=2.5)
    words(axes, 5.75, 4.45, "one shaft", at="left", size=9.5)
    return figure


def _rim(degrees):
    return PIVOT[0] + 2.6 * math.cos(math.radians(degrees)), PIVOT[1] + 2.6 * math.sin(math.radians(degrees))
