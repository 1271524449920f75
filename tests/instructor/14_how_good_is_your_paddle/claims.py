"""What lab 14 says of the paddle in use."""

CLAIMS = [
    (
        "At the second damping, where a count moves the force by only 0.02 N, the filter widens nothing.",
        lambda lab: lab.filtered.K[1] <= 1.15 * lab.backward.K[1],
        "",
    ),
    (
        "At the third damping, where a count moves the force by 0.07 N, the filter widens the Z-width.",
        lambda lab: lab.filtered.K[2] > 1.15 * lab.backward.K[2],
        "dry friction",
    ),
    (
        "The smaller of the last two is what you can expect in this grip",
        lambda lab: 0.75 < min(lab.at_zero) / min(lab.stable, lab.one_count) < 1.25,
        "both borders may lie higher than predicted",
    ),
    (
        "The measured border lies somewhat below the exact one",
        lambda lab: all(0.7 < ratio <= 1.02 for ratio in lab.ratios.values()),
        "Measured above exact",
    ),
    (
        "The damping is *negative*, and its amount is the same as the product that is printed above.",
        lambda lab: abs(lab.lost / (lab.K_wall * lab.late) - 1) < 0.15,
        "",
    ),
    (
        "about nothing is left: at the limit of Eq. (23.10)",
        lambda lab: abs(lab.b - lab.lost) < 0.2 * lab.b,
        "",
    ),
    (
        "At low frequencies the stiffness is almost exact.",
        lambda lab: all(abs(lab.shaken.stiffness[lab.slow] / lab.K_wall - 1) < 0.05),
        "",
    ),
    (
        "the damping is outside already at the lowest ones",
        lambda lab: all(lab.b + lab.Z.real[:4] < (1 - 0.34) * lab.b),
        "",
    ),
    (
        "Up to the frequency that is printed above, your paddle renders this wall as an ideal one",
        lambda lab: 5 < lab.same_up_to(lab.f, lab.off, 0.23) < 200,
        "",
    ),
    (
        "A virtual damper makes walls possible that are stiffer than the stiffest plain spring",
        lambda lab: lab.mine.stiffest[0] > min(lab.at_zero),
        "",
    ),
    (
        "with $B > b$, Eq. (23.10) guarantees nothing at all",
        lambda lab: lab.mine.stiffest[1] > lab.b,
        "",
    ),
]
