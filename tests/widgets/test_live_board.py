"""A board on view: its motor goes on by a press of Start alone, and off with silence, views, faults and other users."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.device.board.streaming import LEAD, LEASH
from hapticlab.device.link.messages import STATES
from hapticlab.widgets.plain.plain_view import PlainFront
from hapticlab.widgets.session import GAP, SILENCE, STEADY, Session
from hapticlab.widgets.stage import CAME_LATE, QUIET, TIMELY

WALL = hl.wall("ellis")(k=150, x_o=0.002)
HAND = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch", intent=0.01))


@pytest.fixture
def board():
    """A board in virtual time: it passes while the session takes its turns."""
    with hl.connect("sim://hapkit", paddle=HAND) as paddle:
        yield paddle


class Stage:
    """A session on a board whose clock, views and turns are the test's."""

    def __init__(self, paddle, scene=WALL, **given):
        self.paddle, self.now, self.frames = paddle, 10.0, []
        self.session = Session(paddle, scene, clock=lambda: self.now, in_thread=False, **given)
        self.session.connect(self.frames.append)
        self.session.ready("page")
        self.session.turn()
        self.go(STEADY)

    def go(self, seconds):
        until = self.now + seconds
        while self.now < until - 1e-9:
            self.now += 1 / 60
            self.session.alive("page")
            self.session.turn()
        return self

    def press(self, *names):
        for name in names:
            self.session.press(name)
        return self.go(1 / 60)

    @property
    def is_running(self):
        """What the board itself says."""
        return self.paddle.state()["state"] == STATES["RUN"]


def test_the_motor_goes_on_by_a_press_and_by_nothing_else(board):
    stage = Stage(board).go(0.5)
    assert not stage.is_running
    assert stage.session.status == "Motor off: press Start, and hold the handle."
    view = hl.live(board, WALL)
    for start in (view.start, view.resume):
        with pytest.raises(hl.errors.PaddleError, match="does not start because a cell ran"):
            start()
    assert not stage.is_running
    stage.press("start").go(0.2)
    assert stage.is_running
    assert stage.frames[-1].flags["motor"]
    assert stage.session.status.startswith("Motor on")
    stage.press("pause")
    assert not stage.is_running
    assert not stage.frames[-1].flags["motor"]


def test_a_restart_leaves_a_motor_off_that_is_off(board):
    stage = Stage(board).press("restart").go(0.2)
    assert not stage.is_running and "The motor is off. Press Start" in stage.session.status
    stage.press("start").go(0.3)
    before = stage.session.motion.time
    stage.session.press("restart", TIMELY + 0.1)  # it waited: the hand may have left
    stage.go(0.1)
    assert stage.is_running and stage.session.motion.time > before and CAME_LATE in stage.session.status
    stage.press("restart").go(0.1)
    assert stage.is_running and stage.session.motion.time < 0.2
    stage.press("pause", "restart").go(0.1)
    assert not stage.is_running
    stage.press("start").go(0.1)
    stage.press("slow").go(0.1)
    assert stage.session.motion.speed == 1 and "runs in real time" in stage.session.status


def test_a_restart_that_is_refused_says_why_and_no_other_cell_is_blamed(board, monkeypatch):
    stage = Stage(board).press("start").go(0.2)

    def refuse():
        raise hl.errors.PaddleError("the handle is too far out")

    monkeypatch.setattr(stage.session.source, "_begin", refuse)
    stage.press("restart").go(0.3)
    assert not stage.is_running and not stage.frames[-1].flags["running"]
    assert "the handle is too far out" in stage.session.status and "another cell" not in stage.session.status
    assert stage.session.status.startswith("Motor off: press Start")
    monkeypatch.undo()
    stage.go(QUIET).press("start").go(0.1)
    assert stage.is_running


