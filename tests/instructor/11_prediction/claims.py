"""What lab 11 says of the paddle in use: words of its text, whether they hold, and what it prints where they do not."""

FRICTION = "dry friction"


def chatters(lab, law):
    """Whether the handle still moves by more than ten counts at twice the limit."""
    return lab.moves[law] > 10e3 * lab.count


CLAIMS = [
    ("The handle chatters under Eq. (23.1).", lambda lab: chatters(lab, "Eq. (23.1)"), FRICTION),
    ("**Half a period ahead is not enough**", lambda lab: chatters(lab, "Eq. (23.5)"), FRICTION),
    ("At your $s$ a few counts are left at most.", lambda lab: lab.moves["your s"] < 8e3 * lab.count, ""),
    (
        "**On a paddle with an encoder the factor of forty is gone**",
        lambda lab: 0 < lab.factor < 5,
        "",
    ),
    (
        "one count is worth $1 + 2s$ counts of the plain wall",
        lambda lab: abs(lab.swings["no filter"] / (1 + 2 * lab.derived) - 1) < 0.15,
        FRICTION,
    ),
    (
        "**A filter makes a count matter less, and the longest filter brings the chatter back**",
        lambda lab: (
            lab.swings["no filter"] > lab.swings["one period"] > lab.swings["four periods"]
            and lab.motion["four periods"] > 10e3 * lab.count
        ),
        FRICTION,
    ),
    (
        "**One count costs a noticeable share of the motor's force.**",
        lambda lab: lab.gains.count > 0.05 * lab.gains.force_max,
        "",
    ),
    (
        "**On average, the law with a model generates less than a tenth of the energy that the plain law generates**",
        lambda lab: abs(lab.met["predictive"].generated) < 0.1 * lab.met["zoh"].generated,
        "",
    ),
]
