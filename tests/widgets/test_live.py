"""A scene on view: paced by a clock that is told, led by a hand, stopped with its last view. Nothing here sleeps."""

import base64
import re
import sys
import threading
import time
from xml.etree import ElementTree

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.device.simulated import stepping
from hapticlab.widgets.browser_view import _canvas
from hapticlab.widgets.frame import Frame
from hapticlab.widgets.pace import LONGEST
from hapticlab.widgets.session import A_CELL_RUNS, SILENCE, Session
from hapticlab.widgets.stage import NOTE
from hapticlab.widgets.status_words import chatter_words
from hapticlab.widgets.traces import Traces

T = 1e-3
PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand("pinch"))
WALL = hl.wall()(k=300, x_o=0.01)


class Stage:
    """A session whose clock, views and turns are the test's."""

    def __init__(self, paddle=PADDLE, scene=WALL, **given):
        self.now, self.frames = 50.0, []
        self.session = Session(paddle, scene, clock=lambda: self.now, in_thread=False, **given)
        self.session.connect(self.frames.append)

    def open(self):
        self.session.ready("page")
        self.session.turn()
        return self

    def go(self, seconds, step=1 / 60, pointer=None):
        """Take turns so many seconds of the clock, in which the page is there; return the frames of it."""
        until, first = self.now + seconds, len(self.frames)
        while self.now < until - 1e-9:
            self.now += step
            if pointer is not None:
                self.session.intend(pointer(self.now))
            self.session.alive("page")
            self.session.turn()
        return self.frames[first:]

    @property
    def rows(self):
        return np.concatenate([frame.rows for frame in self.frames if len(frame.rows)])

    @property
    def flags(self):
        return self.frames[-1].flags


def lead(now):
    return 0.02 * np.sin(4 * (now - 50))


# --- time


@pytest.mark.parametrize("step", [1 / 60, 0.0071, 0.0333])
def test_no_tick_is_lost_and_nothing_drifts(step):
    stage = Stage().open()
    stage.go(1.0, step)
    elapsed = stage.now - 50.0
    assert abs(stage.session.source.ticks - elapsed / T) <= 1
    assert np.allclose(np.diff(stage.rows[:, 0]), T, atol=1e-6)


def test_a_handle_let_go_that_leaves_is_caught_and_taken_where_it_is():
    stage = Stage(scene=hl.wall()(k=300, x_o=0.001)).open()
    stage.go(0.5, pointer=lambda now: 0.03)
    stage.session.hold(False)
    stage.go(1.0)
    assert stage.flags["held"] and "the hand holds it there" in stage.session.status
    assert stage.flags["wanted"] == -0.05  # where a hand goes
    stage.go(1.0)
    assert stage.rows[-1, 1] == pytest.approx(-0.05, abs=1e-4)  # it rests there: the hand's spring, and no wall


def test_where_a_hand_is_led_after_a_restart_counts_also_within_one_turn():
    stage = Stage().open()
    stage.session.intend(0.004)
    stage.session.press("restart")  # puts the hand at 0
    stage.session.intend(0.005)
    stage.go(0.1)
    assert stage.flags["wanted"] == 0.005


def test_where_a_hand_is_led_while_a_turn_catches_the_handle_counts(monkeypatch):
    stage = Stage(scene=hl.wall()(k=300, x_o=0.001)).open()
    stage.go(0.5, pointer=lambda now: 0.03)
    caught = stage.session.stage.advance

    def advance(wanted):
        held, rows = stage.session.motion.held, caught(wanted)
        if stage.session.motion.held and not held:
            stage.session.intend(0.002)  # as a page does, from another thread
        return rows

    monkeypatch.setattr(stage.session.stage, "advance", advance)
    stage.session.hold(False)
    stage.go(1.0)
    assert stage.flags["held"] and stage.flags["wanted"] == 0.002


def test_slow_motion_is_slow():
    stage = Stage(speed=0.1).open()
    stage.go(1.0)
    assert abs(stage.session.source.ticks - 100) <= 1
    stage.session.press("slow")  # ends it
    stage.go(1.0)
    assert abs(stage.session.source.ticks - 1100) <= 2


def test_a_view_that_begins_slower_than_slow_motion_is_slow():
    stage = Stage(speed=0.02).open()
    speeds = []
    for _ in range(2):
        stage.session.press("slow")
        stage.go(0.5)
        speeds.append(stage.flags["speed"])
    assert speeds == [1.0, 0.02] and stage.session.description()["slow"] == 0.02


def test_a_press_slows_time_down_also_that_of_a_replay():
    stage = Stage().open()
    stage.session.press("record")
    stage.go(1.0, pointer=lead)
    stage.session.press("slow")
    stage.go(1.0, pointer=lead)
    assert abs(stage.session.source.ticks - 1100) <= 2
    assert stage.flags["speed"] == 0.1 and stage.session.status.startswith("Running at 0.1 times real time")
    assert np.allclose(np.diff(stage.rows[:, 0]), T, atol=1e-6)  # no tick is lost
    stage.session.press("replay")
    stage.go(1.0)
    assert stage.flags["replaying"] and stage.frames[-1].time == pytest.approx(0.1, abs=0.003)
    stage.session.press("slow")
    stage.go(0.5)
    assert stage.frames[-1].time == pytest.approx(0.6, abs=0.02)


def test_a_scene_starts_again_from_its_first_state_with_the_values_of_now():
    """A ball at rest lies on the plate; started again it falls from the height that its slider says now."""
    scene = hl.library.ball_on_the_paddle()
    stage = Stage(scene=scene, method="taylor").open()
    late = {parameter["name"]: parameter["at_start"] for parameter in stage.session.description()["parameters"]}
    assert late["h"] and sum(late.values()) == 1
    stage.go(2.0, pointer=lambda now: 0.01)
    column = stage.session.description()["columns"].index("y")
    stage.session.move("h", 0.05)
    stage.go(0.2)
    assert stage.rows[-1, column] < 0.02  # a falling height of the past
    stage.session.hold(False)
    stage.go(0.05)
    stage.session.press("restart")
    *_, frame = stage.go(2 / 60)
    assert frame.rows[0, 0] == 0 and frame.rows[0, 1] == pytest.approx(0, abs=1e-5)
    assert frame.rows[0, column] == pytest.approx(0.05, abs=1e-4)
    assert frame.flags["held"] and frame.flags["running"] and frame.flags["wanted"] == 0  # the hand begins there too


