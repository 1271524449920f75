"""Statements of lab 07 about the paddle in use, whether they hold, and what is printed where they do not."""


def row(lab, method, hold, T):
    """Return a row of the comparison by its method, hold and period."""
    return next(one for one in lab.found.table if (one.method, one.hold, one.T) == (method, hold, T))


CLAIMS = [
    (
        "is stable only up to a fraction of the step that semi-implicit Euler (order 1) allows",
        lambda lab: lab.limits["midpoint"] < lab.limits["semi_implicit_euler"] / 3,
        "",
    ),
    ("RK4 allows a longer step than both", lambda lab: max(lab.limits, key=lab.limits.get) == "rk4", ""),
    (
        "the handle swings back and forth",
        lambda lab: lab.end_swing(lab.felt["forward Euler"]) > 1,
        "",
    ),
    (
        "the motor is at its limit",
        lambda lab: abs(lab.felt["forward Euler"].F).max() > 0.99 * (lab.my_paddle.force_max or 0),
        "",
    ),
    (
        "the mass feels like a mass",
        lambda lab: lab.end_swing(lab.felt["semi-implicit Euler"]) < lab.still,
        "",
    ),
    ("This is less than the damping that forward Euler needs", lambda lab: lab.calming < 0.8, ""),
    ("the better method is *worse*", lambda lab: lab.worse > 2, ""),
    ("the error of RK4 falls to a small fraction", lambda lab: lab.better > 20, ""),
    ("shows order 1 with", lambda lab: abs(lab.seen["rk4, zoh"] - 1) < 0.1, ""),
    (
        "is a lower limit for every method",
        lambda lab: all(
            held > sampled for held, sampled in zip(lab.errors["rk4, soh, held"], lab.errors["rk4, soh"], strict=True)
        ),
        "",
    ),
    (
        "is the most accurate row",
        lambda lab: (lab.best.method, lab.best.hold, lab.best.T) == ("rk4", "soh", lab.T),
        "",
    ),
    (
        "a paddle without delay needs the damping 0.5 N s/m",
        lambda lab: abs(row(lab, "semi_implicit_euler", "zoh", lab.T).b_req - 0.5) < 0.01,
        "responds late",
    ),
    (
        "the compiled programs need 1.2 N s/m or more",
        lambda lab: min(one.b_req for one in lab.found.table if one.T > lab.T) > 1.2,
        "",
    ),
    (
        "RK4 and Verlet need much more",
        lambda lab: all(
            row(lab, method, "zoh", T).b_req > 1.8 * row(lab, method, "soh", T).b_req
            for method in ("verlet", "rk4")
            for T in (lab.T, 2 * lab.T)
        ),
        "",
    ),
    ("no row is safe in *every* hand", lambda lab: min(one.b_req for one in lab.found.table) > lab.my_paddle.b, ""),
]
