"""A paddle behind the protocol, over lines that lose, and with people who interrupt."""

import threading

import numpy as np
import pytest
from bad_line import Peer, is_ack, lossy_port
from host_driver import fixed

from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.upload import upload
from hapticlab.device.link.messages import STATES
from hapticlab.errors import LinkError, PaddleError, PortError
from hapticlab.scene.notation.symbols import n, parameters, x
from hapticlab.scene.scene import Scene

k, push = parameters("k push", units="N/m N")
LEAN = Scene(force=k * x(n) + push, name="lean")


def paddle(home=True, **judges):
    port = lossy_port(**judges)
    made = SerialPaddle("sim://hapkit", port=port)
    if home:
        made.home(at=port.handle.x)
    return made


def state_of(board):
    return {number: name for name, number in STATES.items()}[board.state()["state"]]


def nth(number, judge):
    """Lose the number-th frame that the judge knows, once."""
    seen = 0

    def keep(frame):
        nonlocal seen
        if judge(frame):
            seen += 1
            return seen != number
        return True

    return keep


def test_every_frame_of_a_run_may_be_lost_once():
    """Each request, and each reply, one by one: the run is whole all the same."""
    for number in range(1, 16):
        for way in ("told", "heard"):
            with paddle(home=False, **{way: nth(number, lambda f: f is None or f.message not in ("SAMPLE", "FAULTED"))}) as board:
                board.home(at=0.0)
                log = board.run(LEAN(k=10, push=0.01), duration=0.05)
                assert len(log) == 50 and not log.gap.any() and log.fault is None
                assert np.allclose(log.F, np.float32(10) * log.x + 0.01, atol=1e-6)


@pytest.mark.parametrize("number", [1, 2, 20, 50])
def test_a_lost_sample_is_a_gap(number):
    with paddle(heard=nth(number, lambda f: f.message == "SAMPLE")) as board:
        log = board.run(LEAN(k=10, push=0.0), duration=0.1)
    assert len(log) == 99 and log.gap.sum() == (number < 100) and log.gap[number - 1]


def test_a_fault_whose_report_is_lost_ends_the_run_even_so():
    with paddle(heard=lambda f: f.message != "FAULTED") as board:
        log = board.run(fixed(over=1e-3), duration=1.0)  # x = 0 at once
        assert "NOT_FINITE: the scene computed nan or infinity" in log.fault
        assert state_of(board) == "IDLE"
        assert board.run(LEAN(k=10, push=0.0), duration=0.01).fault is None


def test_a_start_whose_answer_never_comes_leaves_no_motor_running():
    with paddle(heard=lambda f: not is_ack(f, "START")) as board:
        with pytest.raises(LinkError, match="does not answer START"):
            board.start(LEAN(k=10, push=0.1))
        assert state_of(board) == "IDLE" and board.exchange.port.board.duty == 0 and not board.exchange.beating
        with pytest.raises(PaddleError, match="no scene is running"):
            board.stop()


def test_a_refused_start_leaves_the_earlier_run_as_it_was():
    with paddle() as board:
        board.start(LEAN(k=10, push=0.1))
        board.wait(0.05)
        with pytest.raises(LinkError, match="BUSY") as refusal:
            board.start()
        assert refusal.value.result == "BUSY"
        board.wait(0.05)
        log = board.stop()
    assert len(log) >= 100 and log.scene == "lean" and log.fault is None


def test_a_run_that_is_interrupted_stops_the_motor(monkeypatch):
    with paddle() as board:

        def interrupt(condition, seconds):
            assert board.exchange.port.board.duty != 0 or board.exchange.port._tick() is None
            raise KeyboardInterrupt

        monkeypatch.setattr(board.exchange, "wait", interrupt)
        with pytest.raises(KeyboardInterrupt):
            board.run(LEAN(k=10, push=0.1), duration=1.0)
        assert board.exchange.port.board.duty == 0 and state_of(board) == "IDLE" and not board.exchange.beating


def test_a_new_scene_in_a_run_takes_over_and_its_record_begins_at_0():
    with paddle() as board:
        board.start(LEAN(k=10, push=0.1))
        board.wait(0.3)
        board.start(LEAN(k=20, push=-0.1))
        board.wait(0.1)
        log = board.stop()
    assert log.t[0] == 0 and len(log) >= 100 and not log.gap.any()
    assert np.allclose(log.F, 20 * log.x - 0.1, atol=1e-6)


