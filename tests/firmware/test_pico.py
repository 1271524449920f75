"""What only a Pico has: its USB, its flash, two programs at once, pins that wait for a confirmed wiring."""

import numpy as np
import pytest
from faults import assert_off_in_time
from pico_emulator import POWER, Pico, missing
from pico_faults import PICO_FAULTS, measure
from pico_loop import PaddleHandle, emulated_pico, flash_of, hapkit, loop_of, offer

import hapticlab as hl
from hapticlab import n, x
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import changed
from hapticlab.device.board.upload import read_settings, upload
from hapticlab.device.link.messages import FAULTS as NAMES
from hapticlab.device.link.messages import RESET_CAUSES
from hapticlab.device.link.wire import Decoder, encode
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import HapticlabError, LinkError

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
K, x_o = hl.parameters("K x_o", units="N/m m")
SPRING = hl.Scene(force=K * (x(n) - x_o), name="spring")
HAND = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.004 * np.sin(9 * t))
PWM, DIRECTION = 2, 3


def again(loop, **options):
    """Connect to the same board once more."""
    return SerialPaddle(offer(f"again{id(loop)}", loop), **options)


@pytest.mark.parametrize("name", PICO_FAULTS)
@pytest.mark.always("host silent")
def test_the_motor_is_off_in_time(name, record_property):
    assert_off_in_time(name, PICO_FAULTS[name], *measure(PICO_FAULTS[name]), record_property)


def test_every_fault_that_a_board_can_have_is_injected():
    assert {fault.says for fault in PICO_FAULTS.values()} - {None} == set(NAMES)


@pytest.mark.wide
def test_two_frames_in_one_packet_are_both_answered():
    """The controller keeps the rest of a packet back while the first frame is not answered."""
    with emulated_pico() as paddle:
        board, tokens = paddle.loop.board, []
        board.read()
        board.write(b"".join(encode("PING", k, 100 + k) for k in range(4)))
        board.run(0.01)
        tokens = [frame.fields["token"] for frame in Decoder().feed(board.read())]
        facts = board.facts
    assert tokens == [100, 101, 102, 103]
    assert facts["usb"]["errors"] == [] and facts["usb"]["strings"]


@pytest.mark.wide
def test_ten_kilohertz_of_telemetry_wait_for_a_busy_computer():
    """20 ms without a word from the host: the board's ring holds them; 60 ms: they are counted, and nothing else is lost."""
    with emulated_pico(HAND, T=100e-6) as paddle:
        for away, lost in ((20e-3, False), (60e-3, True)):
            paddle.start(SPRING(K=50, x_o=0.03), every=1)
            paddle.wait(0.02)
            paddle.loop.board.listen(False)
            paddle.loop.run(away)
            paddle.loop.board.listen(True)
            paddle.wait(0.02)
            log, timing = paddle.stop(), paddle.timing
            print(
                f"10 kHz, host away for {1e3 * away:.0f} ms: {len(log)} samples, {timing.lost} lost, {timing.overruns} overruns"
            )
            assert log.fault is None and timing.overruns == 0
            assert (timing.lost > 0) == log.gap.any() == lost
            ticks = round(log.t[-1] / 100e-6) + 1
            assert 0 <= len(log) + timing.lost - ticks <= 5, "what is lost is counted"


@pytest.mark.wide
def test_a_new_scene_takes_over_between_two_ticks():
    with emulated_pico(HAND) as paddle:
        board = paddle.loop.board
        paddle.start(SPRING(K=50, x_o=0.03))
        paddle.wait(0.05)
        begun = board.cycle
        paddle.start(
            SPRING(
                K=80,
                x_o=0.03,
            )
        )
        paddle.wait(0.05)
        cycles, duties = board.duties()
        ended = board.cycle
        log, timing = paddle.stop(), paddle.timing
    driven = duties[(cycles > begun) & (cycles < ended)]
    assert log.fault is None and timing.overruns == 0
    assert len(driven) > 20 and (driven != 0).all(), "the motor was never off in between"
    assert np.abs(np.diff(driven)).max() < 0.5 * np.abs(driven).max()