@pytest.mark.parametrize("how", ["gone", "silent", "close", "sink", "error"])
def test_the_motor_goes_off_with_whoever_looks(board, how, monkeypatch):
    stage = Stage(board).press("start").go(0.2)
    assert stage.is_running
    if how == "gone":
        stage.session.gone("page")
    elif how == "silent":
        stage.now += SILENCE + 0.1
    elif how == "close":
        stage.session.end()
    elif how == "sink":
        stage.session.connect(lambda frame: 1 / 0)
        stage.go(1 / 60)
    else:
        monkeypatch.setattr(stage.session.motion.traces, "add", lambda *given: 1 / 0)
        stage.go(1 / 60)
    stage.session.turn()
    assert not stage.is_running
    monkeypatch.undo()
    stage.session.connect(stage.frames.append)
    stage.go(0.3)  # somebody looks again: only Start switches it on
    assert not stage.is_running
    if how == "error":
        assert "ZeroDivisionError" in stage.session.status


def test_a_press_that_comes_late_starts_nothing(board):
    stage = Stage(board).go(0.1)
    stage.session.press("start")
    stage.session.gone("page")
    stage.session.turn()
    stage.session.press("start")
    stage.session.ready("page")
    stage.go(0.2)
    assert not stage.is_running


def test_a_press_that_waited_for_the_kernel_starts_nothing_and_says_so(board):
    """A cell ran: heartbeats and a press of Start wait for it, and come in one bunch; the hand has left the handle."""
    stage = Stage(board)
    stage.now += 3.2
    stage.session.turn()
    for _ in range(5):
        stage.session.alive("page")
    stage.press("start").go(0.1)
    assert not stage.is_running
    assert CAME_LATE in stage.session.status
    stage.go(STEADY).press("start")
    assert stage.is_running


@pytest.mark.parametrize(("busy", "age", "runs"), [(0.3, 0.3, True), (0.9, 0.6, False), (GAP + 0.1, 0.0, False)])
def test_a_start_counts_while_it_is_fresh(board, busy, age, runs):
    """Busy for less than the silence that ends a view: the age of the press decides, or the gap in what was heard."""
    stage = Stage(board)
    stage.now += busy
    stage.session.alive("page")
    stage.session.press("start", age)
    stage.session.turn()
    assert stage.is_running is runs
    assert (CAME_LATE in stage.session.status) is not runs


def test_a_start_that_a_slow_turn_held_up_counts_no_more(board):
    stage = Stage(board)
    stage.session.press("start")
    stage.now += TIMELY + 0.1
    stage.go(1 / 60)
    assert not stage.is_running


def test_plain_buttons_that_waited_start_nothing(board):
    widgets = pytest.importorskip("ipywidgets")
    stage = Stage(board)
    front = PlainFront(widgets, stage.session)

    def beat(seconds):
        for _ in range(round(seconds / 0.5)):
            stage.now += 0.5
            front.heart.value += 1
            stage.session.turn()

    beat(1.0)
    stage.now += 3.2  # a cell runs
    front.heart.value += 1
    front.buttons["start"].click()
    stage.session.turn()
    assert not stage.is_running
    assert "press it again" in front.status.value
    beat(1.0)
    front.buttons["start"].click()
    stage.session.turn()
    assert stage.is_running


def test_sliders_that_moved_before_a_press_hold_for_it(board, monkeypatch):
    """What a slow turn finds in one bunch is done in its order."""
    stage, begun, start = Stage(board), [], board.start
    monkeypatch.setattr(board, "start", lambda program, **given: (begun.append(program.values), start(program, **given)))
    stage.session.move("k", 35.0)
    stage.session.press("record")
    stage.press("start").go(0.1)
    names = [p.name for p in stage.session.source.program.parameters]
    assert dict(zip(names, begun[0], strict=True))["k"] == 35
    stage.session.move("k", 60.0)
    stage.press("stop")
    log = stage.session.recorded()
    assert log.parameters["k"] == 35
    assert [changed for _, changed in log.changes] == [{"k": 60.0}]


def test_a_view_that_hangs_lets_the_board_stop_its_motor(board):
    """Nobody takes turns any more while the port is read on: the board is fed for LEASH, then stops by itself."""
    stage = Stage(board).press("start").go(0.2)
    board.exchange.wait(lambda: False, LEASH + 0.3)
    assert board.state()["state"] == STATES["FAULT"]
    stage.go(0.1)
    assert "HOST_SILENT" in stage.session.status
    assert not stage.session.motion.running