def test_a_computer_that_falls_behind_makes_up_for_little_and_says_so():
    stage = Stage().open()
    stage.go(0.5)
    before = stage.session.source.ticks
    stage.now += 0.3
    stage.go(0.5)
    late = 0.3 + 1 / 60 - LONGEST
    assert abs(stage.session.source.ticks - before - (0.8 - late) / T) <= 2
    assert f"fell behind by {round(1e3 * late, -1):.0f} ms" in stage.session.status
    stage.go(1.1)
    assert "behind" not in stage.session.status


def test_a_scene_too_slow_for_the_computer_leaves_the_view_alive(monkeypatch):
    """Where a tick takes two periods of the clock, a turn computes for 20 ms at most, and the words say why it is slow."""
    stage, advance = Stage().open(), stepping.Stepping.advance

    def slowly(self, intent):
        stage.now += 2 * T * (len(intent) - 1)
        return advance(self, intent)

    monkeypatch.setattr(stepping.Stepping, "advance", slowly)
    frames = stage.go(2.0)
    late = [frame for frame in frames if frame.time > frames[-1].time - 0.3]
    assert max(np.diff([frame.time for frame in late])) < 0.013
    assert "too slow for this scene" in stage.session.status


def test_paused_time_stands_still_and_goes_on_where_it_was():
    stage = Stage().open()
    stage.go(0.5, pointer=lead)
    stage.session.press("pause")
    shown = stage.go(1.0)
    ticks = stage.session.source.ticks
    assert not stage.flags["running"]
    assert stage.session.status == "Paused."
    assert len(shown) <= 6  # a picture that rests is shown four times a second
    stage.session.press("resume")
    stage.go(0.5, pointer=lead)
    assert abs(stage.session.source.ticks - ticks - 500) <= 18
    assert np.allclose(np.diff(stage.rows[:, 0]), T, atol=1e-6)


# --- what the hand and the sliders do


def test_what_was_recorded_is_bit_for_bit_what_a_run_gives():
    """A hand whose intent is what the pointer said, sample for sample, feels the same on a paddle without a view."""
    stage = Stage(hl.SimulatedPaddle.from_profile("hapkit", delay=1.4e-3, hand=hl.Hand("grip")))
    stage.session.press("record")
    stage.open()
    stage.go(1.0, pointer=lead)
    log = stage.session.recorded()
    led = np.r_[log.intent, log.intent[-1]]  # the last sample's rate is seen one sample later

    def intent(t):
        return led[np.clip(np.round(np.asarray(t) / T).astype(int), 0, len(led) - 1)]

    alone = hl.SimulatedPaddle.from_profile("hapkit", delay=1.4e-3, hand=hl.Hand("grip", intent=intent))
    again = alone.run(WALL, duration=len(log) * T)
    assert len(log) > 950
    assert log.F.max() > 1
    for name in ("t", "x", "v", "F", "x_true", "F_applied"):
        assert np.array_equal(getattr(log, name), getattr(again, name)), name
    assert np.array_equal(hl.energy(log).W, hl.energy(again).W)


@pytest.mark.parametrize("delay", [0.0, 0.4e-3, 1e-3, 2.3e-3])
def test_the_energy_on_view_is_that_of_the_record(delay):
    stage = Stage(hl.SimulatedPaddle(m=0.05, b=0.1, T=T, delay=delay, hand=hl.Hand("pinch")))
    stage.session.press("record")
    stage.open()
    stage.go(0.7, pointer=lead)
    work = hl.energy(stage.session.recorded()).W
    shown = stage.rows
    at = np.round(shown[:, 0] / T).astype(int)
    assert abs(shown[:, 3]).max() > 1e-3
    assert np.allclose(shown[:, 3], -work[at], atol=1e-9)  # float32 of some mJ


def test_a_slider_moves_between_two_ticks_and_the_log_says_when():
    stage = Stage().open()
    stage.session.press("record")
    stage.go(0.2)
    stage.session.move("k", 450)
    stage.session.move(0, 0.5)  # B, by its number
    stage.go(0.2)
    log = stage.session.recorded()
    (since, moved), (again, also) = log.changes
    assert since == again
    assert {**moved, **also} == {"k": 450.0, "B": 0.5}
    assert abs(since - 0.2) < 0.02
    assert round(since / T, 6) == round(since / T)
    assert log.parameters["k"] == 300
    assert stage.flags["values"] == {"B": 0.5, "k": 450.0, "x_o": 0.01}


def test_a_slider_past_its_limit_is_refused_in_words_and_stays():
    stage = Stage().open()
    stage.session.move("k", -5)
    stage.go(0.1)
    assert "k = -5 N/m; a stiffness needs k >= 0" in stage.session.status
    assert stage.flags["values"]["k"] == 300
    assert stage.flags["running"]
    stage.now += NOTE - 0.5
    stage.go(1.0)
    assert "needs" not in stage.session.status


def test_the_handle_is_let_go_and_taken_again():
    stage = Stage().open()
    stage.go(0.5, pointer=lambda now: 0.005)
    stage.session.hold(False)
    stage.go(0.2)
    assert not stage.flags["held"]
    assert "let go" in stage.session.status
    assert np.isnan(stage.frames[-1].rows[-1, 4])
    place = stage.session.source.place
    stage.session.hold(True)
    (frame,) = stage.go(1 / 60, pointer=lambda now: 0.005)
    assert abs(frame.rows[0, 4] - place) < 1e-4  # it is taken where it is, and then led
    stage.go(1.0, pointer=lambda now: 0.005)
    assert abs(stage.session.source.place - 0.005) < 1e-5