@pytest.mark.wide
@pytest.mark.parametrize(("operation", "part"), [(0, 0.02), (0, 0.9), (1, 0.5), (1, 0.98)])
def test_a_cut_in_the_middle_of_writing_leaves_the_settings_before(operation, part):
    """Operation 0 erases the sector, 1 programs it."""
    old, new = hapkit(), hapkit(m=0.123)
    with emulated_pico(settings=old) as paddle:
        loop, board = paddle.loop, paddle.loop.board
        board.cut_power(operation, part)
        with pytest.raises(HapticlabError):
            upload(paddle.exchange, "SETTINGS", new.to_bytes())
        assert board.halted == "off" and board.duty == 0
        board.reset(POWER)
        with again(loop) as anew:
            assert read_settings(anew.exchange) == old.to_float32()
            upload(anew.exchange, "SETTINGS", new.to_bytes())
            assert read_settings(anew.exchange) == new.to_float32()
        board.reset(POWER)
        with again(loop) as third:
            assert third.settings == new.to_float32() and third.board["reset_cause"] == RESET_CAUSES["POWER"][0]
        assert board.facts["violations"] == []


@pytest.mark.wide
def test_plugged_in_again_it_answers_with_the_motor_off():
    with emulated_pico(HAND) as paddle:
        loop, board = paddle.loop, paddle.loop.board
        paddle.start(SPRING(K=50, x_o=0.03), check_fit=False)
        paddle.wait(0.02)
        board.attach(False)
        loop.run(0.15)
        assert board.duty == 0
        board.attach(True)
        loop.run(0.03)
        assert board.configured and board.duty == 0
        with again(loop) as anew:
            assert any("HOST_SILENT" in notice for notice in anew.notices)
            assert anew.run(SPRING(K=50, x_o=0.03), duration=0.02, progress=False).fault is None


@pytest.mark.wide
def test_pins_of_the_motor_rest_until_the_wiring_is_confirmed():
    unconfirmed = hapkit(wired=0, checked=0)
    with emulated_pico(settings=unconfirmed) as paddle:
        board = paddle.loop.board
        assert board.levels(PWM, DIRECTION) == [None, None]
        with pytest.raises(LinkError, match="NOT_WIRED|wiring"):
            paddle.start(SPRING(K=50, x_o=0.03))
        assert board.levels(PWM, DIRECTION) == [None, None]
        upload(paddle.exchange, "SETTINGS", changed(unconfirmed, wired=1).to_bytes())
        assert board.levels(PWM, DIRECTION) == [0, 0], "driven low"


@pytest.mark.wide
def test_the_watchdog_is_the_cause_that_is_told_after_it_bit():
    with emulated_pico(HAND) as paddle:
        loop = paddle.loop
        paddle.start(SPRING(K=50, x_o=0.03), check_fit=False)
        PICO_FAULTS["tick stops"].inject(paddle)
        loop.run(0.2)
        with again(loop) as anew:
            assert anew.board["reset_cause"] == RESET_CAUSES["WATCHDOG"][0] and not anew.state()["flags"] & 1


@pytest.mark.wide
def test_a_port_closed_at_1200_baud_asks_for_the_drive():
    with Pico(flash=flash_of(hapkit())) as board:
        loop = loop_of(hapkit(), board, PaddleHandle(SimulatedPaddle.from_profile("hapkit")))
        loop.run_until(lambda: board.configured, 0.1)
        board.open_port(1200)
        board.run(0.002)
        board.close_port()
        board.run(0.002)
        assert board.halted == "the ROM's drive RPI-RP2 appears" and board.duty == 0


@pytest.mark.wide
def test_firmware_of_another_version_names_the_board_to_flash(monkeypatch):
    monkeypatch.setattr("hapticlab.device.board.greeting.table_hash", lambda: 1)
    with pytest.raises(LinkError, match="hapticlab flash --board pico"), emulated_pico():
        pass
