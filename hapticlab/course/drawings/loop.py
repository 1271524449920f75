"""The loop of sensor, computer and motor, and who pushes whom, Fig. 23.5."""

from .pen import COLD, GREY, INK, WARM, arrow, box, line, sheet, words

TITLE = "The loop, once per period T"
ALT = (
    "A loop of four boxes. The hand pushes the handle with F_h. The sensor reads the position of the handle, x, and gives the "
    "computer the sample x(n). The computer runs the scene and computes F_e(n), the force on the environment. The motor "
    "holds minus F_e(n), for one period T, and applies it to the handle. The paddle is real: hand, handle, sensor and "
    "motor. The environment exists in the computer only."
)


def draw():
    """Draw hand and handle on the left, the computer on the right, sensor above and motor below."""
    figure, axes = sheet(7.2, 3.2, (0, 14.4), (0, 6.4))
    for left, bottom, width, text in (
        (0.3, 2.6, 1.8, "hand"),
        (4.0, 2.6, 2.0, "handle"),
        (6.6, 4.9, 2.2, "sensor"),
        (6.6, 0.3, 2.2, "motor"),
    ):
        box(axes, left, bottom, width, 1.2)
        words(axes, left + width / 2, bottom + 0.6, text, bold=True)
    box(axes, 10.2, 2.1, 3.9, 2.2, fill=COLD)
    words(axes, 12.15, 3.65, "computer", bold=True)
    words(axes, 12.15, 2.8, "runs the scene\n(the environment)", size=9.5)
    arrow(axes, (2.1, 3.2), (4.0, 3.2), INK)
    words(axes, 3.05, 3.6, "$F_h$")
    _corner(axes, [(5.0, 3.8), (5.0, 5.5), (6.6, 5.5)], INK)
    words(axes, 4.8, 4.9, "position $x$", at="right")
    _corner(axes, [(8.8, 5.5), (12.15, 5.5), (12.15, 4.3)], COLD)
    words(axes, 10.5, 5.85, "sample $x(n)$")
    _corner(axes, [(12.15, 2.1), (12.15, 0.9), (8.8, 0.9)], COLD)
    words(axes, 9.9, 0.5, "force on the environment $F_e(n)$", at="left", size=9.5)
    _corner(axes, [(6.6, 0.9), (5.0, 0.9), (5.0, 2.6)], WARM)
    words(axes, 4.8, 1.5, "$-F_e(n)$ on the handle,\nheld for one period $T$", at="right")
    line(axes, [(9.5, 0.1), (9.5, 6.2)], GREY, dashes=":")
    words(axes, 9.35, 4.6, "real", at="right", size=9.5)
    words(axes, 9.65, 4.6, "virtual", at="left", size=9.5)
    return figure


def _corner(axes, points, colour):
    """Draw a line round a corner that ends in an arrow."""
    line(axes, points[:-1], colour)
    arrow(axes, points[-2], points[-1], colour)
