"""What lab 01 says of the paddle in use; see tests/labs/test_on_paddles.py."""

import math

import numpy as np

import hapticlab as hl


def fitted(lab, true):
    """Return the k and b of a rehearsal, from the sensed or from the true motion."""
    paddle = hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=hl.Hand("pinch"))
    log = hl.live(paddle, lab.spring_damper(k=150, b=0.5)).rehearsal
    found = lab.spring_and_damper(*((log.x_true, log.v_true) if true else (log.x, log.v)), log.F)
    return np.array([found["k"] / 150, found["b"] / 0.5])


def forces(lab, **changes):
    """Return the largest force of the second difference, and the rms force when the hand rests [N]."""
    log = hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=lab.reach, **changes).run(lab.direct, duration=1.0)
    return max(abs(log.F)), log.F[log.t > 0.7].std()


def largest_force(lab, seconds):
    """Return the largest force of the mass on its coupler, moved by 10 mm in so many seconds [N]."""
    hand = hl.Hand("pinch", intent=hl.people.MinimumJerk(end=0.01, duration=seconds))
    return max(abs(hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=hand).run(lab.scene, duration=seconds + 0.5).F))


CLAIMS = [
    ("the fit returns the values that you set", lambda lab: np.all(abs(fitted(lab, true=False) - 1) < 1e-4), ""),
    ("hardly change", lambda lab: np.all(abs(fitted(lab, true=True) - 1) < 0.1), "counts of your encoder are so large"),
    ("The handle buzzes with the largest force of the motor", lambda lab: forces(lab)[0] >= lab.my_paddle.force_max, ""),
    ("it continues to buzz when the hand has come to rest", lambda lab: forces(lab)[1] > 0.5, ""),
    (
        "Without an encoder the same law runs without buzzing",
        lambda lab: forces(lab, counts_per_metre=None)[1] < 0.01,
        "makes the handle buzz without one as well",
    ),
    ("Move slowly: you feel nothing", lambda lab: largest_force(lab, 3.0) < 0.03, ""),
    ("Start and stop abruptly: you feel inertia", lambda lab: largest_force(lab, 0.05) > 0.3, ""),
    (
        "In a pinch the mass oscillates more slowly than with the handle still",
        lambda lab: lab.measured < 0.9 * math.sqrt(160 / 0.1) / (2 * math.pi),
        "keeps the handle nearly still",
    ),
    (
        "the handle and the finger move with the mass",
        lambda lab: abs(lab.measured / lab.slow - 1) < 0.05,
        "keeps the handle nearly still",
    ),
]
