"""The sign convention on one card, Eq. (23.1) and Fig. 23.5."""

from .pen import COLD, GREY, INK, WARM, arrow, box, line, sheet, words

TITLE = "Signs: to the right is positive"
ALT = (
    "Sign convention. The handle is at x, inside a wall whose boundary x_o is to its left. Position x, velocity v and all "
    "forces are positive to the right. F_e acts on the environment and points to the right, into the wall. The motor stands "
    "for the wall and applies minus F_e to the handle, to the left. The hand pushes the handle with F_h, to the right."
)


def draw():
    """Draw a handle inside a wall, and the three forces as arrows."""
    figure, axes = sheet(6.4, 2.5, (-0.9, 11.9), (0, 5))
    box(axes, 5.2, 1.3, 6.5, 2.9, colour=GREY, fill=GREY)
    words(axes, 8.45, 0.95, "virtual wall (environment)")
    line(axes, [(5.2, 1.0), (5.2, 4.5)], dashes="--")
    words(axes, 5.2, 4.75, "$x_o$")
    box(axes, 6.2, 1.7, 0.7, 2.1, fill=INK)
    words(axes, 6.55, 4.5, "handle")
    arrow(axes, (3.2, 2.1), (6.2, 2.1), INK)
    words(axes, 3.05, 2.1, "hand on handle  $F_h$", at="right")
    arrow(axes, (6.2, 3.3), (3.2, 3.3), WARM, width=2.2)
    words(axes, 3.05, 3.3, "motor on handle  $-F_e$", at="right")
    arrow(axes, (6.9, 2.75), (8.2, 2.75), COLD, width=2.2)
    words(axes, 8.3, 2.75, "$F_e$  on environment", at="left")
    arrow(axes, (-0.6, 0.45), (1.2, 0.45))
    words(axes, 1.35, 0.45, "$x,\\ v$ and forces $> 0$", at="left")
    return figure