def test_a_damaged_upload_leaves_the_old_scene_running(monkeypatch):
    def damaged(exchange, target, data):
        return upload(exchange, target, data[:40] + bytes([data[40] ^ 1]) + data[41:])

    with paddle() as board:
        board.start(LEAN(k=10, push=0.1))
        board.wait(0.05)
        monkeypatch.setattr("hapticlab.device.board.run.upload", damaged)
        with pytest.raises(LinkError, match="CRC"):
            board.start(LEAN(k=20, push=-0.1))
        assert state_of(board) == "RUN"
        board.set(push=0.2)  # and it is the old one that is set
        board.wait(0.05)
        log = board.stop()
    tick = round(log.changes[0][0] / log.T)
    assert np.allclose(log.F, 10 * log.x + np.where(np.arange(len(log)) < tick, 0.1, 0.2), atol=1e-6) and log.fault is None


def test_a_reset_in_a_run_is_told():
    with paddle() as board:
        port = board.exchange.port
        board.start(LEAN(k=10, push=0.1))
        board.wait(0.01)
        port.put_on(None)
        with pytest.raises(LinkError, match="was reset while the scene ran, and its motor is off"):
            board.wait(0.5)


def test_set_takes_effect_in_the_tick_that_the_record_names():
    with paddle() as board:
        board.start(LEAN(k=0, push=0.0))
        for value in (0.1, 0.2, 0.3):
            board.wait(0.02)
            board.set(k=0.0, push=value)
        board.wait(0.02)
        log = board.stop()
    for when, values in log.changes:
        tick = round(when / log.T)
        assert log.F[tick] == np.float32(values["push"]) and log.F[tick - 1] != log.F[tick]
    assert len(log.changes) == 3


# ---------------------------------------------------------------- over a socket, with the reader's thread


def test_heartbeats_keep_a_run_alive_while_nobody_asks():
    peer = Peer()
    with SerialPaddle(peer.url) as board:
        board.home(at=0.0)
        log = board.run(LEAN(k=10, push=0.1), duration=0.5)
    assert len(log) == 500 and log.fault is None and not log.gap.any()
    assert peer.ended.wait(10)


@pytest.mark.parametrize("number", [3, 6, 9, 11, 13])
@pytest.mark.always("6", "13")
def test_a_dropped_frame_is_said_again(number):
    peer = Peer(told=nth(number, lambda f: True))
    with SerialPaddle(peer.url) as board:
        board.home(at=0.0)
        assert board.run(LEAN(k=10, push=0.1), duration=0.05).fault is None
    assert peer.ended.wait(10)


def test_closing_while_it_runs_stops_the_motor():
    peer = Peer()
    with SerialPaddle(peer.url) as board:
        board.home(at=0.0)
        board.start(LEAN(k=10, push=0.1))
        board.wait(0.05)
    assert peer.ended.wait(10) and peer.board.duty == 0
    assert not board.exchange._reader.is_alive()


def test_a_device_that_leaves_ends_the_run_in_words():
    peer = Peer()
    board = SerialPaddle(peer.url)
    board.home(at=0.0)
    board.start(LEAN(k=10, push=0.1))
    board.wait(0.02)
    peer.leave.set()
    with pytest.raises(PortError, match=r"the device disconnected during use \(read failed:") as left:
        board.wait(30)
    assert left.value.cause == "left"
    with pytest.raises(PortError):
        board.set(k=11)
    with board.exchange.port._socket:  # pyserial does not close the socket of a device that has left
        board.close()
    assert peer.ended.wait(10) and not board.exchange._reader.is_alive()


def test_two_threads_that_set_at_once_leave_one_truth():
    peer = Peer()
    with SerialPaddle(peer.url) as board:
        board.home(at=0.0)
        board.start(LEAN(k=0, push=0.0))
        together, failures = threading.Barrier(2), []

        def turn(first):
            together.wait(10)
            try:
                for step in range(30):
                    board.set(k=float(first + step), push=(first + step) / 1000)
            except PaddleError as problem:
                failures.append(problem)

        threads = [threading.Thread(target=turn, args=(first,)) for first in (100, 200)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(30)
        board.wait(0.01)
        known = dict(zip((c.name for c in board._loaded.program.parameters), board._loaded.program.values, strict=True))
        log = board.stop()
    assert not failures and len(log.changes) == 60
    assert log.F[-1] == np.float32(known["push"]) and log.parameters["k"] in (known["k"], 0.0)
    assert known["k"] == round(known["push"] * 1000)
    given = {np.float32(c["push"]) for _, c in log.changes} | {np.float32(0)}
    assert {np.float32(F) for F in log.F} <= given