def test_a_hand_is_no_faster_than_a_hand():
    stage = Stage(scene=hl.wall()(k=0, x_o=1.0)).open()
    stage.session.press("record")
    stage.go(0.3, pointer=lambda now: 0.04)
    assert np.max(np.abs(np.diff(stage.session.recorded().intent))) <= 1.0 * T * (1 + 1e-9)


# --- what is said


DAMPER = hl.Scene(force=hl.parameters("b", units="N*s/m", values=0.5) * hl.v(hl.n))


@pytest.mark.parametrize("scene", [hl.library.pendulum_on_the_handle(), hl.library.mass_spring_damper(), DAMPER])
@pytest.mark.always("scene[12]")
def test_nothing_is_said_to_be_touched_where_nothing_can_be(scene):
    stage = Stage(scene=scene).open()
    frames = stage.go(0.5, pointer=lead)
    assert np.abs(stage.rows[:, 2]).max() > 1e-3
    assert np.isnan(stage.rows[:, 5]).all() and not any("contact" in frame.status for frame in frames)


def test_contact_is_where_the_handle_is_inside_and_nowhere_else():
    stage = Stage(scene=hl.wall()(k=6000, x_o=0.0)).open()  # it chatters
    frames = stage.go(2.0, pointer=lambda now: 0.004)
    _, x, F, *_ = stage.rows.T
    touches = stage.rows[:, 5] == 1
    assert touches.any() and not touches[x < 0].any() and np.array_equal(touches, (x >= 0) & (F != 0))
    assert "in and out of contact" in frames[-1].status or "in and out" in stage.session.status


def test_what_a_scene_watches_has_a_column_and_a_unit():
    stage = Stage(scene=hl.library.cart_pole()).open()
    stage.session.press("record")
    stage.go(0.5, pointer=lead)
    about, log = stage.session.description(), stage.session.recorded()
    shown = {trace["name"]: (trace["unit_shown"], trace["scale"], trace["open"]) for trace in about["traces"]}
    assert shown["z"] == ("mm", 1e3, True) and shown["theta"] == ("rad", 1.0, False)
    at = np.round(stage.rows[:, 0] / T).astype(int)
    at, rows = at[at < len(log)], stage.rows[at < len(log)]
    assert np.array_equal(rows[:, about["columns"].index("theta")], log.theta[at].astype(np.float32))


def test_a_row_says_where_a_delayed_force_began_to_act():
    stage = Stage(hl.SimulatedPaddle(m=0.05, b=0.1, T=T, delay=4e-4, hand=hl.Hand("pinch"))).open()
    stage.session.press("record")
    stage.go(0.5, pointer=lead)
    about, log = stage.session.description(), stage.session.recorded()
    found = stage.rows[-100:, [about["columns"].index(name) for name in ("x_switch", "x_true")]]
    known = np.column_stack([log.x_switch, log.x])[-100:].astype(np.float32)
    assert np.array_equal(found, known) and not np.array_equal(found[:, 0], found[:, 1])


def test_a_frame_says_how_far_apart_the_samples_of_a_replayed_record_are():
    stage = Stage().open()
    stage.go(0.2)
    assert (stage.flags["T"], stage.flags["apart"]) == (T, T)
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=2e-4).run(WALL, duration=0.5, progress=False)
    stage.session.pressed("replay", log)
    rows = np.concatenate([frame.rows for frame in stage.go(0.2) if len(frame.rows)])
    assert stage.flags["T"] == 2e-4 and np.allclose(np.diff(rows[:, 0]), stage.flags["apart"], atol=1e-6)


def test_a_watched_channel_may_have_the_name_of_a_column_of_the_view():
    g = hl.parameters("g", units="1", values=2)
    k = hl.parameters("k", units="N/m", values=10)
    x = hl.x(hl.n)
    scene = hl.Scene(force=hl.when(x > 0, k * x, 0), watch={"E": 3 * g * x, "contact": g * x})
    stage = Stage(scene=scene)
    stage.session.press("record")
    stage.open()
    stage.go(0.5, pointer=lead)
    about, log, rows = stage.session.description(), stage.session.recorded(), stage.rows
    at = np.round(rows[:, 0] / T).astype(int)
    columns = dict(zip(about["columns"], rows.T, strict=True))  # no name twice
    assert len(columns) == rows.shape[1] == 11
    assert set(columns["contact"]) == {0.0, 1.0} and np.array_equal(columns["contact"] == 1, columns["F"] > 0)
    np.testing.assert_allclose(columns["E"], -hl.energy(log).W[at], atol=1e-9)
    np.testing.assert_allclose(log.E, 6 * log.x)
    shown = {trace["name"]: (trace["label"], trace["unit_shown"]) for trace in about["traces"]}
    watched = [name for name in shown if name not in ("x", "F", "E")]
    assert [shown[name] for name in watched] == [("E", "mm"), ("contact", "mm")] and shown["E"] == ("E drawn", "mJ")
    for name, slope in zip(watched, (6, 2), strict=True):
        np.testing.assert_allclose(columns[name], slope * columns["x"], rtol=1e-6, atol=1e-9)


