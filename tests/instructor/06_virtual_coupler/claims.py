"""Statements of lab 06 about the paddle in use, whether they hold, and what is printed where they do not."""

import pytest


def _needed(lab):
    """The larger need of the scene's coupler, with the mean square of what its force is late by [N s/m]."""
    T = lab.my_paddle.T
    whole, part = divmod(lab.late / T, 1)
    square = T**2 * ((1 - part) * (whole + 0.5) ** 2 + part * (whole + 1.5) ** 2)
    return max(lab.formula, lab.K_scene**2 * square / (4 * 0.02))


CLAIMS = [
    (
        "It agrees with the formula $KT/2 + b_c$ unless another need",
        lambda lab: abs(lab.tick_needs / lab.formula - 1) < 0.02,
        "The tick needs more than the formula says",
    ),
    ("the tick needs about $K^2\\tau^2/(4 b_c)$", lambda lab: lab.tick_needs == pytest.approx(_needed(lab), rel=0.12), ""),
    (
        "the coupler is the stiffest object that this paddle can display",
        lambda lab: 0.99 < lab.felt_wall(K=lab.design.k_c, k=1e6) / lab.design.k_c < 1,
        "",
    ),
    ("the pendulum swings more slowly than $\\sqrt{g/l}$", lambda lab: lab.in_hand < 0.99 * lab.held_fast, ""),
    (
        "theory and measurement agree to half a percent",
        lambda lab: abs(lab.slower * lab.swing_frequency(l=0.15, g=9.81, M=0.05, m=0.05, K=lab.finger) / lab.in_hand - 1) < 0.005,
        "holds the handle as well",
    ),
    (
        "After you let go, the pendulum swings *faster*",
        lambda lab: lab.let_go > 1.1 * lab.held_fast,
        "holds the handle as well",
    ),
    (
        "The theory is that of small swings of a free carriage",
        lambda lab: abs(lab.on_rail / lab.let_go - 1) < 0.03,
        "holds the handle as well",
    ),
    ("A calm pendulum makes 0.1 to 0.2 N in the pinch", lambda lab: all(0.1 < force < 0.2 for force in lab.pinched[:4]), ""),
    (
        "At four times the design limit the free handle chatters",
        lambda lab: lab.set_free[4] > 1,
        "hide the difference",
    ),
    ("In the pinch the pendulum stays calm", lambda lab: lab.pinched[4] < 0.2, "hide the difference"),
]
