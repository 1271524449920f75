"""Anticipation is exact where the load is known; feedback is bounded by its reaction time, Section 23.3.3."""

import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.errors import PaddleError
from hapticlab.experiments.reaching import Load, follow, handle, inverse_dynamics, reach

FREE = hl.wall()(k=0, x_o=1)
PADDLE = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, hand=hl.Hand("grip"))
PINCH = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, hand=hl.Hand("pinch"))


def test_inverse_dynamics_solves_its_own_equation():
    # the equation of motion of hand and load under the intent, by scipy, follows the path
    from scipy.integrate import solve_ivp

    hand, load, path = hl.Hand(m=0.05, b=2.0, k=150.0), Load(m=0.2, b=0.5, k=40.0), hl.people.MinimumJerk(end=0.03, duration=0.5)
    times = np.arange(0, 1.0, 2e-4)
    intent = inverse_dynamics(hand, load, path, times)
    rates = np.gradient(intent, times, edge_order=2)

    def motion(t, state):
        push = hand.k * np.interp(t, times, intent) + hand.b * np.interp(t, times, rates)
        return state[1], (push - (hand.b + load.b) * state[1] - (hand.k + load.k) * state[0]) / (hand.m + load.m)

    found = solve_ivp(motion, (0, 0.99), (0.0, 0.0), t_eval=times[:4900], rtol=1e-8, atol=1e-10, max_step=1e-3).y[0]
    assert abs(found - path(times[:4900])).max() < 2e-7  # the intent's rate by differences over 0.2 ms


def test_a_known_load_is_led_to_the_target_and_another_is_not():
    known = reach(PINCH, FREE, end=0.02)
    assert known.error < 1e-7 and known.overshoot < 1e-5 and known.settled == pytest.approx(0.324, abs=0.002)
    suitcase = reach(PINCH, FREE, end=0.02, control=hl.people.Control(expects=Load(m=0.5, b=0.1)))
    assert suitcase.overshoot > 0.02 and suitcase.error > 1000 * known.error
    corrected = reach(
        PINCH, FREE, end=0.02, control=hl.people.Control(expects=Load(m=0.03, b=0.1, k=200.0), how="both"), record=6.0
    )
    alone = reach(PINCH, FREE, end=0.02, control=hl.people.Control(expects=Load(m=0.03, b=0.1, k=200.0)), record=6.0)
    assert abs(handle(alone.log)[-1] - 0.04) < 1e-4  # twice the spring was expected, and the hand goes twice as far
    assert abs(handle(corrected.log)[-1] - 0.02) < 1e-4 and alone.settled is None


@pytest.mark.parametrize("part", [0.95, 1.05])
def test_feedback_alone_is_stable_up_to_the_limit_of_a_delayed_integrator(part):
    # every 10 ms i[k+1] = i[k] + a (target - i[k-18]), stable for a < 2 sin(pi/(2 (2 18 + 1))) (Levin and May 1976)
    gain = part * 2 * math.sin(math.pi / 74) / 0.01
    log = reach(PADDLE, FREE, end=0.01, control=hl.people.Control(how="feedback", gain=gain), record=12.0).log
    error = abs(handle(log) - 0.01)
    ratio = error[10000:].max() / error[2000:4000].max()
    assert ratio < 0.7 if part < 1 else ratio > 1.5


def test_a_trill_is_anticipated_and_cannot_be_followed():
    trill = hl.methods.HandleMotion("trill", 0.005 * sp.sin(2 * sp.pi * 8 * hl.t), 2.0)
    errors = {}
    for how in ("anticipatory", "feedback"):
        log, wanted = follow(PADDLE, FREE, trill, control=hl.people.Control(how=how))
        errors[how] = np.std((handle(log) - wanted)[500:]) / np.std(wanted)
    # the reach starts with the velocity of the sine, which dies out; nothing of 8 Hz passes 180 ms of reaction
    assert errors["anticipatory"] < 1e-2 and errors["feedback"] > 0.95


def test_a_hand_without_a_spring_and_other_words_are_refused():
    with pytest.raises(PaddleError, match="reach needs a hand that holds the handle by a spring"):
        reach(hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3), FREE, end=0.02)
    with pytest.raises(PaddleError, match="how = 'blind'; needs one of anticipatory, feedback, both"):
        reach(PADDLE, FREE, end=0.02, control=hl.people.Control(how="blind"))
    with pytest.raises(PaddleError, match="end = 0 m"):
        reach(PADDLE, FREE, end=0)


def test_a_reach_prints_and_draws():
    found = reach(PADDLE, FREE, end=0.02)
    assert str(found).startswith("anticipatory: there after 0.32")
    assert [a.get_xlabel() for a in found.plot().axes] == ["time [s]"]


def test_boards_and_wrong_things_are_refused_in_words():
    with hl.connect("sim://hapkit", paddle=PADDLE) as board:
        for asker, call in {
            "reach": lambda: reach(board, FREE, end=0.02),
            "assistance": lambda: hl.people.assistance(board, [], hl.people.MinimumJerk(end=0.02, duration=0.5)),
            "juggle": lambda: hl.people.juggle(board),
            "fitts": lambda: hl.people.fitts(board),
            "compare_displays": lambda: hl.people.compare_displays(board, [300]),
        }.items():
            with pytest.raises(PaddleError, match=f"{asker} runs in simulation alone; needs hl.SimulatedPaddle"):
                call()
    with pytest.raises(PaddleError, match=r"m = -1 kg; a load needs m >= 0"):
        Load(m=-1)
    with pytest.raises(PaddleError, match="expects = 0.1; needs the load that the person expects,"):
        reach(PADDLE, FREE, end=0.02, control=hl.people.Control(expects=0.1))
    with pytest.raises(PaddleError, match="path = 3; needs a path of time"):
        follow(PADDLE, FREE, 3)


@pytest.mark.parametrize(
    ("at", "words"),
    [
        (lambda t: 0.01 * t, r"gave 2 parts of shapes \(\), \(\)\. It needs three arrays"),
        (lambda t: (0.01, 0.0, 0.0), r"gave 3 parts of shapes \(\), \(\), \(\)"),
        (lambda t: None, "gave TypeError: .*not iterable"),
        (lambda: (0.0, 0.0, 0.0), "gave TypeError: .*takes 0 positional arguments"),
        (0.01, "gave TypeError: 'float' object is not callable"),
        (lambda t: ("a", "b", "c"), "gave ValueError: could not convert string"),
    ],
)
def test_a_path_of_another_form_is_refused_with_the_form_it_needs(at, words):
    class Path:
        pass

    path = Path()
    path.at = at
    for call in (lambda: follow(PADDLE, FREE, path), lambda: hl.people.assistance(PADDLE, [], path)):
        with pytest.raises(PaddleError, match=f"path.at.times. at two times {words}"):
            call()
    with pytest.raises(PaddleError, match="MinimumJerk'>; needs a path of time"):
        follow(PADDLE, FREE, hl.people.MinimumJerk)
