"""The firmware's core behaves: what it refuses, what stops it, what survives a bad link. Time is counted in its ticks."""

import math
import struct
import zlib

import numpy as np
import pytest
from host_driver import Host, fault_name, fixed, result_name, settings, spring, state_name

from hapticlab.compiler.engines.bytecode import encode as encode_program
from hapticlab.compiler.engines.bytecode import layout
from hapticlab.compiler.tick.compile_scene import compile
from hapticlab.device.board.host_board import HostBoard
from hapticlab.device.board.run import fault_words
from hapticlab.device.board.settings import Settings
from hapticlab.device.link.messages import SENSORS, SETTINGS_STRUCT
from hapticlab.device.link.wire import encode
from hapticlab.scene.notation.symbols import n, parameters, x
from hapticlab.scene.scene import Scene

#: behind two copies of the settings: whether a program is armed, two bytes of its size, the program
STORE_ARMED = 2 * SETTINGS_STRUCT.size
STORE_PROGRAM = STORE_ARMED + 4

# ---------------------------------------------------------------- sessions and sequence


def test_a_frame_of_another_session_is_refused_and_moves_nothing():
    host = Host().ready()
    stranger = Host(host.board, session=999)
    stranger.sent[True] = 50
    assert stranger.start(crc=host.crc) == "GUARD"
    assert host.start() == "OK"


def test_a_new_session_finds_nothing_loaded_and_no_parameters():
    host = Host().running()
    host.tick(1000, 5)
    other = Host(host.board, session=7)
    other.hello()
    assert host.board.duty == 0 and state_name(other.state()["state"]) == "IDLE"
    assert not other.has("READY") and other.has("HOMED")
    assert other.start(crc=host.crc) == "NO_PROGRAM"
    assert other.set(_0=1.0) == "NO_PROGRAM"


def test_a_repeated_hello_lets_no_older_request_in():
    """A line that repeats what was said: the session's own hello, then its START, after the STOP."""
    host = Host().ready()
    hello, start = encode("HELLO", 1, host.session), host.frame("START", host.crc, 1, 0, 1.0)
    assert result_name(host.give(start)[0].fields["result"]) == "OK"
    assert host.tick(1000) != 0
    assert host.ask("STOP") == "OK"
    for _ in range(3):
        host.give(hello)
        (reply,) = host.give(start)
        assert result_name(reply.fields["result"]) == "STALE"
        assert host.tick(1000) == 0 and state_name(host.state()["state"]) == "IDLE"


def test_a_repeated_hello_changes_nothing_in_an_upload_or_a_run():
    host = Host().running()
    host.give(encode("HELLO", 1, host.session))
    assert state_name(host.state()["state"]) == "RUN" and host.has("READY")


def test_a_start_that_comes_after_a_later_stop_is_refused():
    host = Host().ready()
    start, stop = host.frame("START", host.crc, 1, 0, 1.0), host.frame("STOP")
    assert result_name(host.give(stop)[0].fields["result"]) == "OK"
    assert result_name(host.give(start)[0].fields["result"]) == "STALE"
    assert host.tick(1000) == 0
    assert host.start() == "OK"


@pytest.mark.parametrize("frame", [
    encode("STOP", 200, session=1), encode("STOP", 1, session=12345), encode("STOP", 1, rest=b"more")])  # fmt: skip
def test_a_stop_is_obeyed_whoever_says_it(frame):
    host = Host().running()
    assert host.tick(1000) != 0
    host.give(frame)
    assert host.board.duty == 0 and state_name(host.state()["state"]) == "IDLE"
    assert host.set(_0=5.0) == "OK"  # and the sequence is what it was


def test_a_repeat_is_answered_as_it_was_and_not_done_again():
    host = Host().ready()
    start = host.frame("START", host.crc, 1, 0, 1.0)
    assert [result_name(host.give(start)[0].fields["result"]) for _ in range(3)] == ["OK"] * 3
    refused = host.frame("START", host.crc, 1, 0, 1.0)
    assert [result_name(host.give(refused)[0].fields["result"]) for _ in range(2)] == ["BUSY"] * 2
    host.ask("STOP")
    assert result_name(host.give(refused)[0].fields["result"]) == "STALE"


def test_an_old_set_does_not_come_back_however_often_the_sequence_turns_over():
    """8 bits count to 256; the guard takes in how often they turned over."""
    host = Host().running()
    frames = [host.frame("SET", 1, rest=b"\0" + np.float32(k).tobytes()) for k in range(600)]
    for k, frame in enumerate(frames):
        assert result_name(host.give(frame)[0].fields["result"]) == "OK"
        for old in range(0, k, 37):
            (reply,) = host.give(frames[old])
            assert result_name(reply.fields["result"]) in ("STALE", "GUARD"), (k, old)
    host.tick(1000)
    assert struct.unpack("<fff", host.frames[-1].payload[5:])[2] == np.float32(4.0)  # 599 N/m * 1 cm, saturated


def test_lost_requests_leave_gaps_that_do_not_matter():
    host = Host().ready()
    for _ in range(9):
        for _ in range(100):
            host.frame("CLEAR")
        assert host.set(_0=1.0) == "OK"


def test_a_boards_own_words_looped_back_are_no_host():
    host = Host().running()
    for _ in range(150):
        host.board.tick(0, host.t)
        host.t += 1e-3
        said = host.board.transmit()
        host.decoder.feed(said)
        host.board.receive(said)
    assert state_name(host.state()["state"]) == "FAULT" and fault_name(host.state()["fault"]) == "HOST_SILENT"


