"""From START to STOP: what an interrupt, a refusal, a second thread and a dropped paddle leave behind."""

import gc
import subprocess
import sys
import threading
import weakref

import numpy as np
import pytest
from bad_line import Peer

import hapticlab as hl
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.messages import STATES
from hapticlab.device.link.serial_ports import open_port
from hapticlab.device.link.wire import encode
from hapticlab.errors import LinkError, PaddleError, ParameterError, PortError
from hapticlab.scene.notation.symbols import n, parameters, x
from hapticlab.scene.scene import Scene

k, push = parameters("k push", units="N/m N")
LEAN = Scene(force=k * x(n) + push, name="lean")
OTHER = Scene(force=k * x(n) + push + k * (x(n) - x(n - 1)), name="other")


@pytest.fixture
def peer():
    """A board behind a socket, so that a thread reads; with a list of what it was told."""
    heard = []
    made = Peer(told=lambda frame: heard.append(frame and frame.message) or True)
    made.heard = heard
    return made


def is_off(board):
    return board.exchange.port.board.duty == 0 and board.state()["state"] == STATES["IDLE"] and not board.exchange.beating


def failing(board, monkeypatch, request, failure):
    """Fail right after the board has done what this request asks."""
    real = board.exchange.command

    def command(message, *values, **options):
        done = real(message, *values, **options)
        if message == request:
            monkeypatch.setattr(board.exchange, "command", real)
            raise failure
        return done

    monkeypatch.setattr(board.exchange, "command", command)


# ---------------------------------------------------------------- the motor is not left on


@pytest.mark.parametrize("failure", [PortError("write timeout", "silent"), KeyboardInterrupt(), LinkError("no answer")])
@pytest.mark.parametrize("method", ["start", "run"])
def test_what_fails_while_start_is_answered_leaves_no_motor_running(board, monkeypatch, failure, method):
    failing(board, monkeypatch, "START", failure)
    options = {"duration": 1.0} if method == "run" else {}
    with pytest.raises(type(failure)):
        getattr(board, method)(LEAN(k=10, push=0.1), **options)
    assert is_off(board)
    assert board.run(LEAN(k=10, push=0.1), duration=0.01).fault is None


def test_an_interrupted_wait_stops_the_motor_and_keeps_what_was_recorded(board, monkeypatch):
    board.start(LEAN(k=10, push=0.1))
    board.wait(0.05)
    assert board.exchange.port.board.duty != 0

    def interrupt(condition, seconds):
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(board.exchange, "wait", interrupt)
        with pytest.raises(KeyboardInterrupt):
            board.wait(1.0)
    assert is_off(board)
    assert len(board.stop()) >= 50