def test_what_the_board_samples_is_recorded_whole(board):
    stage = Stage(board).press("record", "start").go(1.0)
    stage.session.move("k", 300)
    stage.go(0.5)
    log = stage.press("stop").session.recorded()
    assert len(log) > 1400
    assert np.allclose(np.diff(log.t), board.T, atol=1e-12)
    assert not log.gap.any()
    ((since, set_),) = log.changes
    assert set_ == {"k": 300.0}
    law = np.maximum(np.where(log.t < since - 1e-9, 150, 300) * (log.x - 0.002), 0)
    after = slice(10, None)
    assert abs(log.F - law)[after].max() < 0.15  # the damper of Ellis's law beside the spring
    assert 0 <= log.delay < board.T
    assert "intent" not in log.columns
    stage.press("record").go(0.1)
    stage.press("start").go(0.1)  # begins anew, and a recording does not go over that
    assert not stage.frames[-1].flags["recording"]
    assert 50 < len(stage.session.recorded()) < len(log)


def test_the_energy_on_view_is_that_of_the_record(board):
    stage = Stage(board).press("record", "start").go(0.5)
    log = stage.session.recorded()
    rows = np.concatenate([frame.rows for frame in stage.frames])
    work = np.r_[0.0, np.cumsum(log.F[:-1] * np.diff(log.x))]
    assert np.allclose(rows[:, 3], -work[np.round(rows[:, 0] / board.T).astype(int)], atol=1e-8)


def test_sliders_move_before_start_and_while_it_runs(board):
    stage = Stage(board)
    stage.session.move("k", 200)
    stage.go(0.1)
    assert stage.session.values["k"] == 200
    stage.press("start").go(0.3)
    before = stage.frames[-1].rows[-1]
    assert before[2] == pytest.approx(200 * (before[1] - 0.002), rel=0.05)
    stage.session.move("k", -1)
    stage.go(0.1)
    assert "needs k >= 0" in stage.session.status
    assert stage.is_running


def test_a_fault_is_told_and_start_clears_it(board):
    stage = Stage(board).press("start").go(0.2)
    board.exchange.port.lead(0.045)
    board.exchange.port.handle.v = 3.0  # faster than a handle may be
    stage.go(0.2)
    assert not stage.is_running
    assert "OVER_SPEED" in stage.session.status
    assert not stage.frames[-1].flags["motor"]
    stage.go(QUIET).press("start").go(0.2)
    assert stage.is_running
    assert "OVER" not in stage.session.status


@pytest.mark.parametrize("how", ["pause", "fault"])
def test_a_press_that_was_meant_for_stop_starts_nothing(board, how):
    """The second of two presses of a button that stops and starts, and a Stop that a fault was faster than."""
    stage = Stage(board).press("start").go(0.2)
    if how == "fault":
        board.exchange.port.lead(0.045)
        board.exchange.port.handle.v = 3.0  # faster than a handle may be
        stage.go(0.1)
    for press in ("pause", "start", "resume", "restart") if how == "pause" else ("start", "resume"):
        stage.press(press).go(0.1)
        assert not stage.is_running
    assert "The motor went off just now" in stage.press("start").session.status
    stage.go(QUIET).press("start")
    assert stage.is_running


def test_another_cell_takes_the_paddle(board):
    stage = Stage(board).press("start").go(0.2)
    log = board.run(WALL(k=100), duration=0.1)
    assert len(log) == 100
    stage.go(0.1)
    assert not stage.session.motion.running
    assert "another cell" in stage.session.status
    board.start(WALL(k=100))
    stage.press("pause")
    assert stage.is_running  # what others began is not ended here


def test_a_paddle_that_was_closed_is_told(board):
    stage = Stage(board).press("start").go(0.1)
    board.close()
    stage.go(0.1)
    assert not stage.frames[-1].flags["motor"]
    assert "this paddle was closed" in stage.session.status


