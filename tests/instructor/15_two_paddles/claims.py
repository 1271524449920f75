"""What lab 15 says of the paddle in use: words of its text, whether they hold, and what it prints where they do not."""

FRICTION = "dry friction"


def damper(lab, partner, architecture):
    """The damper that was felt [N s/m]."""
    return lab.mine[partner][architecture][1]


CLAIMS = []