def test_an_interrupted_set_stops_the_motor(board, monkeypatch):
    board.start(LEAN(k=10, push=0.1))
    failing(board, monkeypatch, "SET", KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        board.set(k=11)
    assert is_off(board)


def test_a_stop_that_is_interrupted_ends_the_heartbeats(board, monkeypatch):
    board.start(LEAN(k=10, push=0.1))

    def interrupt(*_, **__):
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(board.exchange, "command", interrupt)
        with pytest.raises(KeyboardInterrupt):
            board.stop()
    assert not board.exchange.beating


def test_a_dropped_paddle_says_stop_and_gives_the_port_back(peer):
    board = SerialPaddle(peer.url)
    board.home(at=0.0)
    board.start(LEAN(k=10, push=0.1))
    board.wait(0.05)
    dropped, reader = weakref.ref(board), board.exchange._reader
    del board
    gc.collect()
    assert dropped() is None
    reader.join(10)
    assert peer.ended.wait(10) and "STOP" in peer.heard and not reader.is_alive()


@pytest.mark.wide
def test_a_program_that_ends_says_stop(peer):
    program = f"""if True:
        import hapticlab as hl
        k = hl.parameters("k", units="N/m")
        board = hl.connect({peer.url!r})
        board.home(at=0.0)
        board.start(hl.Scene(force=k * hl.x(hl.n), name="spring")(k=10))
    """
    subprocess.run([sys.executable, "-c", program], check=True, timeout=60)
    assert peer.ended.wait(10) and "START" in peer.heard and "STOP" in peer.heard


# ---------------------------------------------------------------- how long a board may be silent


def test_few_samples_are_waited_for(board):
    log = board.run(LEAN(k=10, push=0.0), duration=9.0, every=2500, progress=False)
    assert np.array_equal(log.t, [0, 2.5, 5.0, 7.5]) and log.fault is None


# ---------------------------------------------------------------- what is refused changes nothing


@pytest.mark.parametrize("force_max", [-1, float("nan"), -1e-9])
def test_a_limit_that_is_none_is_refused_here(board, force_max):
    with pytest.raises(PaddleError, match="a run needs force_max >= 0"):
        board.start(LEAN(k=10, push=0.1), force_max=force_max)
    assert board.state()["state"] == STATES["IDLE"]


@pytest.mark.parametrize("force_max", [0, 0.05, float("inf")])
def test_a_limit_holds(board, force_max):
    log = board.run(LEAN(k=0, push=0.1), duration=0.01, force_max=force_max)
    assert np.allclose(log.F, min(0.1, force_max), atol=1e-7)


def test_a_motor_whose_sign_nobody_checked_gives_half_a_newton():
    port = open_port("sim://hapkit")
    port.put_on(None, store=nominal("hapkit", wired=1, checked=0, ident=1).to_bytes())
    with SerialPaddle("sim://hapkit", port=port) as unchecked:
        unchecked.home(at=0.0)
        log = unchecked.run(LEAN(k=0, push=3.0), duration=0.02)
    assert np.abs(log.F).max() == 0.5 and log.saturated.all()


def test_after_a_refused_start_set_means_the_scene_that_runs(board):
    board.start(LEAN(k=0, push=0.1))
    board.wait(0.05)
    with pytest.raises(LinkError, match="RANGE"):
        board._begin(board.program(OTHER(k=20, push=-0.1)), None, 0, -1.0)
    board.wait(0.05)
    board.set(push=0.2)
    board.wait(0.05)
    log = board.stop()
    tick = round(log.changes[0][0] / log.T)
    assert log.scene == "lean" and np.allclose(log.F, np.where(np.arange(len(log)) < tick, 0.1, 0.2), atol=1e-7)
    again = board.run(duration=0.01)  # and so does a start without a scene
    assert again.scene == "lean" and np.allclose(again.F, 0.2, atol=1e-7)


def test_after_a_refused_value_set_means_the_scene_that_runs(board, monkeypatch):
    board.start(LEAN(k=0, push=0.1))
    failing(board, monkeypatch, "SET", LinkError("the board refused SET: RANGE", "RANGE"))
    with pytest.raises(LinkError, match="RANGE"):
        board.start(OTHER(k=20, push=-0.1))
    board.set(push=0.2)
    board.wait(0.05)
    log = board.stop()
    assert log.scene == "lean" and log.F[-1] == np.float32(0.2)


def test_a_refused_start_with_nothing_running_may_be_started_again(board):
    with pytest.raises(LinkError, match="RANGE"):
        board._begin(board.program(LEAN(k=0, push=0.1)), None, 0, -1.0)
    assert is_off(board)
    assert np.allclose(board.run(duration=0.01).F, 0.1, atol=1e-7)


@pytest.mark.parametrize("as_program", [False, True])
def test_set_beyond_a_declared_range_is_refused(board, as_program):
    K = parameters("K", units="N/m", ranges=(0, 100))
    scene = Scene(force=K * x(n), name="ranged")(K=50)
    board.start(board.program(scene) if as_program else scene)
    with pytest.raises(ParameterError, match="K = 500 N/m; it was declared to lie between 0 and 100"):
        board.set(K=500)
    with pytest.raises(ParameterError):
        board.set(K="-1 N/m")
    board.set(K="0.1 N/mm")  # 100 N/m: the range is closed
    assert board.stop().changes[0][1] == {"K": 100.0}


# ---------------------------------------------------------------- faults


def test_a_fault_is_told_by_wait_and_cleared_by_clear(board, capsys):
    board.start(LEAN(k=10, push=0.1))
    board.exchange.port.board.fail("MEMORY")
    board.wait(0.5)
    assert "MEMORY: the stack reached the data" in capsys.readouterr().out
    board.clear()
    assert "a fault was pending: tick 0: MEMORY:" in capsys.readouterr().out and is_off(board)
    board.clear()
    assert capsys.readouterr().out == ""
    assert "MEMORY" in board.stop().fault


def test_a_fault_that_nobody_cleared_is_told_and_no_obstacle_to_a_start(board, capsys):
    board.start(LEAN(k=10, push=0.1))
    board.exchange.port.board.fail("MEMORY")
    assert board.run(LEAN(k=10, push=0.1), duration=0.05).fault is None
    assert "a fault was pending: tick 0: MEMORY:" in capsys.readouterr().out


def test_a_connection_prints_nothing_and_says_what_the_board_went_through(monkeypatch, capsys):
    happened = ["the board was reset by its watchdog", "a fault stood: MEMORY"]
    monkeypatch.setattr("hapticlab.device.board.serial_paddle.what_happened", lambda *_: happened)
    with hl.connect("sim://hapkit") as board:
        assert capsys.readouterr().out == ""
        assert board.notices == tuple(happened) and repr(board).endswith(f"; {'; '.join(happened)}>")
        assert "MEMORY" not in str(board)


def test_another_program_that_took_the_board_is_named(board):
    board.start(LEAN(k=10, push=0.1))
    board.wait(0.05)
    board.exchange.port.write(encode("HELLO", 1, board.exchange.session ^ 1))
    with pytest.raises(LinkError, match="another program connected to the board while the scene ran,"):
        board.wait(0.5)


def test_a_simulated_handle_beyond_its_travel_is_led_back():
    with hl.connect("sim://hapkit") as board:
        port = board.exchange.port
        board.start(LEAN(k=0, push=0.0))
        while board.under_way.fault is None:  # 0.3 m/s, slower than what is too fast
            port.handle.x += 3e-4
            board.wait(1e-3)
        assert "OVER_TRAVEL" in board.stop().fault and port.handle.x > 0.04
        log = board.run(LEAN(k=10, push=0.01), duration=0.05)
        assert log.fault is None and log.x[0] == 0 and board.state()["x"] == pytest.approx(port.handle.x, abs=1e-4)


# ---------------------------------------------------------------- two threads


def test_virtual_time_passes_for_one_thread(board):
    board.start(LEAN(k=10, push=0.1))
    inside, go = threading.Event(), threading.Event()
    waited = []
    waiter = threading.Thread(target=lambda: waited.append(board.exchange.wait(lambda: inside.set() or go.wait(10), 1.0)))
    waiter.start()
    assert inside.wait(10)
    for act in (lambda: board.set(k=11), lambda: board.wait(0.1), board.stop, board.state):
        with pytest.raises(PaddleError, match=r"another thread is waiting now\. .*pace=real"):
            act()
    go.set()
    waiter.join(10)
    assert waited == [True]
    board.set(k=12)
    board.wait(0.01)
    log = board.stop()
    assert log.fault is None and [values for _, values in log.changes] == [{"k": 12.0}]


def test_a_run_that_another_thread_ends_says_so(peer, monkeypatch):
    with SerialPaddle(peer.url) as board:
        board.home(at=0.0)
        collecting, real, problems = threading.Event(), board.exchange.wait, []
        monkeypatch.setattr(board.exchange, "wait", lambda *how: collecting.set() or real(*how))

        def run():
            try:
                board.run(LEAN(k=10, push=0.1), duration=60.0, progress=False)
            except PaddleError as problem:
                problems.append(str(problem))

        runner = threading.Thread(target=run)
        runner.start()
        assert collecting.wait(10)
        board.stop()
        runner.join(10)
        assert len(problems) == 1 and "another thread ended this run" in problems[0]
    assert peer.ended.wait(10)


def test_threads_that_start_at_once_leave_one_truth(peer):
    with SerialPaddle(peer.url) as board:
        board.home(at=0.0)
        together, problems = threading.Barrier(3), []

        def start(value):
            together.wait(10)
            try:
                board.start(LEAN(k=0, push=value))
            except PaddleError as problem:
                problems.append(problem)

        threads = [threading.Thread(target=start, args=(value,)) for value in (0.1, 0.2, 0.3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(30)
        board.wait(0.02)
        log = board.stop()
    assert not problems and log.fault is None
    assert np.allclose(log.F, log.parameters["push"], atol=1e-7) and len(log) >= 20
