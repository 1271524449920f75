"""The firmware's core behaves: what it refuses, what stops it, what survives a bad link. Time is counted in its ticks."""

import struct
import zlib

import numpy as np
import pytest
from host_driver import Host, fault_name, result_name, spring, state_name

from hapticlab.compiler.bytecode import encode as encode_program
from hapticlab.device.host_board import HostBoard
from hapticlab.device.wire import encode

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
    assert host.ask("COMMIT", 0, len(data), zlib.crc32(data)) == "NO_PROGRAM"


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
    assert [host.ask("BEGIN", 0, size) for size in (0, 32768, 32769, 65535)] == ["TOO_LARGE", "OK", "TOO_LARGE", "TOO_LARGE"]
    assert host.ask("BEGIN", 3, 10) == "RANGE"
    assert host.ask("BEGIN", 2, 4096 - 100 + 1) == "TOO_LARGE"
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
        assert host.ask("COMMIT", 0, len(data), zlib.crc32(data)) == wanted
        assert host.start(crc=struct.unpack("<I", data[-4:])[0]) == ("NO_VALUE" if missing is None else "NO_PROGRAM")