def test_chatter_is_said_and_a_bounce_is_not():
    t = np.arange(1000) * T
    shaken = 4e-4 * np.sin(2 * np.pi * 41 * t)
    force = 1 + 100 * 4e-4 * np.sin(2 * np.pi * 41 * (t - T))  # a spring felt late: it gives energy
    absorbing = 1 + 100 * 4e-4 * np.sin(2 * np.pi * 41 * (t + T))
    assert chatter_words(shaken, force, T) == "Chatter: 0.4 mm at 41 Hz"
    assert chatter_words(shaken, absorbing, T) == "The handle vibrates: 0.4 mm at 41 Hz"
    assert chatter_words(0.02 * t + shaken, force, T) == "The handle vibrates: 0.4 mm at 41 Hz"
    assert chatter_words(4e-4 * np.exp(-9 * t) * np.sin(2 * np.pi * 41 * t), force, T) == ""
    assert chatter_words(0.02 * np.sin(2 * np.pi * 2 * t), force, T) == ""
    assert chatter_words(np.zeros(1000), force, T) == ""
    assert chatter_words(np.zeros(3), force[:3], T) == ""


def test_a_stiff_wall_is_said_to_chatter_at_the_frequency_of_the_record():
    stage = Stage(hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand("pinch")), hl.wall()(k=6000, x_o=0.01)).open()
    stage.go(1.0, pointer=lambda now: 0.014)
    stage.session.press("record")
    stage.go(1.5, pointer=lambda now: 0.014)
    found = hl.chatter(stage.session.recorded())
    assert found.locked
    assert f"at {found.frequency:.0f} Hz" in stage.session.status and stage.flags["vibrates"]
    stage.session.press("pause")
    stage.go(0.5)
    assert not stage.flags["vibrates"]


@pytest.mark.wide
def test_a_grating_that_a_hand_is_led_across_is_not_said_to_chatter():
    paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
    stage = Stage(paddle, hl.library.detents()).open()
    frames = stage.go(2.0, pointer=lambda now: 0.02 * np.sin(np.pi * (now - 50)))
    said = " ".join(frame.status for frame in frames)
    assert "vibrates" in said
    assert "Chatter" not in said


def test_a_handle_that_leaves_the_picture_is_told_and_run_begins_anew():
    """Beyond stability by far: T = 5 ms, k = 3000 N/m."""
    stage = Stage(hl.SimulatedPaddle(m=0.05, b=0.02, T=5e-3, hand=hl.Hand("pinch")), hl.wall()(k=3000, x_o=0.005)).open()
    stage.go(3.0, pointer=lambda now: 0.012)
    assert not stage.flags["running"]
    assert stage.session.status.startswith("Paused. The loop is unstable: the handle left the picture (x = ")
    low, high = stage.session.picture.reach
    assert high - low < max(low - stage.session.motion.place, stage.session.motion.place - high) < 10
    stage.session.move("k", 100)
    stage.session.press("resume")
    stage.go(0.5, pointer=lambda now: 0.012)
    assert stage.flags["running"]
    assert stage.session.motion.time < 0.6
    assert "picture" not in stage.session.status


def test_a_fault_stops_and_says_why_and_start_begins_anew():
    k, end = hl.parameters("k end", units="N/m^0.5 m", values=(1, "8 mm"))
    torn = hl.Scene(force=k * sp.sqrt(end - hl.x(hl.n)), name="torn")
    stage = Stage(scene=torn).open()
    stage.go(0.5, pointer=lambda now: 0.02)
    assert not stage.flags["running"]
    assert "the force F of torn was not finite" in stage.session.status
    stage.session.press("resume")
    stage.go(0.1, pointer=lambda now: 0.0)
    assert stage.flags["running"]
    assert "not finite" not in stage.session.status
    assert stage.frames[-1].time < 0.2


def test_a_motor_at_its_limit_is_said():
    stage = Stage(hl.SimulatedPaddle(m=0.05, b=0.1, T=T, force_max=0.5, hand=hl.Hand("pinch"))).open()
    stage.go(0.5, pointer=lambda now: 0.02)
    assert "The motor is at its limit" in stage.session.status
    stage.go(1.5, pointer=lambda now: 0.0)
    assert "limit" not in stage.session.status


def test_a_picture_that_cannot_be_drawn_stops_nothing(monkeypatch):
    stage = Stage().open()
    monkeypatch.setattr(stage.session.picture, "draw", lambda values: 1 / 0)
    stage.go(0.3)
    assert stage.frames[-1].picture == ()
    assert "picture cannot be drawn: ZeroDivisionError" in stage.session.status
    assert abs(stage.session.source.ticks - 300) < 20


def test_a_record_is_played_again_and_then_the_scene_goes_on():
    stage = Stage().open()
    stage.session.press("record")
    stage.go(0.5, pointer=lead)
    stage.session.press("stop")
    stage.go(0.1, pointer=lead)
    assert not stage.flags["recording"]
    log, ticks = stage.session.recorded(), stage.session.source.ticks
    stage.session.press("replay")
    played = stage.go(0.45)
    rows = np.concatenate([frame.rows for frame in played])
    assert played[-1].flags["replaying"]
    assert stage.session.source.ticks == ticks
    at = np.round(rows[:, 0] / T).astype(int)
    assert np.array_equal(rows[:, 1], log.x[at].astype(np.float32))
    stage.go(0.2)
    assert not stage.flags["replaying"]
    assert stage.session.source.ticks > ticks
    stage.session.press("replay")
    stage.go(0.1)
    stage.session.press("pause")  # ends it
    stage.go(0.1)
    assert not stage.flags["replaying"]
    assert stage.session.status == "Paused."


def test_a_replay_waits_while_nobody_looks_and_then_the_scene_goes_on():
    """Scrolled away: time passes, and neither the replay nor the scene. Asked for before anybody looked, it plays then."""
    log = PADDLE.run(WALL, duration=1.0, progress=False)
    stage = Stage()
    stage.session.pressed("replay", log)
    stage.now += 7.0
    stage.open()
    stage.go(0.3)
    assert stage.flags["replaying"] and stage.frames[-1].time == pytest.approx(0.3, abs=0.02)
    stage.session.gone("page")
    stage.session.turn()
    stage.now += 5.0
    stage.session.ready("page")
    stage.go(0.3)
    assert stage.flags["replaying"] and stage.frames[-1].time == pytest.approx(0.6, abs=0.03)
    assert stage.session.source.ticks == 0
    rows = stage.rows
    np.testing.assert_array_equal(rows[:, 1], log.x[: len(rows)].astype(np.float32))  # none lost, none twice
    stage.go(0.6)
    assert not stage.flags["replaying"] and stage.flags["running"] and stage.session.source.ticks > 50
    stage.session.pressed("replay", log)
    stage.session.gone("page")
    stage.session.turn()
    stage.session.ready("page")
    stage.session.press("pause")
    stage.go(0.2)
    assert stage.session.status == "Paused." and not stage.flags["running"]
    stage.session.pressed("replay", log)
    stage.session.end()
    assert not stage.session.motion.replaying


