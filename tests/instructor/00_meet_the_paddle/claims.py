"""What lab 00 says of the paddle in use; see tests/labs/test_on_paddles.py."""

import numpy as np

import hapticlab as hl


def comes_to_rest(lab):
    """With every setting of the slider a steady hand moves by no more than a count."""
    hand = hl.Hand("pinch", intent=lab.intent)
    held = hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=hand)
    ends = [held.run(lab.spring(k=k), duration=4.0).x[-200:] for k in (60, 300, lab.stiffest)]
    return all(np.ptp(x) < 1.5 / lab.my_paddle.counts_per_metre for x in ends)


def before_the_ring(lab):
    """A hand that aims 20 mm to the right is stopped by the first wall, which begins at 10 mm."""
    hand = hl.Hand("pinch", intent=hl.people.MinimumJerk(end=0.02, duration=1.0))
    log = hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=hand).run(hl.wall()(k=300, x_o=0.01), duration=2.0)
    return 0.01 < log.x[-1] < 0.016 and log.F[-1] > 0.5


def pinch(lab):
    return lab.runs["pinch, 200 N/m"]


def grip(lab):
    return lab.runs["firm grip, 2000 N/m"]


def balances(lab):
    return abs(2000 * (0.015 - grip(lab).x_true[-1]) - lab.my_paddle.force_max) < 0.1


def saturates(lab):
    """The force grows up to the reach that the limits give, and stays there."""
    run, full = grip(lab), lab.my_paddle.force_max
    reach = lab.limits(300, 1 / lab.my_paddle.counts_per_metre, full, lab.my_paddle.T)["reach"]
    return run.x[-1] > reach and abs(run.x[run.F < full].max() - reach) < 0.2e-3


def same_stiffness(lab):
    paddle = hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=hl.Hand("pinch"))
    log = hl.live(paddle, lab.spring(k=300)).rehearsal
    return abs(lab.felt_stiffness(log.x, log.F) / 300 - 1) < 1e-3


def agrees_with_its_drive(lab):
    """One count and the force at full duty are those of the profile, to a percent, and the largest force asked is too much."""
    drive, profile = lab.drive, lab.my_paddle
    count = abs(drive.metres_per_count * profile.counts_per_metre - 1) < 0.01
    return count and abs(drive.force_full / profile.force_full - 1) < 0.01 and lab.currents[-1] == drive.current_full


CLAIMS = [
    ("what one count and the largest current give at the handle", agrees_with_its_drive, "does not know its whole drive"),
    ("The handle stops before it reaches the ring, because the wall pushes back", before_the_ring, ""),
    (
        'Each line that is not "ok" ends with what to do',
        lambda lab: f" T = {1e3 * lab.my_paddle.T:g} ms," in lab.printed and " 0 samples lost" in lab.printed,
        "",
    ),
    ("Where does the handle come to rest", comes_to_rest, ""),
    ("Fit $F = k x$ through the origin", same_stiffness, ""),
    ("In the pinch the handle stops near 6 mm", lambda lab: abs(pinch(lab).x[-1] - 6e-3) < 0.2e-3, ""),
    ("The hand feels about 1.8 N", lambda lab: abs(pinch(lab).F[-1] - 1.8) < 0.05, ""),
    ("balances the largest force of the motor", balances, "is more than the grip needs"),
    ('your reach the "spring" exerts a constant force', saturates, "is more than the grip needs"),
]
