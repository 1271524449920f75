"""A computer that slept, a process that was stopped: the board switches its motor off, and the host says why in these words."""

import os
import queue
import signal
import subprocess
import sys
import textwrap
import threading
from contextlib import suppress

import pytest
import serial

from hapticlab.device.board.run import fault_words
from hapticlab.device.link import presence
from hapticlab.device.link.exchange import Exchange
from hapticlab.device.link.messages import FAULTS
from hapticlab.device.link.presence import LONGEST_PAUSE, Presence
from hapticlab.device.link.serial_ports import open_port
from hapticlab.device.link.wire import decode, encode
from hapticlab.errors import PortError


class FakePort:
    """A port whose reads wait for what a test puts into it, and a clock that only a test moves on."""

    port, is_open, write_timeout, in_waiting = "/dev/fake", True, 1, 0

    def __init__(self, slept_in_write=0.0):
        self.coming, self.time, self.written, self.slept_in_write = queue.Queue(), 0.0, [], slept_in_write

    def read(self, size):
        came = self.coming.get()
        if isinstance(came, Exception):
            raise came
        return came

    def write(self, data):
        self.written.append(data)
        if len(self.written) == 1 and self.slept_in_write is not None:
            self.time += self.slept_in_write
            raise serial.SerialTimeoutException("Write timeout")
        frame = decode(data[:-1])
        self.coming.put(encode("PONG", frame.sequence, 5))

    def close(self):
        self.is_open = False


def exchange_on(port):
    port.coming.put(b"")  # the reader's first round
    exchange = Exchange(port)
    exchange.presence = Presence(lambda: port.time)
    return exchange


def ended(port, exchange):
    exchange.closed = True
    port.coming.put(b"")
    exchange.close()


def test_a_write_that_ran_out_of_time_in_a_sleep_is_a_frame_lost():
    """Its port is sound, so the request is repeated as any lost one is."""
    port = FakePort(slept_in_write=7.0)
    exchange = exchange_on(port)
    assert exchange.ask("PING", 5).fields == {"token": 5} and len(port.written) == 2 and port.written[0] == port.written[1]
    assert exchange.absent() == pytest.approx(7.0)
    ended(port, exchange)


@pytest.mark.parametrize("blocked_for", [0.0, 1.0, 1.05])
def test_a_write_that_ran_out_of_time_awake_is_a_port_that_is_blocked(blocked_for):
    """It takes the second that a write may take, and a little more; also after an earlier sleep."""
    port = FakePort(slept_in_write=blocked_for)
    exchange = exchange_on(port)
    port.time += 50.0
    exchange.presence.note()
    with pytest.raises(PortError, match=r"accepted no data for 1 s; plug it in again") as blocked:
        exchange.ask("PING", 5)
    assert blocked.value.cause == "silent" and len(port.written) == 1
    ended(port, exchange)


@pytest.mark.parametrize("slept", [0.0, 0.5 * LONGEST_PAUSE, 3600.0])
def test_a_port_that_went_while_the_computer_slept(slept):
    port = FakePort(slept_in_write=None)
    exchange = exchange_on(port)
    exchange.ask("PING", 5)
    port.time += slept
    port.coming.put(serial.SerialException("device reports readiness to read but returned no data"))
    assert exchange._reader.join(10)
    with pytest.raises(PortError) as gone:
        exchange.check()
    if slept > LONGEST_PAUSE:
        assert gone.value.cause == "slept" and "HOST_SILENT: the computer slept" in str(gone.value)
        assert "for 3.6e+03 s" in str(gone.value) and "switched its motor off" in str(gone.value)
        assert "Connect again" in str(gone.value)
    else:
        assert gone.value.cause == "left" and "plug it in again" in str(gone.value)
    exchange.close()


def test_absence_counts_from_the_last_start_and_ends_with_the_reader():
    clock = iter([0.0, 0.05, 2.0, 2.05, 2.1, 9.0, 9.1])
    presence = Presence(lambda: next(clock))
    presence.note()
    presence.note()  # 1.95 s later
    presence.note()
    assert presence.absent() == 1.95
    presence.forget()
    presence.end()  # from then on nobody is to call
    assert presence.absent() == 0.0


def test_a_clock_that_has_a_number_and_is_not_there_is_passed_over(monkeypatch):
    """As CLOCK_BOOTTIME in a browser."""
    monkeypatch.setattr(presence.time, "CLOCK_BOOTTIME", 7, raising=False)
    monkeypatch.setattr(presence.time, "CLOCK_MONOTONIC", 1, raising=False)

    def read(number):
        if number == 7:
            raise OSError(28, "Invalid argument")
        return 3.0

    monkeypatch.setattr(presence.time, "clock_gettime", read, raising=False)
    assert [*presence._clocks()] == [1]


def test_the_fault_says_it():
    silent = {"fault": FAULTS["HOST_SILENT"][0], "tick": 40}
    assert "Check the cable" in fault_words(silent | {"absent": 0.0}) and "Check the cable" in fault_words(silent)
    told = fault_words(silent | {"absent": 2.0}, 1e-3)
    assert told.endswith("The computer slept, or this program was stopped or too busy, for 2 s; start the scene again.")
    assert "slept" not in fault_words({"fault": FAULTS["OVER_SPEED"][0], "tick": 4, "absent": 2.0})


HOST = """
import hapticlab as hl
paddle = hl.connect({name!r})
paddle.home(at=0.0)
paddle.start(hl.wall()(k=50, x_o=0.01))
print("running", flush=True)
while paddle.under_way.fault is None:
    paddle.exchange.wait(lambda: paddle.under_way.fault, 0.01)
print(paddle.stop().fault)
paddle.start(hl.wall()(k=50, x_o=0.01))
paddle.wait(0.05)
print(paddle.stop().fault)
paddle.close()
"""


@pytest.mark.wide
@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="this system cannot stop a process")
def test_a_process_that_was_stopped():
    """A real host on a terminal, stopped and continued; the board behind runs on by the clock."""
    import pty
    import tty

    port, (ours, theirs) = open_port("sim://hapkit?pace=real"), pty.openpty()
    for end in (ours, theirs):
        tty.setraw(end)
    os.set_blocking(ours, False)  # what nobody reads is lost, as on USB
    port.timeout, ended = 0.002, threading.Event()
    carrier = threading.Thread(target=_carry, args=(port, ours, ended))
    carrier.start()
    code = textwrap.dedent(HOST.format(name=os.ttyname(theirs)))
    host = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    try:
        assert host.stdout.readline() == "running\n"
        host.send_signal(signal.SIGSTOP)
        until = port.now() + 4 * LONGEST_PAUSE
        while port.now() < until:
            assert not ended.wait(0.005)
        host.send_signal(signal.SIGCONT)
        told, after = host.communicate(timeout=60)[0].splitlines()
    finally:
        host.kill()
        ended.set()
        carrier.join()
        port.close()
        os.close(ours), os.close(theirs)
    assert "HOST_SILENT" in told and "The computer slept, or this program was stopped or too busy, for 0." in told
    assert "plug" not in told and after == "None"


def _carry(port, terminal, ended):
    while not ended.is_set():
        with suppress(BlockingIOError):
            port.write(os.read(terminal, 4096))
        with suppress(BlockingIOError):
            os.write(terminal, port.read(max(1, port.in_waiting)))
