"""What a run left out: a ball thrown to and fro between two walls, several times a period, against its closed form."""

import warnings

import numpy as np
import pytest

import hapticlab as hl
from hapticlab import t
from hapticlab.base.missed_events import missed_words
from hapticlab.errors import MissedEventWarning

START, SPEED, ROOM, T = 2e-3, 30.0, 10e-3, 1e-3  # three walls are met in every period
PADDLE = hl.SimulatedPaddle(m=0.05, b=0.5, T=T)
FEW, ENOUGH = hl.methods.Taylor(events=2), hl.methods.Taylor(events=4)


def thrown():
    h = hl.coordinate("h", unit="m", initial=START, rate=SPEED)
    m, W, K = hl.parameters("m W K", units="kg m N/m", values=(0.05, ROOM, 0.0))
    walls = [hl.contact.Contact(gap, hl.contact.impulse(e=1), name=name) for gap, name in ((h, "floor"), (W - h, "roof"))]
    return hl.Scene(force=K * h, eom=[hl.mechanics.lagrange(m * h.diff(t) ** 2 / 2, contacts=walls)], watch=[h], name="thrown")


def between(times):
    """Where the ball is: a triangle wave."""
    way = (START + SPEED * times) % (2 * ROOM)
    return np.where(way < ROOM, way, 2 * ROOM - way)


def quiet(scene, method, duration=0.03):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MissedEventWarning)
        return PADDLE.run(scene, duration, method=method)


def test_a_run_that_left_events_out_warns_and_says_so_where_it_prints():
    words = (
        r"30 of 30 samples left an event unlocated, the first at t = 0 s\. From t = 0 s bodies overlapped, "
        r".*Taylor\(events=8\), .*penalty"
    )
    with pytest.warns(MissedEventWarning, match=words) as told:
        log = PADDLE.run(thrown(), 0.03, method=FEW)
    assert log.fault is None and told[0].filename == __file__
    assert "not located in 30 of them" in str(log) and f"at the end bodies overlap by {1e3 * log.overlap[-1]:.3g} mm" in str(log)


def test_with_enough_events_nothing_is_told_and_the_ball_is_where_it_must_be():
    log = PADDLE.run(thrown(), 0.03, method=ENOUGH)  # a warning would be an error
    np.testing.assert_allclose(log.h, between(log.t), rtol=0, atol=1e-7)
    assert missed_words(log) == "" and "inside" not in str(log) and log.overlap.max() < 1e-8


def test_the_overlap_of_a_period_is_how_far_the_ball_is_past_a_wall_at_its_end():
    log = quiet(thrown(), FEW)
    past = np.maximum(np.maximum(-log.h, log.h - ROOM), 0.0)
    assert past.max() > 5e-3
    np.testing.assert_allclose(log.overlap[:-1], past[1:], rtol=0, atol=1e-8)


def test_bodies_that_end_inside_each_other_are_told_though_no_event_was_counted():
    still = {name: np.zeros(3) for name in ("x", "v", "F")}
    both = {"unlocated": np.zeros(3)}

    def log(overlap, unit="m"):
        channels = {**both, "overlap": overlap}
        return hl.records.Telemetry(t=np.arange(3) * T, **still, T=T, channels=channels, units={"overlap": unit})

    assert "From t = 0.001 s bodies overlapped, by 2 mm at most and by 0.5 mm at the end." in missed_words(log([0, 2e-3, 5e-4]))
    assert "by 0.02 rad at most" in missed_words(log([0, 0.02, 0.01], "rad"))
    assert missed_words(log([0, 1e-4, 0])) == "" == missed_words(log([0, np.nan, np.nan]))  # the handle jumps; a fault says more


def test_a_program_over_given_samples_and_a_sweep_tell_it_too():
    program = hl.compile(thrown(), FEW, T=T)
    with pytest.warns(MissedEventWarning, match="5 of 5 samples"):
        hl.records.evaluate(program, x=np.zeros(5))
    sweep = {"duration": 0.05, "metric": "peak_force", "x": 0.0, "b": [0.4, 0.5, 0.6]}
    with pytest.warns(MissedEventWarning, match="3 of 3 points left an event unlocated") as told:
        hl.sweep(thrown(), PADDLE, method=FEW, **sweep)
    assert told[0].filename == __file__
    hl.sweep(thrown(), PADDLE, method=ENOUGH, **sweep)
