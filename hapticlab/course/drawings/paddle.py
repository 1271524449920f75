"""The parts of a haptic paddle, not to scale."""

import math

from .pen import COLD, GREY, INK, WARM, arc, arrow, box, line, named, shape, sheet, words

TITLE = "A haptic paddle and its parts (not to scale)"
ALT = (
    "A haptic paddle from the side. The fingers hold the upper end of a handle that turns about a pivot. Their position x is "
    "counted along their arc, from the middle, to the right, between a left and a right stop. Below the pivot the handle "
    "ends in a wide sector. A drum on the shaft of the motor drives the rim of the sector. An encoder on the same shaft "
    "counts how far the shaft turns. A cable joins encoder and motor to the board, which reads the counts and drives the "
    "motor, and another cable joins the board to the computer."
)
PIVOT, TILT = (4.6, 4.6), 12
_SIDE = {118: "right", 90: "center", 62: "left"}


def draw():
    """Draw handle and sector about the pivot, drum, motor and encoder below, the board on the right."""
    figure, axes = sheet(7.2, 4.8, (0, 14.4), (0, 9.6))
    _handle(axes)
    drum = (PIVOT[0], 1.55)
    shape(axes, arc(drum, 0.95, 0, 360), GREY)
    shape(axes, arc(drum, 0.42, 0, 360), fill=WARM)
    shape(axes, arc(drum, 0.12, 0, 360), fill=INK)
    line(axes, [(0.8, 0.35), (13.6, 0.35)], width=2.5)
    box(axes, 9.3, 0.7, 2.7, 1.5, fill=COLD)
    words(axes, 10.65, 1.45, "board", bold=True)
    line(axes, [(5.55, 1.55), (9.3, 1.55)], GREY)
    line(axes, [(12.0, 1.45), (13.2, 1.45)], GREY)
    words(axes, 13.0, 2.55, "to the computer\n(USB)", size=9.5)
    named(axes, "handle", (7.3, 7.4), _turned(0, 3.0), at="left")
    words(axes, 7.38, 6.85, "the fingers hold it at the top", at="left", size=9.5)
    named(axes, "pivot", (7.3, 5.4), PIVOT, at="left")
    named(axes, "sector", (7.9, 3.9), _turned(1.5, -1.9), at="left")
    words(axes, 7.98, 3.35, "turns with the handle", at="left", size=9.5)
    named(axes, "drum", (2.1, 2.0), (drum[0] - 0.3, drum[1] + 0.2), at="right")
    named(axes, "motor", (2.1, 1.2), (drum[0] - 0.85, drum[1] - 0.3), at="right")
    named(axes, "encoder", (6.3, 2.35), (drum[0] + 0.08, drum[1]), at="left")
    words(axes, 8.2, 1.85, "counts", size=9.5)
    words(axes, 8.2, 1.25, "duty", size=9.5)
    return figure


def _handle(axes):
    """Draw the handle, tilted to the right, its sector, and the path of the fingers."""
    for side in (-1, 1):
        line(axes, arc(PIVOT, 3.9, 90, 90 + side * 28), GREY, width=1.0, dashes="--")
    arrow(axes, *arc(PIVOT, 4.35, 87, 69)[::60], INK)
    words(axes, *_polar(4.75, 77), "$x$")
    for angle, text in ((118, "left stop"), (90, "0"), (62, "right stop")):
        line(axes, [_polar(3.75, angle), _polar(4.05, angle)], GREY)
        words(axes, *_polar(4.35 if text == "0" else 4.3, angle), text, at=_SIDE[angle], size=9.5)
    bar = [_turned(-0.22, -0.1), _turned(-0.22, 3.9), _turned(0.22, 3.9), _turned(0.22, -0.1)]
    rim = arc(PIVOT, 2.63, 270 - 40 - TILT, 270 + 40 - TILT)
    shape(axes, [PIVOT, *rim], fill=GREY)
    shape(axes, bar, fill=INK)
    shape(axes, arc(PIVOT, 0.14, 0, 360), fill=INK)


def _turned(across, up):
    """Return a point of the handle, across and up from the pivot, after its tilt."""
    a = math.radians(-TILT)
    return PIVOT[0] + across * math.cos(a) - up * math.sin(a), PIVOT[1] + across * math.sin(a) + up * math.cos(a)


def _polar(radius, degrees):
    return PIVOT[0] + radius * math.cos(math.radians(degrees)), PIVOT[1] + radius * math.sin(math.radians(degrees))
