"""Statements of lab 08 about the paddle in use, whether they hold, and what is printed where they do not."""

CLAIMS = [
    ("It rejects a contact of 4000 N/m for a ball of 30 g", lambda lab: lab.substeps > 1, ""),
    ("contacts last a little longer", lambda lab: 1 < lab.lasts / lab.free_lasts < 1.2, "do not show which of them is longer"),
    ("and go deeper", lambda lab: 1 < lab.deep / (lab.speed * lab.np.sqrt(lab.mu / 500)) < 1.2, ""),
    ("gravity has already slowed the ball", lambda lab: 0 < lab.yours["v"] - lab.ball_v < 0.05, ""),
    ("a large part of the impulse is lost", lambda lab: lab.given["1 ms"] < 0.7 * lab.lost, ""),
    ("With 5 ms all of it arrives", lambda lab: abs(lab.given["5 ms"] / lab.lost - 1) < 0.02, "clips both pulses"),
    ("it does so within a sample of $-9.81$", lambda lab: abs(lab.opens_at[4.0] + 9.81) < 0.2 * lab.T / 1e-3, ""),
    (
        "The juggler that ignores the ball keeps it best",
        lambda lab: lab.juggled_by["none"].error < lab.juggled_by["touch"].error,
        "",
    ),
]