def test_a_replay_follows_parameters_that_were_changed():
    """The wall went from 10 mm to 0 while the hand stayed near 6 mm."""
    stage = Stage().open()
    stage.session.press("record")
    stage.go(0.3, pointer=lambda now: 0.006)
    stage.session.move("x_o", 0.0)
    stage.go(0.3)
    stage.session.press("stop")
    stage.session.move("x_o", 0.02)  # what the sliders say now is not what was
    stage.go(0.1)
    log, first = stage.session.recorded(), len(stage.frames)
    (since, _), *_ = log.changes
    stage.session.press("replay")
    drawn = []
    for _ in range(33):
        stage.go(1 / 60)
        drawn.append((stage.session.motion.time, stage.session.motion.values()["x_o"]))
    rows = np.concatenate([frame.rows for frame in stage.frames[first:]])
    at = np.round(rows[:, 0] / T).astype(int)
    wall = np.where(log.t < since - T / 2, 0.01, 0.0)[at]
    assert np.array_equal(rows[:, 5] == 1, (log.x[at] > wall) & (log.F[at] != 0)) and 0 < rows[:, 5].mean() < 1
    assert all(x_o == (0.01 if time < since - T / 2 else 0.0) for time, x_o in drawn)


def test_a_record_of_another_scene_is_played_and_stops_nothing():
    q = hl.parameters("q", units="N/m", values=10)
    other = PADDLE.run(hl.Scene(force=q * hl.x(hl.n)), duration=0.3, progress=False)
    stage = Stage().open()
    stage.go(0.1)
    stage.session.pressed("replay", other)
    frames = stage.go(0.2)
    rows = np.concatenate([frame.rows for frame in frames])
    assert stage.flags["replaying"] and stage.flags["running"] and np.isnan(rows[:, 5]).all()
    assert stage.session.status == "Replaying a record."


