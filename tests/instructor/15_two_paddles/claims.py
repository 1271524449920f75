"""What lab 15 says of the paddle in use: words of its text, whether they hold, and what it prints where they do not."""

FRICTION = "dry friction"


def feels(lab, partner, architecture):
    """The stiffness [N/m] and the damping [N s/m] that were felt."""
    return lab.measured[partner][architecture]


CLAIMS = [
    (
        "**Your rule is good where the delay is short.**",
        lambda lab: abs(lab.yours[0.005] / lab.exact[0.005] - 1) < 0.2,
        "",
    ),
    (
        "**At long delays the exact limit does not fall any further.**",
        lambda lab: lab.exact[0.2] > 0.75 * lab.exact[0.05] and lab.exact[0.2] > 5 * lab.yours[0.2],
        "",
    ),
    ("It does so where", lambda lab: 0.8 < lab.exact[0.2] / lab.floor < 1.15, ""),
    (
        "**In every pair of hands only a very soft spring is safe**",
        lambda lab: all(0 < lab.any_hand[d] < 0.15 * lab.exact[d] for d in lab.exact),
        "",
    ),
    (
        "**After 100 ms of silence the force is zero.**",
        lambda lab: abs(lab.alone.F[lab.alone.t > 0.101]).max() == 0 and abs(lab.alone.F).max() > 0.1,
        "",
    ),
    (
        "**The fitted limits agree with the exact ones.**",
        lambda lab: all(abs(lab.fitted[d] / lab.exact[d] - 1) < 0.05 for d in lab.fitted) and lab.rates[0.05][1] > 0,
        FRICTION,
    ),
    (
        "**The late spring generates energy.**",
        lambda lab: lab.least["position-position"] < -0.5,
        "",
    ),
    (
        "**The controller and the waves generate less than a fifth of that energy, or none.**",
        lambda lab: min(lab.least["waves"], lab.least["with a controller"]) > 0.2 * lab.least["position-position"],
        "too coarse",
    ),
    (
        "**Position-position adds the damper $2kd$ in free motion, and position-force adds none.**",
        lambda lab: (
            abs(feels(lab, "free", "position-position")[1] / (2 * 40 * 0.05) - 1) < 0.15
            and abs(feels(lab, "free", "position-force")[1]) < 0.2
        ),
        "",
    ),
    (
        "**position-force feels a negative damper in contact.**",
        lambda lab: -3.5 < feels(lab, "firm", "position-force")[1] < -2.5,
        "",
    ),
    (
        "**The waves feel soft in contact**",
        lambda lab: feels(lab, "firm", "wave")[0] < 0.5 * feels(lab, "firm", "position-position")[0],
        "",
    ),
    (
        "In free motion they add little here",
        lambda lab: abs(feels(lab, "free", "wave")[0]) < 3 and abs(feels(lab, "free", "wave")[1]) < 0.4,
        "",
    ),
]
