"""Statements of lab 12 about the paddle in use, whether they hold, and what is printed where they do not."""


def figures(lab, kit):
    """Return the measured designs of a kit, by task."""
    return {name: found for (name, of), found in lab.found.items() if of == kit}


def _load(lab, name):
    return lab.hl.design.measured(lab.on_mine, {"T": lab.my_paddle.T, **lab.designs[name]}).load


def _margins(lab):
    return [(figures(lab, "yours")[name].margin, figures(lab, "textbook")[name].margin) for name in lab.chosen]


CLAIMS = [
    (
        "The design with the smaller passivity margin swings more",
        lambda lab: (lab.swing[lab.rk4] >= 1.2 * lab.swing[lab.euler]) and lab.margin[lab.rk4] < lab.margin[lab.euler],
        "stops a swing of this size",
    ),
    (
        "semi-implicit Euler, which costs half as much",
        lambda lab: 0.4 < _load(lab, lab.euler) / _load(lab, lab.rk4) < 0.6,
        "",
    ),
    ("Four evaluations at 1 kHz cost less than one evaluation at 4 kHz", lambda lab: lab.loads[0] < lab.loads[1], ""),
    (
        "The load does not depend on the paddle",
        lambda lab: all(figures(lab, "yours")[n].load == figures(lab, "textbook")[n].load for n in lab.chosen),
        "",
    ),
    (
        "The margin follows the damping of the paddle and its delay",
        lambda lab: all(mine < textbook for mine, textbook in _margins(lab)) == (lab.my_paddle.b < lab.hl.design.textbook.b),
        "",
    ),
    (
        "The floor of the sensor of the wall follows the encoder",
        lambda lab: (
            (figures(lab, "yours")["wall"].sensor_floor > figures(lab, "textbook")["wall"].sensor_floor)
            == (lab.my_paddle.counts_per_metre < lab.hl.design.textbook.counts_per_metre)
        ),
        "",
    ),
    (
        "Your three designs were chosen for the textbook kit",
        lambda lab: all(f.feasible for f in figures(lab, "textbook").values()),
        "",
    ),
]