def test_to_replay_or_save_nothing_is_refused_in_words(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    stage = Stage().open()
    none = np.zeros(0)
    with pytest.raises(hl.errors.PaddleError, match="without samples"):
        hl.live(PADDLE, WALL).replay(hl.records.Telemetry(t=none, x=none, v=none, F=none, T=T))
    for press in ("replay", "save"):
        stage.session.press(press)
        stage.go(0.1)
        assert "nothing is recorded yet" in stage.session.status
    stage.session.press("record")
    stage.go(0.1)
    stage.session.press("save")
    stage.go(0.1)
    (saved,) = tmp_path.iterdir()
    assert saved.name in stage.session.status
    assert len(hl.records.Telemetry.load(saved)) >= 90


# --- who looks


def test_without_a_front_end_nothing_runs():
    before = set(threading.enumerate())
    view = hl.live(PADDLE, WALL)
    shown, _ = view._repr_mimebundle_()
    assert "not on view" in shown["text/plain"]
    assert set(threading.enumerate()) <= before
    assert view._session.source.ticks == 0


def test_without_any_widgets_it_is_text_that_says_what_to_install(monkeypatch):
    for missing in ("anywidget", "ipywidgets"):
        monkeypatch.setitem(sys.modules, missing, None)
    _canvas.cache_clear()
    shown, _ = hl.live(PADDLE, WALL)._repr_mimebundle_()
    assert list(shown) == ["text/plain", "text/html"]
    assert all("hapticlab[notebook]" in text for text in shown.values())
    image = re.search(r'<img alt="zoh wall: [^"]+" width="640" src="data:image/svg\+xml;base64,([^"]+)">', shown["text/html"])
    drawn = ElementTree.fromstring(base64.b64decode(image[1]))
    assert {"handle", "x_o"} <= {each.text for each in drawn.iter() if each.tag.endswith("text")}


def test_plain_widgets_are_taken_where_they_are_asked_for():
    pytest.importorskip("ipywidgets")
    front = hl.live(PADDLE, WALL, plain=True)
    shown, _ = front._repr_mimebundle_()
    assert type(front._front).__name__ == "VBox" and "still picture" in shown["text/html"]


def test_silence_and_the_last_view_stop_it_and_a_word_goes_on():
    stage = Stage().open()
    stage.go(0.2)
    stage.now += SILENCE + 0.1
    assert not stage.session.turn()
    ticks = stage.session.source.ticks
    assert not stage.session.turn()
    stage.session.alive("page")
    stage.go(0.2)
    assert 100 < stage.session.source.ticks - ticks < 250  # the silence is not made up for
    stage.session.ready("second")
    stage.session.gone("page")
    assert stage.session.turn()
    stage.session.gone("second")
    assert not stage.session.turn()


def test_a_silence_is_told_when_it_ends_a_view_and_when_it_is_over():
    stage = Stage().open()
    stage.go(0.2)
    stage.now += SILENCE + 0.1
    stage.session.turn()
    last = stage.frames[-1]
    assert last.status == "No word from the page for 2 s: time stood still."
    assert not last.flags["running"]
    assert len(last.picture)
    told = len(stage.frames)
    stage.now += 1.0
    stage.session.turn()
    assert len(stage.frames) == told
    assert stage.session.status.startswith("Not on view")
    stage.session.alive("page")
    stage.session.turn()
    assert "The notebook was silent for 3.1 s: time stood still" in stage.session.status
    assert stage.flags["running"]


def test_a_view_that_has_ended_says_so_and_runs_no_more():
    view = hl.live(PADDLE, WALL)
    view.start()
    assert view.status.startswith("Not on view")
    view.close()
    assert view.status == "This view has ended; run its cell again."
    for run in (view.start, view.resume, view.record):
        with pytest.raises(hl.errors.PaddleError, match="run its cell again"):
            run()


@pytest.mark.parametrize("where", ["flags", "words"])
def test_a_view_that_cannot_tell_ends_in_words(where, monkeypatch):
    stage = Stage().open()
    stage.go(0.1)
    monkeypatch.setattr(stage.session.stage, where, lambda: 1 / 0)
    stage.go(0.5)
    assert stage.frames[-1].status.startswith("This view has ended: ZeroDivisionError: division by zero")
    assert not stage.flags["running"]
    told = len(stage.frames)
    stage.go(0.5)
    assert len(stage.frames) == told
    assert "ZeroDivisionError" in stage.session.status


def test_what_waits_to_be_recorded_is_said_to_wait():
    stage = Stage().open()
    for press, words in (("record", "Recording."), ("pause", "Recording waits."), ("replay", "Recording waits.")):
        stage.session.press(press)
        stage.go(0.3)
        assert stage.session.status.endswith(words)


def test_numbers_too_large_for_a_row_are_cut(recwarn):
    samples = {"t": np.arange(3) * T, "x": np.zeros(3), "F": np.array([0.0, 1e200, -1e200])}
    assert np.isfinite(Traces(2 * T).add(samples)[:, :4]).all()
    assert not recwarn.list


def test_a_view_that_cannot_be_reached_is_gone():
    stage = Stage().open()

    def torn(frame):
        raise ConnectionError("no comm")

    stage.session.connect(torn)
    stage.go(1 / 60)
    assert not stage.session.on_view


def wait_for_frames(session, count, both):
    """Run a session until so many frames came; return them."""
    frames, enough = [], both.event()

    def sink(frame):
        frames.append(frame)
        session.alive("page")
        if len(frames) >= count:
            enough.set()

    session.connect(sink)
    session.ready("page")
    assert enough.wait(20)
    return frames


def test_its_turns_come_with_a_view_and_end_with_it(both):
    view = hl.live(PADDLE, WALL)
    frames = wait_for_frames(view._session, 5, both)
    assert all(isinstance(frame, Frame) and frame.rows.dtype == np.float32 for frame in frames)
    assert "kind" not in frames[0].flags
    session = view._session
    turns = session._turns
    session.connect(None)
    session.gone("page")
    assert turns.join(20)
    frames = wait_for_frames(session, 2, both)  # opened again
    turns = session._turns
    view.close()
    assert turns.join(20)
    assert frames[-1].status == "This view has ended; run its cell again."
    assert not frames[-1].flags["running"]
    session.alive("page")  # says a page that is still open
    assert session._turns is None


def test_a_view_that_nobody_keeps_ends_its_turns(both):
    view = hl.live(PADDLE, WALL)
    front = view._repr_mimebundle_()
    wait_for_frames(view._session, 2, both)
    turns = view._session._turns
    del view, front
    assert turns.join(20)


@pytest.mark.parametrize("both", ["threads"], indirect=True)
def test_many_threads_may_say_what_they_like(both):
    view = hl.live(PADDLE, WALL)
    session, failed = view._session, []

    def talk(k):
        try:
            for j in range(60):
                session.intend(0.001 * k)
                session.move("k", 100.0 + j)
                view.set(B=0.01 * j)
                session.press(("record", "stop", "pause", "resume")[j % 4])
                assert view.values["x_o"] == 0.01
                assert view.status
        except Exception as problem:
            failed.append(problem)

    talkers = [threading.Thread(target=talk, args=(k,)) for k in range(3)]
    for talker in talkers:
        talker.start()
    wait_for_frames(session, 3, both)
    for talker in talkers:
        talker.join(20)
    view.close()
    assert not failed


# --- where a page's words wait for the cell that runs, as in a browser


def test_without_threads_a_simulation_goes_on_while_a_cell_awaits_and_says_that_it_hears_nothing(one_thread):
    stage = Stage().open()
    stage.go(0.5)
    assert A_CELL_RUNS not in stage.session.status
    before = stage.session.source.ticks
    for _ in range(5 * 60):  # the cell lets turns through, and no word of the page
        stage.now += 1 / 60
        assert stage.session.turn()
    assert stage.session.source.ticks - before == pytest.approx(5 / T, abs=20)
    assert stage.session.status == "Running, not in contact. " + A_CELL_RUNS + "."
    stage.go(1 / 60)
    assert stage.session.status == "Running, not in contact."


def test_without_threads_a_turn_that_takes_long_is_no_cell(one_thread, monkeypatch):
    """As the first, which compiles: the page's words wait for it, and are heard soon after."""
    stage = Stage()
    monkeypatch.setattr(stage.session.source, "warm", lambda: setattr(stage, "now", stage.now + 3.0))
    stage.open()
    for _ in range(80):
        stage.now += 1 / 60
        stage.session.turn()
        assert "cell" not in stage.session.status
    for _ in range(20):
        stage.now += 1 / 60
        stage.session.turn()
    assert A_CELL_RUNS in stage.session.status


def test_without_threads_a_page_that_says_nothing_for_a_minute_is_gone(one_thread):
    stage = Stage().open()
    stage.go(0.2)
    for _ in range(61 * 4):
        stage.now += 1 / 4
        looks = stage.session.turn()
    assert not looks and stage.frames[-1].status == "No word from the page for 60 s: time stood still."


def test_without_threads_a_cell_that_computed_is_told_and_its_time_is_not_made_up_for(one_thread):
    stage = Stage().open()
    stage.go(0.5)
    before = stage.session.source.ticks
    stage.now += 5.0  # no turn comes
    stage.go(0.1)
    assert stage.session.source.ticks - before <= 110
    assert "A cell computed for 5.0 s: time stood still." in stage.session.status
    assert "fell behind" not in stage.session.status and stage.flags["running"]
    stage.go(NOTE + 0.5)
    stage.session.gone("page")
    stage.session.turn()
    stage.now += 5.0  # nobody looked, so that no turn was due
    stage.open()
    assert "A cell computed" not in stage.session.status


def test_time_without_a_view_is_no_cell(one_thread):
    view = hl.live(PADDLE, WALL)
    session = view._session
    wait_for_frames(session, 2, one_thread)
    session.connect(None)
    session.gone("page")
    assert session._turns.join(20)
    session.clock = lambda: time.monotonic() + 30.0
    wait_for_frames(session, 2, one_thread)
    assert "A cell computed" not in session.status


def test_a_view_says_beforehand_what_a_cell_does_to_it(one_thread, monkeypatch):
    told = Session(PADDLE, WALL, in_thread=False).description()["help"]
    assert "While a cell computes, the view stands still" in told
    monkeypatch.undo()
    assert "cell" not in Session(PADDLE, WALL, in_thread=False).description()["help"]


# --- what a lab asks of it


def test_what_nobody_recorded_is_rehearsed_at_the_sliders_values():
    view = hl.live(PADDLE, WALL, rehearsal=hl.people.Rehearsal(duration=1.0))
    view.set(k=450)
    log = view.rehearsal
    assert view.log is None and log is view.rehearsal
    for needs_a_record in (view.replay, lambda: view.save("view.npz")):
        with pytest.raises(hl.errors.PaddleError, match="nothing was recorded: press Start .*; view.rehearsal is"):
            needs_a_record()
    assert log.parameters["k"] == 450
    hand = hl.Hand("pinch", intent=view._rehearsal)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hand)
    again = paddle.run(hl.wall()(k=450, x_o=0.01), duration=1.0)
    assert np.array_equal(log.F, again.F)
    assert log.intent.min() == pytest.approx(-0.015, abs=1e-4)
    view.set(k=100)
    assert view.rehearsal.F.max() < log.F.max()


