"""What a side does with silence, with what cannot be, and with a side that stops: its force fades, and nothing jumps."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.streaming import Streaming
from hapticlab.device.pair.sides import Side
from hapticlab.device.simulated.stepping import Stepping

T = 1e-3
SIDE = hl.laws.bilateral_coupling()(k=60, b=0.2)
#: of the default engagement [s]
HOLD, FADE, RAMP = 0.05, 0.05, 0.5


@pytest.fixture
def silenced(monkeypatch):
    """Names of sides that hear nothing."""
    names, hear = set(), Side.hear
    monkeypatch.setattr(Side, "hear", lambda side, message: None if side.name in names else hear(side, message))
    return names


class Heard:
    """One side on a handle that is led to 10 mm and held there, and hears what it is told."""

    def __init__(self, scene=SIDE, at=0.0):
        hand = hl.Hand(m=0.5, b=50, k=5000)
        self.stepping = Stepping(hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hand), scene, x=at)
        self.at, self.beat, self.rows = at, 0, []

    def pass_by(self, seconds, **heard):
        """Let time pass; a message every tick, or none."""
        for _ in range(round(seconds / T)):
            if heard:
                self.beat += 1
                self.stepping.hear(beat=float(self.beat), **{"other_v": 0.0, **heard})
            self.rows.append(self.stepping.advance(np.full(2, self.at)))
        return self

    def __getattr__(self, column):
        return np.concatenate([row[column] for row in self.rows])


def two_boards():
    left, right = hl.connect("sim://hapkit"), hl.connect("sim://hapkit")
    return left, right, hl.devices.TwoPaddles(left, right, SIDE)


@pytest.mark.always("board")
@pytest.mark.parametrize("where", ["simulated", "board"])
def test_it_fades_within_the_stated_time_and_comes_back_with_the_ramp(where, silenced):
    if where == "board":
        left, right, pair = two_boards()
    else:
        paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand("pinch"))
        pair = hl.devices.TwoPaddles(paddle, paddle, SIDE)
    pair.start()
    pair.wait(0.6)
    silenced.add("left")
    pair.wait(0.2)
    silenced.clear()
    pair.wait(0.6)
    run = pair.stop()
    if where == "board":
        left.close(), right.close()
    gain, t = run.left.gain, run.left.t
    last = t[(np.diff(run.left.heard, prepend=0) != 0) & (t < 0.65)].max()  # when the last message came
    assert gain[(t > 0.55) & (t <= last + HOLD)].min() == 1
    assert gain[(t >= last + HOLD + FADE - T / 2) & (t < 0.79)].max() == 0
    assert np.abs(run.left.F[(t >= last + HOLD + FADE - T / 2) & (t < 0.79)]).max() == 0
    assert np.diff(gain).max() <= 1.01 * T / RAMP and gain[-1] == 1 and run.fault is None
    assert run.right.gain[-1] == 1  # who is heard all the time is not disturbed


def test_it_takes_hold_again_without_a_jump_also_far_apart():
    there = Heard().pass_by(1.0, other_x=0.0).pass_by(2.0)
    assert there.F[-1] == 0
    again = there.pass_by(1.0, other_x=0.06)  # the other was led 60 mm away meanwhile
    assert np.abs(np.diff(again.F)).max() <= 1.05 * 60 * 0.06 * T / RAMP
    assert again.F[-1] == pytest.approx(60 * (again.x[-1] - 0.06), rel=1e-5)


@pytest.mark.parametrize("heard", [{"other_x": 0.2}, {"other_x": -math.inf}, {"other_x": 0.0, "other_v": 90.0}])
def test_what_cannot_be_is_silence(heard):
    side = Heard(at=0.01).pass_by(0.6, other_x=0.0).pass_by(0.2, **heard)
    assert side.gain[599] == 1 and side.gain[-1] == 0 and side.F[-1] == 0
    assert np.isfinite(side.F).all() and np.abs(side.F).max() <= 60 * 0.0101


def test_the_damper_of_a_controller_fades_too():
    side = Heard(hl.laws.bilateral_coupling(controller=True)(k=60, b=0.2, alpha_max=5.0), at=0.01)
    for i in range(1200):  # the other side works on the handle, says that it was given nothing, and is silent from 0.7 s on
        side.at = 0.01 + 0.004 * math.sin(30 * i * T)
        side.pass_by(T, **{"other_x": 0.02 * math.sin(30 * i * T + 1.5), "other_energy": 0.0} if i < 700 else {})
    assert side.alpha[600:700].max() > 1 and not side.F[800:].any()
    assert np.ptp(side.x[800:]) > 5e-3  # the hand moves on


def test_a_leader_feels_nothing_of_a_follower_that_does_not_hear(silenced):
    leader, follower = (hl.laws.bilateral_coupling("position-force", role=role)(k=60, b=0.2) for role in ("leader", "follower"))
    push, hold = hl.Hand("pinch", intent=lambda t: 0.02 * np.minimum(1, t)), hl.Hand("pinch")
    left, right = (hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hand) for hand in (push, hold))
    pair = hl.devices.TwoPaddles(left, right, leader, follower)
    pair.start()
    pair.wait(1.0)
    silenced.add("right")
    pair.wait(0.2)
    run = pair.stop()
    assert run.left.F[999] > 0.5 and run.left.gain[-1] == 1
    assert np.abs(run.left.F + run.right.F).max() < 0.2  # one tick late, times k, b and the speed
    assert run.right.F[-50:].any() == run.left.F[-50:].any() == 0


@pytest.mark.parametrize("pace", ["", pytest.param("?pace=real", marks=pytest.mark.wide)])
def test_an_answer_that_is_lost_silences_nobody(pace):
    left, right = hl.connect(f"sim://hapkit{pace}"), hl.connect(f"sim://hapkit{pace}")
    with left, right:
        pair = hl.devices.TwoPaddles(left, right, SIDE)
        pair.start()
        pair.wait(0.1)
        left.exchange._told = 1000  # no answer has this number
        pair.wait(0.2)
        run = pair.stop()
    assert run.left.t[-1] - run.left.t[np.flatnonzero(np.diff(run.left.heard))[-1]] < 0.02


def test_a_jump_of_the_other_handle_lets_go_at_once_and_takes_hold_again_slowly():
    side = Heard().pass_by(0.6, other_x=0.0).pass_by(0.6, other_x=0.03)
    assert side.gain[599] == 1 and side.gain[600] == 0 and side.gain[-1] == 1
    assert np.abs(np.diff(side.F)).max() <= 1.05 * 60 * 0.03 * T / RAMP


def test_nothing_that_a_board_hears_makes_its_force_no_number():
    left, right, pair = two_boards()
    with left, right:
        pair.start()
        pair.wait(0.2)
        pair._left.source.hear(other_x=math.nan, other_v=0.0, beat=-1.0)
        pair.wait(0.05)
        run = pair.stop()
    assert np.isfinite(run.left.F).all() and run.fault is None


@pytest.mark.parametrize("failure", ["over-speed", "port"])
def test_a_side_that_stops_stops_both_in_words(failure, capsys):
    left, right, pair = two_boards()
    with left, right:
        port = left.exchange.port
        pair.start()
        pair.wait(0.2)
        if failure == "port":
            port.close()
        for _ in range(100):  # pulled away at 3 m/s
            port.handle.x += 3e-3 * (failure == "over-speed")
            pair.wait(T)
        assert right.under_way is None and right.state()["force"] == 0
        run = pair.stop()
        port.is_open = True
    assert run.fault.startswith("left: ") and ("OVER" in run.fault or "closed" in run.fault)
    assert "both motors are off. left: " in capsys.readouterr().out
    assert len(run.right) < 0.45 / T and run.right.fault is None


def test_a_reset_of_one_board_takes_the_force_of_the_other_and_stops_it():
    left, right, pair = two_boards()
    with left, right:
        pair.start()
        pair.wait(0.2)
        left.exchange.port.put_on(None)
        pair.wait(0.11)
        assert right.state()["force"] == 0
        pair.wait(1.0)
        assert right.under_way is None
        run = pair.stop()
    assert run.fault.startswith("left: ") and "was reset" in run.fault
    assert not run.right.F[run.right.t > 0.31].any()


def test_a_start_that_one_side_rejects_leaves_no_motor_on():
    left, right, pair = two_boards()
    with left, right:
        right.close()
        with pytest.raises(hl.errors.HapticlabError):
            pair.start()
        assert left.under_way is None and left.state()["force"] == 0


def test_both_handles_are_led_to_their_stops_before_either_motor_is_on(monkeypatch, capsys):
    (left, right, pair), done, start, home = two_boards(), [], Streaming.start, SerialPaddle.home
    monkeypatch.setattr(Streaming, "is_lost", lambda source: ("home", source.paddle) not in done)
    monkeypatch.setattr(Streaming, "start", lambda source: (done.append(("start", source.paddle)), start(source)))
    monkeypatch.setattr(SerialPaddle, "home", lambda paddle: (done.append(("home", paddle)), home(paddle)))
    with left, right:
        pair.start()
        pair.wait(0.01)
        pair.stop()
    asked = [name for name, _ in done]
    assert asked.index("start") == 2 and {paddle for _, paddle in done[:2]} == {left, right}
    assert "the left paddle:" in capsys.readouterr().out


def test_an_interrupt_stops_both(monkeypatch):
    left, right, pair = two_boards()
    with left, right:
        monkeypatch.setattr(pair, "wait", lambda seconds: (_ for _ in ()).throw(KeyboardInterrupt()))
        with pytest.raises(KeyboardInterrupt):
            pair.run(1.0)
        assert left.under_way is None and right.under_way is None


@pytest.mark.parametrize("pace", ["", "?pace=real"])
def test_an_interrupted_wait_stops_both_and_keeps_what_was_recorded(pace, monkeypatch):
    left, right = hl.connect(f"sim://hapkit{pace}"), hl.connect(f"sim://hapkit{pace}")
    with left, right:
        pair = hl.devices.TwoPaddles(left, right, SIDE)
        pair.start()
        pair.wait(0.1)
        monkeypatch.setattr(pair, "_wait", lambda seconds: (_ for _ in ()).throw(KeyboardInterrupt()))
        with pytest.raises(KeyboardInterrupt):
            pair.wait(1.0)
        assert left.under_way is None and right.under_way is None
        pair._turn()  # one that was under way does not take the reason back, nor start anything
        run = pair.stop()
        assert left.under_way is None and len(run.left) > 50 and run.fault == "the wait was interrupted"


def test_swapped_ports_are_the_same_coupling_mirrored():
    leading = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand("pinch", intent=lambda t: 0.01 * np.sin(9 * t)))
    free = hl.SimulatedPaddle(m=0.05, b=0.3, T=T)
    one, other = (hl.devices.TwoPaddles(*two, SIDE, delay="4 ms").run(0.3) for two in ((leading, free), (free, leading)))
    assert np.array_equal(one.left.F, other.right.F) and np.array_equal(one.right.x, other.left.x)


def test_the_controller_takes_back_what_a_late_link_generates():
    """Three times beyond the limit, against the work of both motors as the recordings have it."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=T)
    k = 3 * hl.stability.coupling_limit(paddle, paddle, delay="20 ms").K
    engagement = hl.laws.Engagement(ramp=T, jump=1.0, travel=1.0)
    given = {}
    for controller in (False, True):
        scene = hl.laws.bilateral_coupling(controller=controller, engagement=engagement)
        scene = scene(k=k, **{"alpha_max": 10.0} if controller else {})
        run = hl.devices.TwoPaddles(paddle, paddle, scene, delay="20 ms").run(0.4, x=(5e-3, -5e-3))
        given[controller] = -sum(np.sum(log.F[:-1] * np.diff(log.x)) for log in (run.left, run.right))
    assert given[False] > 0.5 * k * 0.01**2 > 10 * given[True]


