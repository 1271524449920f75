"""What the text of lab 04 says of the paddle in use, and how it is seen in the solved notebook."""

MISSES = "misses the truth"


def _above_the_onset(lab):
    """Return (run, interval of the amplitude [mm], frequency [Hz]) of the runs above the onset, the nearest first."""
    return list(lab.cycles.values())[1:]


CLAIMS = [
    (
        "An interval of 95 % contains the true value in 95 of 100 such experiments",
        lambda lab: lab.secret.b in lab.twin["b"] and lab.secret.coulomb in lab.twin["coulomb"],
        MISSES,
    ),
    ("with 80 % the handle coasts 5 times as far", lambda lab: 4.5 < lab.factors[0.8] <= 5, ""),
    ("Below the onset the handle comes to rest", lambda lab: next(iter(lab.cycles.values()))[0].amplitude == 0, ""),
    (
        "Well above it, the oscillation has the amplitude and the frequency of the theory",
        lambda lab: all(
            0.97 * size.low < 1e3 * run.amplitude < 1.03 * size.high and abs(hertz / run.frequency - 1) < 0.03
            for run, size, hertz in _above_the_onset(lab)[1:]
        ),
        "",
    ),
    (
        "so the cycle is slower",
        lambda lab: _above_the_onset(lab)[0][0].frequency < _above_the_onset(lab)[0][2],
        "",
    ),
    (
        "natural frequency of handle and finger, because the law's force is late",
        lambda lab: all(run.frequency < (lab.limit.k / lab.limit.m) ** 0.5 / 6.2832 for run, *_ in _above_the_onset(lab)),
        "",
    ),
    ("With the lower ends the handle slows down", lambda lab: lab.speeds["low"] < 0.3, MISSES),
    ("with the upper ends it accelerates", lambda lab: lab.speeds["high"] > 0.3, MISSES),
    (
        "A paddle with a fifth of the friction and no compensation would coast as far and allow as stiff a wall",
        lambda lab: 0.19 < lab.K_everywhere / lab.K_alone < 0.22,
        "",
    ),
    ("With $B$ everywhere the worst motion gains energy", lambda lab: lab.worst["everywhere"].found, ""),
    (
        "With $B$ in free air only, no such motion was found at the same stiffness, and in no light hand",
        lambda lab: not lab.worst["in free air only"].found and lab.grown["in free air only"] == [0, 0, 0],
        "",
    ),
]