def test_a_rehearsal_of_ones_own_begins_where_it_begins():
    view = hl.live(PADDLE, WALL, rehearsal=hl.people.Rehearsal(intent=lambda t: 0.012 + 0 * t, duration=0.1))
    assert view.rehearsal.x[0] == np.float32(0.012)


def test_a_record_comes_before_a_rehearsal(both):
    view = hl.live(PADDLE, WALL, rehearsal=hl.people.Rehearsal(duration=0.1))
    view.record()
    wait_for_frames(view._session, 4, both)
    view.close()
    view.stop_recording()
    assert "intent" in view.log.columns and view.log is not view.rehearsal


def test_on_the_interpreter_it_runs_too(monkeypatch):
    for package in ("llvmlite", "wasmtime"):
        monkeypatch.setitem(sys.modules, package, None)
    stage = Stage().open()
    stage.go(0.1, pointer=lead)
    assert next(iter(stage.session.source._loops.values())).loaded.name == "interpreter"
    assert abs(stage.session.source.ticks - 100) <= 17


@pytest.mark.parametrize(
    ("given", "word"),
    [
        ({"time_scale": 0}, "0.1 slow motion"),
        ({"time_scale": "a"}, "time_scale = 'a'; a live view needs time_scale"),
        ({"rehearsal": lambda t: 0 * t}, "needs hl.people.Rehearsal"),
        ({"foo": 1}, "foo is not an option of a live view or of hapticlab.compile. Give one of method, "),
        ({"time_scale": 100}, "needs time_scale >= 0.001 and <= 10"),
        ({"sliders": {"q": (0, 1)}}, "q is no live parameter"),
        ({"sliders": {"k": (5, 1)}}, "low < high"),
        ({"sliders": {"k": (-5, 1)}}, "not in its range"),
        ({"sliders": ["k"]}, "needs a dict"),
        ({"sliders": {"k": 3}}, "two numbers"),
    ],
)
def test_what_makes_no_sense_is_refused_at_once(given, word):
    with pytest.raises(hl.HapticlabError, match=word):
        hl.live(PADDLE, WALL, **given)


@pytest.mark.parametrize(
    ("given", "word"),
    [
        ({"intent": 5}, "needs an intent"),
        ({"intent": lambda t: "a"}, "needs an intent"),
        ({"intent": lambda t: np.nan * t}, "one finite position"),
        ({"duration": 1e9}, "duration >= 0.01 and <= 600"),
        ({"duration": 0}, "duration = 0"),
    ],
)
def test_what_nobody_can_rehearse_is_refused(given, word):
    with pytest.raises(hl.errors.PaddleError, match=word):
        hl.people.Rehearsal(**given)


def test_a_scene_without_values_and_a_stranger_are_refused():
    with pytest.raises(hl.errors.ParameterError, match="no value for k"):
        hl.live(PADDLE, hl.Scene(force=hl.parameters("k", units="N/m") * hl.x(hl.n)))
    with pytest.raises(hl.errors.PaddleError, match="needs a SimulatedPaddle"):
        hl.live("paddle", WALL)
    with pytest.raises(hl.errors.SceneError):
        hl.live(PADDLE, "wall")


def test_a_slider_shows_its_number_in_a_unit_that_means_the_same_to_pint():
    pint = pytest.importorskip("pint")
    units = pint.UnitRegistry()
    session = Stage(scene=hl.library.ball_on_the_paddle(), method="taylor").session
    assert {span.unit_shown for span in session.spans} >= {"mm", "m/s²", "N s/m", ""}
    for span in session.spans:
        words = span.unit_shown.replace("²", "**2").replace("³", "**3").replace(" ", "*")
        shown = units.Quantity(span.scale * span.value, words)
        assert shown.to(span.unit.replace("^", "**")).magnitude == pytest.approx(span.value)