@pytest.mark.wide
@pytest.mark.parametrize("architecture", ["position-position", "position-force"])
def test_the_controller_holds_with_jitter_losses_and_a_hand_that_leads(architecture):
    """Three times beyond the limit; what both sides together were given at any time, against what they are given without it."""
    held = hl.SimulatedPaddle(m=0.08, b=0.2, T=T, hand=hl.Hand("pinch", intent=lambda t: 0.01 * np.sin(2 * np.pi * 1.5 * t)))
    free, late, given = hl.SimulatedPaddle(m=0.05, b=0.2, T=T), "15 ms", {}
    k = 3 * hl.stability.coupling_limit(free, held, architecture=architecture, delay=late).K
    for controller in (False, True):
        scenes = [
            hl.laws.bilateral_coupling(
                architecture, role=role, controller=controller, engagement=hl.laws.Engagement(ramp=T, jump=1.0, travel=1.0)
            )(k=k, b=0.1, **({"alpha_max": 10.0} if controller else {}))
            for role in ("leader", "follower")
        ]
        run = hl.devices.TwoPaddles(free, held, *scenes, delay=late, jitter="5 ms", loss=0.1, seed=2).run(2.0, x=(2e-3, -2e-3))
        given[controller] = np.max(-sum(np.cumsum(log.F[:-1] * np.diff(log.x)) for log in (run.left, run.right)))
    assert given[True] < 5e-3 < 10 < given[False]