def test_a_second_frame_while_the_first_waits_is_lost_whole():
    """The board has no room to answer: what comes meanwhile is dropped to its end, and then it hears again."""
    host = Host().ready()
    ping = encode("PING", 1, 7)
    for _ in range(6000):  # until nothing more fits into its output
        host.board.receive(ping)
    host.board.receive(ping + ping[: len(ping) // 2])
    heard = 0
    for _ in range(5):
        heard += len(host.hear())
        host.tick()
    host.board.receive(ping[len(ping) // 2 :] + ping)
    assert [f.message for f in host.hear()][-1] == "PONG"


# ---------------------------------------------------------------- uploads


def test_begin_of_another_target_between_data_and_commit_commits_nothing():
    host = Host().ready()
    data = encode_program(spring(), word_bits=16)
    host.ask("BEGIN", 0, len(data))
    for at in range(0, len(data), 40):
        host.ask("DATA", at, rest=data[at : at + 40])
    host.ask("BEGIN", 2, len(data))
    assert host.ask("COMMIT", 0, len(data), zlib.crc32(data[:-4])) == "NO_PROGRAM"


def test_hello_in_an_upload_ends_it():
    host = Host()
    host.hello()
    data = encode_program(spring(), word_bits=16)
    host.ask("BEGIN", 0, len(data))
    other = Host(host.board, session=4)
    other.hello()
    assert other.ask("DATA", 0, rest=data[:40]) == "RANGE"
    assert other.ask("COMMIT", 0, len(data), 0) == "NO_PROGRAM"


def test_data_after_commit_and_beyond_the_end_and_commit_after_a_reset():
    host = Host().ready()
    assert host.ask("DATA", 0, rest=b"xx") == "RANGE"
    host.ask("BEGIN", 0, 100)
    assert [host.ask("DATA", at, rest=b"x" * 10) for at in (90, 91, 100, 101, 65535)] == ["OK", *["RANGE"] * 4]
    answers = {0: "SIZE", 4: "SIZE", 32768: "OK", 32769: "TOO_LARGE", 65535: "TOO_LARGE"}
    assert {size: host.ask("BEGIN", 0, size) for size in answers} == answers
    assert host.ask("BEGIN", 3, 10) == "RANGE"
    assert host.ask("BEGIN", 2, 4096 - STORE_PROGRAM + 1) == "TOO_LARGE"
    reset = Host(HostBoard(host.board.store), session=host.session)
    reset.sent = dict(host.sent)
    assert reset.ask("COMMIT", 0, 100, 0) == "GUARD"


def test_pieces_in_any_order_and_repeated_make_the_program_and_a_missing_one_does_not():
    data = encode_program(spring(), word_bits=16)
    assert len(data) > 40
    for missing in (None, 0, 40):
        host = Host()
        host.hello()
        host.ask("BEGIN", 0, len(data))
        offsets = [at for at in range(0, len(data), 40) if at != missing]
        for at in [*reversed(offsets), *offsets]:
            host.ask("DATA", at, rest=data[at : at + 40])
        wanted = "OK" if missing is None else "CRC"
        assert host.ask("COMMIT", 0, len(data), zlib.crc32(data[:-4])) == wanted
        assert host.start(crc=struct.unpack("<I", data[-4:])[0]) == ("NO_VALUE" if missing is None else "NO_PROGRAM")


# ---------------------------------------------------------------- what START needs


def two_parameters():
    """F = k x + push."""
    k, push = parameters("k push", units="N/m N")
    return compile(Scene(force=k * x(n) + push, name="two"), T=1e-3, velocity="backward_difference")


def test_start_is_refused_until_everything_is_known():
    host = Host(HostBoard())  # a new board: no calibration
    host.hello()
    host.tick()
    host.load(two_parameters())
    assert host.start() == "NO_VALUE"
    assert host.set(_0=1.0) == "OK" and host.start() == "NO_VALUE"
    assert host.set(_1=1.0) == "OK" and host.start() == "NOT_CALIBRATED"
    assert host.ask("HOME", 0.0) == "NOT_CALIBRATED"
    assert host.load(settings(wired=0, checked=0).to_bytes(), "SETTINGS") == "OK"
    assert host.start() == "NO_PROGRAM"  # settings pass through the place of a program
    assert host.load(two_parameters()) == "OK" and host.set(_0=1.0, _1=1.0) == "OK"
    assert host.start() == "NOT_WIRED"
    assert host.load(settings().to_bytes(), "SETTINGS") == "OK"
    assert host.load(two_parameters()) == "OK" and host.set(_0=1.0, _1=1.0) == "OK"
    assert host.start() == "NOT_HOMED"
    assert [host.ask("HOME", at) for at in (math.nan, math.inf, 0.0501, -0.0501, 0.05)] == ["RANGE"] * 4 + ["OK"]
    assert host.start(crc=host.crc ^ 1) == "NO_PROGRAM"
    assert host.start(every=0) == "RANGE"
    assert [host.start(force_max=a) for a in (math.nan, math.inf, -1.0)] == ["RANGE"] * 3
    assert host.start() == "OK"
    assert host.start() == "BUSY"
    assert host.ask("HOME", 0.0) == "BUSY" and host.ask("ARM", 1) == "BUSY"
    assert host.load(settings().to_bytes(), "SETTINGS") == "BUSY"


@pytest.mark.parametrize("T, result", [(50e-6, "OK"), (30e-3, "OK"), (49e-6, "RANGE"), (30.001e-3, "RANGE")])
def test_a_period_out_of_the_timers_range_is_refused(T, result):
    host = Host().ready(spring(T=T), _0=1.0)
    assert host.start() == result
    assert host.board.period == (T if result == "OK" else 1e-3)


def test_values_that_are_not_finite_and_parameters_that_are_not_there_are_refused_whole():
    host = Host().ready(two_parameters(), _0=100.0, _1=0.0)
    host.start()
    for bad in (math.nan, math.inf, -math.inf):
        assert host.set(_0=500.0, _1=bad) == "NO_VALUE"
    assert host.set(_0=500.0, _2=1.0) == "RANGE"
    assert host.ask("SET", 2, rest=b"\0" * 5) == "LENGTH"
    assert host.tick(1000) == pytest.approx(-1.0 / 8, abs=1e-4)  # still 100 N/m on 1 cm


def test_passive_never_drives_the_motor_and_needs_no_home():
    host = Host()
    host.hello()
    host.load(fixed(5.0))
    assert host.start(passive=1) == "OK"
    for k in range(300):
        assert host.tick(100 * k, beat=True) == 0  # far outside the travel, and fast
    F = [struct.unpack_from("<f", frame.payload, 13)[0] for frame in host.samples]
    assert len(F) == 300 and not any(F)
    assert state_name(host.state()["state"]) == "RUN"


def test_a_switch_to_passive_ends_the_force_at_once():
    host = Host().running()
    assert host.tick(500) != 0
    host.load(fixed(1.0))
    assert host.board.duty != 0
    assert host.start(passive=1) == "OK"
    assert host.board.duty == 0 and host.tick(500) == 0


# ---------------------------------------------------------------- two places, one place


def values_of(host):
    return [struct.unpack_from("<If", f.payload, 0)[0] for f in host.samples]


def test_the_old_program_runs_bit_for_bit_until_the_tick_of_the_switch():
    host, alone = Host(speed_max=1e3).running(_0=100.0), Host(speed_max=1e3).running(_0=100.0)
    path = [round(2000 * math.sin(0.1 * k)) for k in range(60)]
    new = spring(dtype="float32")
    data = encode_program(new, word_bits=16)
    assert host.board.transmit() == alone.board.transmit() == b""
    upload = [host.frame("BEGIN", 0, len(data))]
    upload += [host.frame("DATA", at, rest=data[at : at + 4]) for at in range(0, len(data), 4)]
    upload += [host.frame("COMMIT", 0, len(data), zlib.crc32(data[:-4]))]
    upload += [host.frame("SET", 1, rest=b"\0" + struct.pack("<f", -50))]
    for k, counts in enumerate(path):
        if k < len(upload):
            (reply,) = host.give(upload[k])
            assert reply.fields["result"] == 0
        assert host.tick(counts, beat=True) == alone.tick(counts, beat=True)
    assert len(upload) < len(path)
    assert [f.payload for f in host.samples] == [f.payload for f in alone.samples]
    assert host.start() == "OK"
    assert host.tick(1000) == pytest.approx(0.5 / 8, abs=1e-4)  # -50 N/m on 1 cm: the motor gives -F
    tick, flags = struct.unpack_from("<IB", host.samples[-1].payload)
    assert (tick, flags) == (0, 4)


@pytest.mark.parametrize("damage", [
    lambda data: data[:-1], lambda data: data[:20] + bytes([data[20] ^ 1]) + data[21:], lambda data: data[::-1]])  # fmt: skip
def test_a_damaged_upload_leaves_the_old_program_running(damage):
    host = Host(speed_max=1e3).running(_0=100.0)
    assert host.load(spring(K=7.0), damage=damage) == "CRC"
    assert host.start() in ("NO_PROGRAM", "BUSY")
    assert host.tick(1000) == pytest.approx(-1.0 / 8, abs=1e-4)
    assert host.set(_0=200.0) == "OK"
    assert host.tick(1000) == pytest.approx(-2.0 / 8, abs=1e-4)


@pytest.mark.wide
def test_an_upload_that_lost_its_pieces_is_not_the_one_of_before():
    """One place, the bytes of an earlier program of the same length still in it; every CRC-32 in it is right."""
    host = Host(HostBoard(settings(speed_max=1e3).to_bytes(), slots=1))
    host.hello()
    first, second = (encode_program(fixed(push=push, k=2.0), word_bits=16) for push in (0.25, 0.5))
    assert len(first) == len(second) and zlib.crc32(first) == zlib.crc32(second)  # with the CRC-32 they end with: alike
    assert host.load(first) == "OK"
    assert host.ask("BEGIN", 0, len(second)) == "OK"  # and not one piece arrives
    assert host.ask("COMMIT", 0, len(second), zlib.crc32(second[:-4])) == "CRC"


def test_a_program_that_does_not_verify_is_not_there_even_with_a_right_crc():
    host = Host(speed_max=1e3).running(_0=100.0)
    data = bytearray(encode_program(spring(), word_bits=16)[:-4])
    data[16] = 0  # no registers
    data += struct.pack("<I", zlib.crc32(data))
    assert host.load(bytes(data)) == "REGISTERS"
    assert host.start() == "NO_PROGRAM" or host.start() == "BUSY"
    assert host.tick(1000) == pytest.approx(-1.0 / 8, abs=1e-4)


def test_with_one_place_an_upload_waits_for_the_stop_and_a_damaged_one_leaves_nothing():
    host = Host(HostBoard(settings(speed_max=1e3).to_bytes(), slots=1)).running(_0=100.0)
    old = host.crc
    assert host.hello()["slots"] == 1
    assert host.load(spring(K=7.0)) == "BUSY"
    assert host.tick(1000) == pytest.approx(-1.0 / 8, abs=1e-4)
    host.ask("STOP")
    assert host.start(crc=old) == "OK" and host.ask("STOP") == "OK"  # the old one is still there
    assert host.load(spring(), damage=lambda data: data[:-1] + b"\x55") == "CRC"
    assert host.start() == host.start(crc=old) == "NO_PROGRAM"
    assert host.tick(1000) == 0
    assert host.load(spring()) == "OK" and host.start() == "NO_VALUE" and host.set(_0=1.0) == "OK" and host.start() == "OK"


# ---------------------------------------------------------------- parameters


def test_parameters_set_together_change_in_the_same_sample():
    """F = a - b, set to (k, k) again and again: one of them alone would show as F != 0."""
    a, b = parameters("a b", units="N N")
    program = compile(Scene(force=a - b, name="both"), T=1e-3, velocity="backward_difference")
    host = Host().running(program, _0=1.0, _1=1.0)
    for k in range(200):
        host.set(_0=float(k), _1=float(k) + (k % 3))
        host.tick()
    F = [struct.unpack_from("<f", f.payload, 13)[0] for f in host.samples]
    assert F == [-float(k % 3) for k in range(200)]


# ---------------------------------------------------------------- faults


def stands(host, fault, tick=None):
    """A fault stands: duty 0 now and whatever happens, until CLEAR and START; it was said once, in words there are."""
    state = host.state()
    assert (state_name(state["state"]), fault_name(state["fault"])) == ("FAULT", fault)
    (said,) = host.faults
    assert fault_name(said.fields["fault"]) == fault and said.fields["tick"] == state["tick"]
    assert tick is None or said.fields["tick"] == tick
    assert f"{fault}: " in fault_words(said.fields) and "motor is off" in fault_words(said.fields)
    assert host.board.duty == 0
    for k in range(50):
        assert host.tick(500 + k % 3) == 0
    assert host.start() == "FAULT" and host.ask("HOME", 0.0) == "FAULT" and host.tick() == 0
    assert host.set(_0=1.0) in ("OK", "RANGE") and host.tick() == 0
    assert host.ask("CLEAR") == "OK" and host.tick() == 0
    assert state_name(host.state()["state"]) == "IDLE" and fault_name(host.state()["fault"]) is None


@pytest.mark.parametrize("T, ticks", [(1e-3, 100), (5e-4, 200), (2.5e-4, 400), (1e-2, 10), (3e-2, 3)])
def test_100_ms_without_the_host_are_a_fault(T, ticks):
    """The last word comes just after the tick that hears nothing of it: 100 ms, to one period."""
    host = Host().running(spring(T=T), _0=100.0)
    for _ in range(7):
        host.tick(500, times=max(1, ticks - 1))
        host.state()
    for k in range(ticks):  # the first of these hears the last STATUS
        assert host.tick() != 0, k
    assert host.tick() == 0
    assert host.t - (host.t - (ticks + 1) * T) <= 0.1 + T + 1e-9
    stands(host, "HOST_SILENT")


@pytest.mark.parametrize("noise", [
    b"\0" * 50, b"\x55" * 50 + b"\0", encode("STATUS", 1, 12345)[:-2] + b"\x01\0", encode("ACK", 1, 0, 0, 0)])  # fmt: skip
def test_noise_is_no_host(noise):
    host = Host().running()
    for _ in range(101):
        host.board.receive(noise)
        host.tick(500)
    stands(host, "HOST_SILENT", 100)


@pytest.mark.parametrize("stranger", [("PING", 7), ("PING", 12345), ("READ", 0, 40), ("STATUS", 0), ("STATUS", 999),
                                      ("BEGIN", 0, 100), ("DATA", 0)], ids=str)  # fmt: skip
def test_another_program_on_the_port_keeps_no_scene_driven(stranger):
    """It did: any valid frame was taken for the host's word. Now 100 ms after the session's own last word the motor is off."""
    host = Host().running()
    for k in range(101):
        host.board.receive(encode(stranger[0], k & 255, *stranger[1:]))
        host.tick(500 + k % 3)
    stands(host, "HOST_SILENT", 100)


def test_guarded_frames_of_another_session_or_of_long_ago_keep_nothing_driven_and_ones_own_do():
    host = Host().running(_0=100.0)
    old = host.frame("SET", 1, rest=b"\0" + np.float32(100.0).tobytes())
    assert host.set(_0=100.0) == "OK"
    for k in range(150):
        assert host.set(_0=100.0) == "OK" and host.tick(500 + k % 3) != 0
    stranger = Host(host.board, session=999)
    for k in range(101):
        stranger.board.receive(stranger.frame("CLEAR"))
        host.board.receive(old)
        host.tick(500 + k % 3)
    stands(host, "HOST_SILENT")


def test_a_division_by_zero_is_a_fault_in_its_tick():
    host = Host(speed_max=1e3).running(fixed(over=1e-3), at=0.02)
    assert host.tick(0, beat=True) != 0
    for counts in (-500, -1000, -1500, -1999):
        assert host.tick(counts, beat=True) != 0
    assert host.tick(-2000) == 0
    stands(host, "NOT_FINITE", 5)


@pytest.mark.parametrize("way", [1, -1])
def test_over_speed_and_over_travel(way):
    host = Host().running()  # 2 m/s is 200 counts a tick; the travel of 10000 counts gives 500 more at either end
    host.tick(0, beat=True)
    for k in range(1, 28):
        assert host.tick(way * 200 * k, beat=True) != 0
    assert host.tick(way * 5500, beat=True) != 0
    assert host.tick(way * 5501) == 0
    assert not host.has("HOMED")
    stands(host, "OVER_TRAVEL", 29)
    assert host.start() == "NOT_HOMED"

    host = Host().running(at=0.01)
    host.tick(0, beat=True)
    assert host.tick(way * 200, beat=True) != 0
    assert host.tick(way * 401) == 0
    assert host.has("HOMED")
    stands(host, "OVER_SPEED", 2)
    assert host.start() == "OK"


def test_a_tick_that_comes_late_has_moved_more_before_it_is_too_fast():
    host = Host().running()
    host.tick(100, beat=True)
    host.t += 2e-3  # two ticks did not come
    assert host.tick(700, beat=True) != 0
    assert host.state()["tick"] == 3
    host.t += 2e-3
    assert host.tick(1303) == 0


def test_heat_is_a_first_order_mean_of_the_squared_force():
    """From half of what the motor stands: h(t) = f^2 - (f^2 - h0) exp(-t/tau), a fault where it passes f_c^2."""
    f, f_c, tau = 4.0, 2.0, 5.0
    host = Host(force_continuous=f_c, heating_time=tau).running(fixed(f))
    expected = tau * math.log((f**2 - 0.5 * f_c**2) / (f**2 - f_c**2)) / 1e-3
    ticks = 0
    while host.tick(0, beat=True):
        ticks += 1
    assert abs(ticks - expected) <= 16 + 1  # it looks once in 16 ticks
    stands(host, "OVER_HEAT", ticks)
    last = host.samples[-1].payload
    assert struct.unpack_from("<f", last, 13)[0] == 0  # the sample of the fault says that there was no force


def test_a_hot_motor_is_not_started_and_settings_do_not_cool_it():
    host = Host(force_continuous=2.0, heating_time=5.0).running(fixed(4.0))
    while host.tick(0, beat=True):
        pass
    host.ask("CLEAR")
    hot = host.state()["heat"]
    host.load(settings(force_continuous=2.0, heating_time=5.0).to_bytes(), "SETTINGS")
    assert host.state()["heat"] == hot > 0.99
    host.ask("HOME", 0.0)
    host.load(fixed(4.0))
    cooled = 0
    while host.start() == "HOT":
        host.tick(0)
        cooled += 1
    assert 16 <= cooled <= 64 and host.state()["heat"] < 1


@pytest.mark.parametrize("late, after", [([1], 4), ([1, 1, 1, 0], 26), ([1, 0], 39), ([1] + [0] * 49, None)])
def test_overruns_are_counted_flagged_and_a_fault_when_they_repeat(late, after):
    """4 in a row or 20 in a second; one in 50 is 20 in a second too, and 19 of them are not."""
    host, flags = Host().running(), []
    for k in range(3000 if after else 900):
        duty = host.tick(500, step=1.5e-3 if late[k % len(late)] else 0.2e-3, beat=True)
        if not duty:
            break
    if after is None:
        assert k == 899 and host.state()["overruns"] == 18
        assert host.state()["step_worst"] == 1500 and host.state()["step_mean"] == (18 * 1500 + 882 * 200) // 900
    else:
        assert k + 1 == after
        stands(host, "OVERRUN", after - 1)
    flags = [bool(f.payload[4] & 2) for f in host.samples]
    assert flags == [bool(late[k % len(late)]) for k in range(len(flags))]


def test_a_tick_that_the_grid_lost_is_an_overrun_and_leaves_the_velocity_right():
    """A step a little shorter than its period, whose end comes after the next point of the grid."""
    host = Host().running(_0=0.0)
    for k in range(6):
        host.tick(100 * k, step=0.2e-3, beat=True)
    host.t += 1e-3  # one tick is lost, and the handle goes on
    host.tick(700, step=0.2e-3, beat=True)
    host.tick(800, step=0.2e-3, beat=True)
    rows = [struct.unpack_from("<IBff", f.payload) for f in host.samples]
    assert [tick for tick, *_ in rows] == [0, 1, 2, 3, 4, 5, 7, 8]
    assert [bool(flags & 2) for _, flags, *_ in rows] == [False] * 6 + [True, False]
    assert [v for *_, v in rows][1:] == pytest.approx([1.0] * 7, rel=1e-5)  # 100 counts of 10 um in 1 ms
    assert host.state()["overruns"] == 1


def test_a_value_set_before_the_first_tick_holds_from_the_first_tick():
    host = Host().ready()
    host.start()
    (reply,) = host.give(host.frame("SET", 1, rest=b"\0" + struct.pack("<f", 3.0)))
    assert reply.fields["result"] == 0 and reply.fields["tick"] == -1
    host.tick(0)
    (reply,) = host.give(host.frame("SET", 1, rest=b"\0" + struct.pack("<f", 4.0)))
    assert reply.fields["tick"] == 0


MAGNET = dict(sensor=SENSORS["MAGNETORESISTIVE"], wrap=920, metres_per_count=12.8e-6)


@pytest.mark.parametrize("T, result", [(1e-3, "OK"), (2.2e-3, "OK"), (2.3e-3, "ALIAS"), (10e-3, "ALIAS")])
def test_a_period_in_which_the_magnet_could_turn_over_unseen_is_refused(T, result):
    """At 2 m/s 345 counts, 3/8 of 920, take 2.208 ms."""
    host = Host(**MAGNET).ready()
    assert host.load(spring(K=1.0, T=T)) == "OK" and host.set(_0=1.0) == "OK" and host.start() == result
    quadrature = Host().ready()
    assert quadrature.load(spring(K=1.0, T=T)) == "OK" and quadrature.set(_0=1.0) == "OK" and quadrature.start() == "OK"


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("speed_max, moved, lost", [(2.0, 282, False), (2.0, 283, True), (4.416, 342, False), (4.416, 343, True)])
def test_a_magnet_that_may_have_turned_over_unseen_takes_the_position_with_it(speed_max, moved, lost, way):
    """The first reading is doubted, the second decides: six times a quarter of the limit's counts and 8, or 3/8 of a turn."""
    host = Host(speed_max=speed_max, **MAGNET).ready()
    for _ in range(2):
        assert host.has("HOMED")
        host.tick(way * moved)
    assert host.has("HOMED") is not lost
    running = Host(speed_max=speed_max, **MAGNET).running(_0=0.0)
    running.tick(0, beat=True)
    for _ in range(2):
        assert state_name(running.state()["state"]) == "RUN"
        running.tick(way * moved, beat=True)
    assert state_name(running.state()["state"]) == ("FAULT" if lost else "RUN")
    assert running.has("HOMED") is not lost


def test_after_a_run_and_after_a_fault_the_handle_is_watched_every_millisecond_again():
    host = Host().ready()
    host.load(spring(T=5e-3))
    host.set(_0=1.0)
    host.start()
    assert host.board.period == 5e-3
    host.ask("STOP")
    assert host.board.period == 1e-3
    host.start()
    host.tick(0)
    host.board.fail("SENSOR")
    host.tick(0)
    assert host.board.period == 1e-3


def is_found(host, at, size):
    """Damage a byte of a running program's place: two passes of the audit at the most, and it is a fault."""
    host.board.damage_program(at, 0x10)
    ticks = 0
    while state_name(host.state()["state"]) == "RUN":
        host.tick(500)
        ticks += 1
    assert ticks <= 2 * math.ceil(size / 8) + 2
    stands(host, "BAD_PROGRAM")


@pytest.mark.parametrize("every", [1, 3])
def test_a_program_damaged_in_memory_is_found(every):
    """The audit looks at 8 bytes a tick at least."""
    size = len(encode_program(spring(), word_bits=16))
    for at in range(0, size - 4, 5):
        host = Host().ready()
        host.start(every=every)
        for _ in range(at % 7):
            host.tick(500, beat=True)
        is_found(host, at, size)


@pytest.mark.parametrize("live", [False, True])
def test_a_constant_or_a_parameter_damaged_in_its_register_is_found(live):
    """They are put there once, and the bytes of the program stay whole."""
    program = spring() if live else fixed(push=0.5, k=2.0)
    data = encode_program(program, word_bits=16)
    size, constants = len(data), layout(data).size["constants"]
    register = -(-size // 4) * 4 + (4 * constants if live else 0)  # behind the bytes: constants, then parameters
    host = Host().ready()
    assert host.load(program) == "OK" and (not live or host.set(_0=50.0) == "OK") and host.start() == "OK"
    host.tick(500, beat=True)
    is_found(host, register, size)


def test_a_sensor_that_fails_takes_the_position_with_it_and_what_it_saw_of_the_stops():
    host = Host()
    host.hello()
    sweep(host, -5000, 5000)
    assert host.has("HOMED")
    host.load(fixed(1.0))
    host.start()
    host.tick(0, beat=True)
    host.board.fail("SENSOR")
    assert host.board.duty == 0
    for _ in range(20):
        host.tick(0)
    assert not host.has("HOMED")
    stands(host, "SENSOR")
    sweep(host, -5000 + 777, 5000 + 777)
    assert host.has("HOMED") and host.state()["x"] == pytest.approx(0, abs=2e-5)


def test_after_over_travel_a_sweep_homes_again():
    host = Host()
    host.hello()
    sweep(host, -5000, 5000)
    host.load(fixed(0.1))
    host.start()
    for counts in range(0, 5700, 100):
        host.tick(counts, beat=True)
    stands(host, "OVER_TRAVEL")
    sweep(host, -5000, 5000)
    assert host.has("HOMED") and not host.has("TRAVEL_MISMATCH")


def test_the_first_fault_stays():
    host = Host().running()
    host.tick(500)
    host.board.fail("MEMORY")
    host.board.fail("SENSOR")
    stands(host, "MEMORY")


# ---------------------------------------------------------------- the handle


def sweep(host, low, high, step=50):
    """Lead the handle to both stops and to the middle."""
    middle = (low + high) // 2
    path = [*range(middle, high, step), high, *range(high, low, -step), low, *range(low, middle, step), middle]
    for counts in path:
        host.tick(counts)


@pytest.mark.parametrize("metres", [1e-5, -1e-5, 3.3e-6, 1.28e-5])
@pytest.mark.parametrize("travel", [(-0.05, 0.05), (-0.02, 0.06), (0.0, 0.04)])
@pytest.mark.parametrize("offset", [0, 123457, -2_000_000])
def test_homing_by_a_sweep_finds_the_position_within_a_count(metres, travel, offset):
    host = Host(metres_per_count=metres, travel_min=travel[0], travel_max=travel[1])
    host.hello()
    ends = sorted(round(a / metres) for a in travel)
    sweep(host, *(a + offset for a in ends), step=97)
    assert host.has("HOMED") and not host.has("TRAVEL_MISMATCH")
    truth = (host.counts - offset) * metres
    assert host.state()["x"] == pytest.approx(truth, abs=1.01 * abs(metres))


@pytest.mark.parametrize("share, homed, mismatch", [
    (1.0, True, False), (1 + 1 / 33, True, False), (1 + 1 / 31, False, True), (1.5, False, True),
    (1 - 1 / 33, True, False), (1 - 1 / 31, False, False), (0.5, False, False)])  # fmt: skip
def test_a_travel_that_differs_by_more_than_a_32nd_is_no_home(share, homed, mismatch):
    host = Host()
    host.hello()
    sweep(host, round(-5000 * share), round(5000 * share))
    assert (host.has("HOMED"), host.has("TRAVEL_MISMATCH")) == (homed, mismatch)


# ---------------------------------------------------------------- telemetry


@pytest.mark.parametrize("every", [1, 2, 7, 65535])
def test_one_sample_in_so_many_is_sent(every):
    host = Host().ready()
    host.start(every=every)
    host.tick(100, times=50, beat=True)
    ticks = [struct.unpack_from("<I", f.payload)[0] for f in host.samples]
    assert ticks == list(range(0, 50, every))


def test_samples_without_room_are_counted_as_lost():
    host = Host().running()
    for k in range(4000):  # nobody takes them: 64 KB, then the ring, then nothing
        host.board.tick(0, host.t)
        host.t += 1e-3
        if k % 50 == 0:
            host.board.receive(encode("STATUS", 1, host.session))
    host.hear()
    host.tick(beat=True)
    state = host.state()
    host.tick()
    ticks = [struct.unpack_from("<I", f.payload)[0] for f in host.samples]
    assert state["lost"] > 0 and ticks == sorted(set(ticks))
    assert len(ticks) + state["lost"] == state["tick"]
    assert fault_name(state["fault"]) == "HOST_SILENT"  # nor could it hear its host


# ---------------------------------------------------------------- without a host


def armed(program=None, **kept):
    """A store with a program in it, armed."""
    host = Host(**kept)
    host.hello()
    assert host.load(program or fixed(0.5), "STANDALONE") == "OK"
    assert host.ask("ARM", 1) == "OK"
    return host.board.store


def test_a_stored_program_starts_when_the_handle_was_led_to_both_stops_and_rests_in_the_middle():
    host = Host(HostBoard(armed()))
    host.tick(0, times=1500)
    assert host.board.duty == 0  # not homed
    path = [*range(0, 5000, 20), 5000, *range(5000, -5000, -20), -5000]
    for counts in path:
        assert host.tick(counts) == 0
    host.tick(-5000, times=1500)
    assert host.board.duty == 0  # rests, but not in the middle
    for counts in range(-5000, 0, 20):
        assert host.tick(counts) == 0
    waited = 0
    while host.tick(3 * (waited % 2)) == 0:
        waited += 1
    assert waited == pytest.approx(1001, abs=2)
    host.tick(times=5000)  # no host, and no fault
    assert host.board.duty == pytest.approx(-0.5 / 8, abs=1e-4)
    host.hello()
    assert host.board.duty == 0 and not host.has("STANDALONE")
    host.tick(0, times=3000)
    assert host.board.duty == 0


@pytest.mark.parametrize("spoil", [
    lambda host: host.ask("ARM", 0), lambda host: host.load(settings(checked=0).to_bytes(), "SETTINGS"),
    lambda host: host.load(fixed(0.7), "STANDALONE")])  # fmt: skip
def test_disarmed_unchecked_or_stored_anew_it_does_not_start(spoil):
    old = Host(HostBoard(armed()))
    old.hello()
    assert spoil(old) == "OK"
    assert not started(old.board.store)


def started(store):
    host = Host(HostBoard(store))
    sweep(host, -5000, 5000, step=200)
    return host.tick(0, times=1200) != 0


def test_a_program_with_parameters_or_without_a_checked_motor_is_not_kept():
    host = Host()
    host.hello()
    assert host.load(spring(), "STANDALONE") == "NO_VALUE"
    other = Host(checked=0)
    other.hello()
    assert other.load(fixed(0.5), "STANDALONE") == "OK" and other.ask("ARM", 1) == "NOT_CALIBRATED"


def test_a_store_that_was_cut_in_the_middle_of_writing_never_runs():
    """Power fails after every number of bytes, in the order in which they are written; then somebody arms it even so."""
    before, old, new = settings().to_bytes(), fixed(0.5), fixed(0.25, k=2.0)
    kept = armed(old)
    data = encode_program(new, word_bits=16)
    writes = [(STORE_ARMED, b"\0"), *((STORE_PROGRAM + k, data[k : k + 1]) for k in range(len(data)))]
    writes += [(STORE_ARMED + 1 + k, struct.pack("<H", len(data))[k : k + 1]) for k in range(2)]
    assert kept[: len(before)] == before and started(kept)
    wholes = {encode_program(program, word_bits=16) for program in (old, new)}
    store, ran = bytearray(kept), set()
    for count in range(len(writes) + 1):
        if count:
            at, byte = writes[count - 1]
            store[at : at + 1] = byte
        assert count == 0 or not started(bytes(store))
        store_armed = bytearray(store)
        store_armed[STORE_ARMED] = 0xA5
        size = int.from_bytes(store[STORE_ARMED + 1 : STORE_ARMED + 3], "little")
        if loads(bytes(store_armed)):
            ran.add(bytes(store[STORE_PROGRAM : STORE_PROGRAM + size]))
    assert ran == wholes


def loads(store):
    host = Host(HostBoard(store))
    return bool(host.state()["flags"] & 16)


def at_the_start(slots):
    """A board without a host whose very next tick starts the kept program, and the program's bytes."""
    host = Host(HostBoard(armed(fixed(0.5)), slots=slots))
    sweep(host, -5000, 5000, step=200)
    probe = Host(HostBoard(host.board.store, slots=slots))
    sweep(probe, -5000, 5000, step=200)
    waited = 0
    while probe.tick(0) == 0:
        waited += 1
    host.tick(0, times=waited - 1)  # the tick that starts it gives no force yet
    assert host.board.duty == 0 and state_name(host.state()["state"]) == "IDLE"
    return host, encode_program(fixed(0.25, k=2.0), word_bits=16)


@pytest.mark.parametrize("slots", [1, 2])
@pytest.mark.parametrize("when", ["before", "after"])
def test_a_start_without_a_host_does_not_come_between_what_begin_looks_at_and_what_it_clears(when, slots):
    """It did: with a tick there the program ran, READY was gone, and DATA went into its bytes."""
    host, data = at_the_start(slots)
    host.board.race(when)
    begun = host.ask("BEGIN", 0, len(data))
    said = host.ask("DATA", 0, rest=data[:40])
    if when == "before":  # it runs: with one place nothing may be loaded
        assert state_name(host.state()["state"]) == "RUN" and host.has("READY")
        assert (begun, said) == (("BUSY", "RANGE") if slots == 1 else ("OK", "OK"))
    else:  # with one place there is nothing left to start; with two the kept one is not touched
        assert (begun, said) == ("OK", "OK")
        assert state_name(host.state()["state"]) == ("IDLE" if slots == 1 else "RUN")
    for _ in range(200):  # and what runs is still what was verified
        host.tick(0)
    assert fault_name(host.state()["fault"]) is None


def settings_of(store):
    """The settings that a board has after power-on with this store, or None."""
    host = Host(HostBoard(bytes(store)))
    host.hello()
    read = b"".join(host.ask("READ", at, 40)["rest"] for at in range(0, SETTINGS_STRUCT.size, 40))
    return Settings.from_bytes(read) if read else None


def stored(store, kept, cut):
    """The store after new settings came to a board whose power fails after so many bytes of writing."""
    host = Host(HostBoard(bytes(store)))
    host.hello()
    host.board.cut_power(cut)
    said = host.load(kept.to_bytes(), "SETTINGS")
    assert said == ("OK" if cut >= 2 * SETTINGS_STRUCT.size else "STORE"), cut
    return host.board.store


def test_power_that_fails_at_any_byte_leaves_the_old_settings_or_the_new_ones():
    """With one copy every cut but the first and the last lost the calibration. Then once more, from a torn store."""
    old, new, newer = (settings(force_max=force, ident=k, date=20261100 + k) for k, force in enumerate((3.0, 2.0, 1.0)))
    found, size = [], 2 * SETTINGS_STRUCT.size
    first = stored(HostBoard(settings().to_bytes()).store, old, size)
    assert settings_of(first) == old.to_float32()
    for cut in range(size + 1):
        torn = stored(first, new, cut)
        found.append(settings_of(torn))
        if cut < size:  # the byte that was being written may be erased
            at = (cut + SETTINGS_STRUCT.size) % size
            assert settings_of(torn[:at] + b"\xff" + torn[at + 1 :]) in (old.to_float32(), new.to_float32()), cut
        for again in range(cut % 7, size + 1, 43) if cut % 13 == 0 else ():
            assert settings_of(stored(torn, newer, again)) in (found[-1], newer.to_float32()), (cut, again)
    assert set(map(repr, found)) == {repr(old.to_float32()), repr(new.to_float32())}
    assert found[0] == old.to_float32() and found[-1] == new.to_float32() and found.index(new.to_float32()) <= size


def test_one_copy_that_rots_is_not_missed():
    whole = stored(HostBoard(settings().to_bytes()).store, settings(ident=7), 2 * SETTINGS_STRUCT.size)
    for at in range(0, 2 * SETTINGS_STRUCT.size, 3):
        rotten = bytearray(whole)
        rotten[at] ^= 0x10
        assert settings_of(rotten).ident == 7