def test_what_a_front_end_is_told_once():
    view = hl.live(PADDLE, WALL, sliders={"k": (100, 900)})
    about = view._session.description()
    assert [p["name"] for p in about["parameters"]] == ["k"]
    assert about["parameters"][0]["limit_words"] == "allowed k >= 0"
    assert about["kind"] == "simulated"
    assert about["x_range"][0] < -0.015 < 0.015 < about["x_range"][1]
    assert [trace["name"] for trace in about["traces"]] == ["x", "F", "E"]


# --- plain widgets


def test_plain_widgets_show_and_say_the_same():
    widgets = pytest.importorskip("ipywidgets")
    from hapticlab.widgets.plain.plain_view import PlainFront

    stage = Stage()
    front = PlainFront(widgets, stage.session)
    assert not stage.session.on_view
    front.hand.value = 12.0  # the first touch: somebody is there
    assert stage.session.on_view
    assert front.heart.playing
    stage.session.turn()
    front.sliders[1].value = 450
    for _ in range(30):
        stage.now += 1 / 60
        front.heart.value += 1  # as a page does
        stage.session.turn()
    assert stage.session.values["k"] == 450
    root = ElementTree.fromstring(front.image.value)
    assert root.attrib["role"] == "img"
    assert len([e for e in root.iter() if e.tag.endswith("text")]) >= 3
    assert "Running" in front.status.value
    stage.session.set(k=500.0)
    stage.go(0.5)
    assert front.sliders[1].value == 500
    assert [name for name, button in front.buttons.items() if button.disabled] == ["resume", "stop", "save", "replay"]
    assert "F = " in root.attrib["aria-label"] and 'role="status"' in front.status.value
    front.buttons["pause"].click()
    stage.go(0.1)
    assert not stage.session.motion.running
    stage.go(0.3)
    assert not front.buttons["resume"].disabled


def test_plain_traces_begin_anew_with_the_scene_also_within_their_first_seconds():
    widgets = pytest.importorskip("ipywidgets")
    from hapticlab.widgets.plain.plain_view import PlainFront

    stage = Stage()
    front = PlainFront(widgets, stage.session)
    stage.session.connect(lambda frame: (stage.frames.append(frame), front.show(frame)))
    stage.open()
    stage.go(2.0, pointer=lead)
    assert front._rows[-1, 0] == pytest.approx(2.0, abs=0.02)
    front.buttons["restart"].click()
    stage.go(0.5, pointer=lead)
    assert front._rows[0, 0] == 0 and (np.diff(front._rows[:, 0]) > 0).all()
    assert front._rows[-1, 0] == pytest.approx(0.5, abs=0.02)


def test_a_view_for_an_experiment_tells_no_chatter():
    """How often a wall chatters a second tells how stiff it is."""
    told = []
    for show in (True, False):
        stage = Stage(scene=hl.wall()(k=6000, x_o=0.01), show_force=show).open()
        frames = stage.go(2.5, pointer=lambda now: 0.014)
        told.append(any("Chatter" in frame.status or "vibrates" in frame.status for frame in frames))
        assert "Running" in stage.session.status
    assert told == [True, False]


def test_a_view_for_an_experiment_tells_no_force():
    for show, names in ((True, ["x", "F", "E"]), (False, ["x"])):
        stage = Stage(show_force=show).open()
        stage.go(0.5, pointer=lambda now: 0.02)
        assert (stage.rows[-1, 2] > 0.5) is np.bool_(show)  # N: the wall pushes, and the rows do not tell
        assert np.isnan(stage.rows[:, [2, 3, 7]]).all() is np.bool_(not show)
        assert stage.session.description()["loop"] is show
        assert [trace["name"] for trace in stage.session.description()["traces"]] == names
        assert ("force" in [kind for kind, *_ in stage.frames[-1].picture]) is show


def test_a_view_tells_from_the_first_event_on_that_was_left_out():
    h = hl.coordinate("h", unit="m", initial="2 mm", rate=20.0)
    m, room, K = hl.parameters("m room K", units="kg m N/m", values=(0.05, 0.01, 0.0))
    walls = [hl.contact.Contact(gap, hl.contact.impulse(e=1), name=name) for gap, name in ((h, "floor"), (room - h, "roof"))]
    scene = hl.Scene(force=K * h, eom=[hl.mechanics.lagrange(m * h.diff(hl.t) ** 2 / 2, contacts=walls)], watch=[h])
    for events, told in ((1, True), (4, False)):
        stage = Stage(scene=scene, method=hl.methods.Taylor(events=events)).open()
        stage.go(0.4)
        assert ("left unlocated: bodies may be inside each other" in stage.session.status) == told
        stage.session.pressed("pause")
        stage.go(0.4)
        assert stage.session.status.startswith("Paused.") and ("unlocated" in stage.session.status) == told


def test_a_released_drag_lets_go_where_asked_and_a_blind_picture_hides_where_the_hand_aims():
    paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
    shown, told = [], {}
    for show_force in (True, False):
        session = Session(paddle, hl.wall()(k=300, x_o=0.01), show_force=show_force, let_go=not show_force, in_thread=False)
        told[show_force] = session.description()["let_go"]
        shown.append([item[0] for item in session.stage.drawn(0.02)])
    assert told == {True: False, False: True}
    assert len(shown[0]) > len(shown[1])


def test_a_parameter_without_a_unit_is_said_without_one():
    k, s = hl.parameters("k s", units="N/m 1", values=(100, 0.5))
    view = hl.live(
        PADDLE, hl.Scene(force=k * (hl.x(hl.n) + s * (hl.x(hl.n) - hl.x(hl.n - 1)))), sliders={"k": (0, 200), "s": (0, 2)}
    )
    assert repr(view).endswith("k = 100 N/m, s = 0.5")
