"""What lab 16 says of the paddle in use."""


def loops_as_expected(lab):
    return all(abs(lab.areas[name] - lab.expected[name]) <= 1.01 * lab.late for name in ("A", "B", "pen"))


def opposite(lab):
    return lab.areas["A"] > lab.late and lab.areas["B"] < -lab.late


def a_few_samples_longer(lab):
    return 0 < lab.cycles[1.0] - lab.cycle_theory <= 4 * lab.T


def b_chatters(lab):
    return lab.clicks["B", 0] > 10 and lab.clicks["B", 0.3] > 10 and lab.clicks["B", 3] == 1


def as_a_spring(lab):
    needed = lab.stiff * (lab.T / 2 + lab.my_paddle.delay)
    return all(lab.worst[name].b_req <= 1.01 * needed and not lab.worst[name].found for name in ("A", "gear"))


CLAIMS = [
    ("**The rest agrees with your formula**", loops_as_expected, ""),
    ("The hand loses with A what it gains with B.", opposite, ""),
    ("over two presses they cancel.", lambda lab: abs(lab.areas["pen"]) < lab.late, ""),
    ("so its cycle is up to four samples longer than yours", a_few_samples_longer, ""),
    ("the relay switches on every two or three samples", lambda lab: 2 <= lab.cycles[0.0] / lab.T <= 3, ""),
    ("**A band of six counts is quiet, and no band at all is not.**", lambda lab: lab.flips[6] == 0 and lab.flips[0] > 10, ""),
    ("**Button A clicks once, with or without a band.", lambda lab: {lab.clicks["A", hops] for hops in (0, 0.3, 3)} == {1}, ""),
    ("Button B chatters until its band is wider than its hop,", b_chatters, ""),
    (
        "**A and the gear need no more damping than a spring**",
        as_a_spring,
        "",
    ),
    (
        "**B gives energy, and it needs more damping the slower the hand may be.**",
        lambda lab: lab.worst["B"].found and lab.worst["B, slower"].b_req > 1.5 * lab.worst["B"].b_req,
        "",
    ),
]