def test_a_board_that_cannot_be_told_to_stop_is_abandoned_in_words(board, monkeypatch):
    """A cable that is pulled: stopping raises what no library of ours raises. The view lives on; the board hears nothing."""
    stage = Stage(board).press("start").go(0.1)

    def torn(**given):
        raise OSError("device reports readiness to read but returned no data")

    monkeypatch.setattr(board, "stop", torn)
    stage.press("pause").go(0.1)
    assert "OSError: device reports" in stage.session.status
    assert not stage.frames[-1].flags["motor"]
    assert not stage.is_running
    assert not board.exchange.beating
    monkeypatch.undo()
    stage.go(QUIET).press("start").go(0.1)
    assert stage.is_running


def test_a_handle_that_is_lost_is_led_to_its_stops_first(board, monkeypatch):
    """Until the board knows where its handle is, Start waits, in words, and blocks nothing."""
    homed = []
    monkeypatch.setattr("hapticlab.device.board.streaming.state_flag", lambda exchange, name: bool(homed))
    monkeypatch.setattr("hapticlab.device.board.streaming.hasattr", lambda port, name: False, raising=False)
    stage = Stage(board).press("start").go(0.3)
    assert LEAD in stage.session.status
    assert not stage.is_running
    homed.append(True)
    stage.go(0.1)
    assert stage.is_running


def test_a_record_is_played_with_the_motor_off(board):
    stage = Stage(board).press("record", "start").go(0.3).press("replay").go(0.1)
    assert not stage.is_running
    assert stage.frames[-1].flags["replaying"]
    stage.go(0.5)
    assert not stage.frames[-1].flags["replaying"]
    assert not stage.is_running


def test_without_a_record_a_board_has_no_log(board):
    view = hl.live(board, WALL)
    assert view.log is None
    with pytest.raises(hl.errors.PaddleError, match="press Start and then Record"):
        view.rehearsal  # noqa: B018


def test_a_board_has_no_slow_motion(board):
    with pytest.raises(hl.errors.PaddleError, match="real time"):
        hl.live(board, WALL, time_scale=0.1)


def test_a_scene_that_does_not_fit_is_refused_before_it_is_shown(board, monkeypatch):
    def too_long(*given, **options):
        raise hl.errors.ProgramLimitError("takes 140 % of the period")

    monkeypatch.setattr(type(board), "fitted", too_long)
    with pytest.raises(hl.errors.ProgramLimitError, match="140 %"):
        hl.live(board, WALL)


@pytest.mark.wide
def test_by_the_clock_on_the_wall_in_its_own_turns(both):
    """The real protocol in real time: frames come, and with the last view the motor is off."""
    with hl.connect("sim://hapkit?pace=real", paddle=HAND) as board:
        view = hl.live(board, WALL)
        session, frames, pushed = view._session, [], both.event()

        def sink(frame):
            frames.append(frame)
            session.alive("page")
            if not frame.flags["running"]:
                session.press("start")  # counts once the page was heard for a while
            if frame.flags["motor"] and len(frame.rows) and frame.rows[-1, 2] > 0.5:
                pushed.set()

        session.connect(sink)
        session.ready("page")
        assert pushed.wait(20)
        turns = session._turns
        session.connect(None)
        session.gone("page")
        assert turns.join(20)
        assert board.state()["state"] != STATES["RUN"]


def test_without_threads_a_cell_that_takes_the_turn_is_a_silence_too(board, one_thread):
    """The page's words come before the turn that would have noticed that there were none."""
    stage = Stage(board).press("start").go(0.2)
    assert stage.is_running
    stage.now += SILENCE + 0.5
    stage.session.alive("page")
    stage.session.turn()
    assert not stage.is_running
    assert "The notebook was silent for 2.5 s: the motor went off" in stage.session.status
    stage.go(1.0)
    assert not stage.is_running
    stage.press("start").go(0.2)
    assert stage.is_running


@pytest.mark.always("threads")
def test_a_view_that_nobody_keeps_switches_its_motor_off(both):
    with hl.connect("sim://hapkit?pace=real", paddle=HAND) as board:
        view = hl.live(board, WALL)
        session, on = view._session, both.event()

        def sink(frame):
            session.alive("page")
            if not frame.flags["running"]:
                session.press("start")
            if frame.flags["motor"]:
                on.set()

        session.connect(sink)
        session.ready("page")
        assert on.wait(20)
        turns = session._turns
        del view
        assert turns.join(20)
        assert board.state()["state"] != STATES["RUN"]
