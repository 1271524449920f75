"""What lab 10 says of the paddle in use; see tests/labs/test_on_paddles.py."""

import numpy as np

import hapticlab as hl


def is_calm(lab):
    """The stiffest wall of the sliders, pressed by a pinch, comes to rest."""
    hand = hl.Hand("pinch", push=1.0)
    log = hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=hand).run(hl.wall()(k=lab.stiffest), duration=4.0, v=0.1)
    return hl.chatter(log).contacts_per_second == 0


def is_within_the_motor(lab):
    """The walls of the last measurement leave the motor room, so that what they feel like is their stiffness."""
    shown = lab.task.present(lab.task.on(lab.paddle), 1.23 * lab.task.standard)
    return max(shown.F) < lab.my_paddle.force_max


def top_is_the_estimate(lab):
    own = 100 * np.expm1(lab.tried[np.argmax(lab.L)])
    return abs(own / lab.weber - 1) < 0.05


def all_change_together(lab):
    slope, force, depth = lab.change
    return abs(slope - 23) < 2 and 5 < force < 23 and -20 < depth < -1


def adds_the_same(lab):
    """Of 2b/T at three periods, each step is ln 2/ln 1.23; with a delay the paddle has fewer walls."""
    count = [lab.steps_between(20, 2 * lab.my_paddle.b / (lab.my_paddle.T / k), 0.23) for k in (1, 2, 4)]
    fewer = lab.guaranteed <= 2 * lab.my_paddle.b / (lab.my_paddle.T + 2 * lab.my_paddle.delay) * 1.000001
    return fewer and np.allclose(np.diff(count), np.log(2) / np.log(1.23))


CLAIMS = [
    ("Press into both walls, and compare them", is_calm, ""),
    (
        "because a stiff wall stops the handle while the pointer moves on",
        lambda lab: 0 < lab.pressed.x.max() - 0.005 < -lab.pressed.x.min() - 0.005,
        "",
    ),
    ("meets the standard and a wall that is 23 % stiffer", is_within_the_motor, ""),
    ("If nobody answers, a simulated observer with $w$ = 23 % does", lambda lab: lab.low <= 23 <= lab.high, ""),
    ("The top of your curve is the estimate", top_is_the_estimate, ""),
    ("The slope and the force increase, and the depth decreases", all_change_together, ""),
    ("adds only the same number of new walls", adds_the_same, ""),
]
