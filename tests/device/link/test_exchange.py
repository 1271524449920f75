"""Requests and replies over a scripted port in virtual time: retries, heartbeats, garbage."""

import random
import struct
from binascii import crc_hqx

import pytest
from scripted_port import ScriptedPort

import hapticlab as hl
from hapticlab.device.link.exchange import HEARTBEAT, PATIENCE, TRIES, Exchange
from hapticlab.device.link.messages import HOST_SILENCE_MS, MESSAGES
from hapticlab.device.link.serial_ports import read_available
from hapticlab.device.link.wire import decode, encode, stuff
from hapticlab.errors import LinkError, PortError


class Script(ScriptedPort):
    """A port in virtual time whose far end is a function: frame said -> bytes that come back."""

    def __init__(self, answer):
        super().__init__()
        self.answer, self.said, self.when = answer, [], []

    def write(self, data):
        frame = decode(data[:-1])
        self.said.append(frame)
        self.when.append(self.time)
        self.heard += self.answer(frame)

    def close(self):
        self.is_open = False


def pong(frame):
    return encode("PONG", frame.sequence, struct.unpack("<I", frame.payload)[0])


def ack(frame, result=0, tick=7):
    return encode("ACK", frame.sequence, MESSAGES[frame.message].number, result, tick)


def test_a_reply_is_taken_by_message_and_sequence_alone():
    """Others' replies, late ones, and those of another request with the same sequence are passed over."""

    def answer(frame):
        token = struct.unpack("<I", frame.payload)[0]
        wrong = encode("PONG", frame.sequence + 1 & 255, 1) + encode("PONG", frame.sequence - 1 & 255, 2)
        wrong += encode("ACK", frame.sequence, MESSAGES["STOP"].number, 0, 0) + encode("BYTES", frame.sequence, 0)
        return wrong + encode("PONG", frame.sequence, token) + encode("PONG", frame.sequence, 99)

    exchange = Exchange(Script(answer))
    for token in range(600):  # the sequence turns over twice
        assert exchange.ask("PING", token).fields == {"token": token}


@pytest.mark.parametrize("lost", [0, 1, 5, TRIES - 1])
def test_a_request_is_said_again_with_its_sequence_until_it_is_answered(lost):
    port = Script(lambda frame: b"" if len(port.said) <= lost else ack(frame))
    exchange = Exchange(port)
    assert exchange.command("CLEAR") == 7
    assert len(port.said) == lost + 1 and len({f.sequence for f in port.said}) == 1 and len({f.payload for f in port.said}) == 1
    gaps = [b - a for a, b in zip(port.when, port.when[1:], strict=False)]
    assert all(PATIENCE <= gap <= PATIENCE + HEARTBEAT for gap in gaps)


def test_silence_ends_in_words():
    exchange = Exchange(Script(lambda frame: b""))
    with pytest.raises(LinkError, match=r"script:// does not answer PING in 3 tries of 0.03 s; check that the board") as silent:
        exchange.ask("PING", 1, tries=3)
    assert silent.value.result is None


def test_a_refusal_is_the_boards_word():
    exchange = Exchange(Script(lambda frame: ack(frame, result=34)))
    with pytest.raises(
        LinkError, match="the board rejected START: NOT_HOMED: the position is unknown since the last reset:"
    ) as refusal:
        exchange.command("START", 0, 1, 0, 1.0)
    assert refusal.value.result == "NOT_HOMED"
    with pytest.raises(LinkError, match="result 99"):
        Exchange(Script(lambda frame: ack(frame, result=99))).command("CLEAR")


def test_then_is_called_between_what_came_before_the_reply_and_what_came_after():
    sample = [encode("SAMPLE", k, k, 0, rest=b"") for k in range(2)]
    order = []
    exchange = Exchange(Script(lambda f: sample[0] + ack(f) + sample[1]), on_frame=lambda f: order.append(f.sequence))
    exchange.command("CLEAR", then=lambda: order.append("then"))
    assert order == [0, "then", 1]
    refused = Exchange(Script(lambda f: ack(f, result=32)))
    with pytest.raises(LinkError):
        refused.command("CLEAR", then=lambda: order.append("never"))
    assert "never" not in order


@pytest.mark.parametrize("lost", range(40))
def test_the_board_hears_of_its_host_within_its_patience_whichever_frame_is_lost(lost):
    heard = [0.0]

    def answer(frame):
        if len(port.said) - 1 == lost:
            return b""
        heard.append(port.time)
        state = [0] * len(MESSAGES["STATE"].fields)
        return encode("STATE", frame.sequence, *state) if frame.message == "STATUS" else ack(frame)

    port = Script(answer)
    exchange = Exchange(port)
    exchange.beating = True
    for _ in range(14):
        exchange.wait(lambda: False, 0.07)
        exchange.command("CLEAR")
    assert len(port.said) > 40
    assert max(b - a for a, b in zip(heard, heard[1:], strict=False)) < HOST_SILENCE_MS / 1000


def test_guarded_requests_count_by_themselves_from_1_and_carry_the_session():
    port = Script(lambda frame: ack(frame) if frame.message in ("CLEAR", "BEGIN") else pong(frame))
    exchange = Exchange(port)
    for _ in range(3):
        exchange.command("CLEAR")
        exchange.ask("PING", 1)
    clears = [f for f in port.said if f.message == "CLEAR"]
    assert [f.sequence for f in clears] == [1, 2, 3] == [f.sequence for f in port.said if f.message == "PING"]
    assert len({f.payload for f in clears}) == 3 and 0 < exchange.session < 1 << 32


def test_garbage_from_the_board_never_raises_and_is_counted():
    """10000 pieces of noise and damaged replies, while a request waits for its answer."""
    rng, wrong = random.Random(6), []

    def answer(frame):
        good = pong(frame)
        bad = bytearray(good)
        bad[rng.randrange(len(bad) - 1)] ^= rng.randrange(1, 256)
        noise = rng.randbytes(rng.randrange(80))
        return bytes(bad) + noise + b"\0" + (good if rng.random() < 0.5 else b"")

    port = Script(answer)
    exchange = Exchange(port, on_frame=wrong.append)
    for token in range(5000):
        assert exchange.ask("PING", token).fields["token"] == token
    assert exchange.decoder.damaged > 8000 and len(wrong) <= 2


def test_frames_of_wrong_lengths_are_damage():
    def framed(number, sequence, payload):
        body = bytes([1 << 5 | number, sequence]) + payload
        return stuff(body + struct.pack(">H", crc_hqx(body, 0xFFFF))) + b"\0"

    def answer(frame):
        short = b"".join(framed(m.number, frame.sequence, b"\1" * (m.struct.size - 1)) for m in MESSAGES.values() if m.fields)
        return short + framed(18, frame.sequence, b"12345") + framed(18, frame.sequence, b"1234")

    exchange = Exchange(Script(answer))
    assert exchange.ask("PING", 0).payload == b"1234"
    assert exchange.decoder.damaged == sum(bool(m.fields) for m in MESSAGES.values()) + 1


def test_what_waits_is_read_at_once_also_where_a_port_counts_to_1():
    """socket:// of pyserial says that one byte waits, however many do: one by one they are too many for a reader."""

    class CountsToOne(Script):
        @property
        def in_waiting(self):
            return min(1, len(self.heard))

    port = CountsToOne(None)
    port.heard = bytes(range(200))
    assert read_available(port) == bytes(range(64))


@pytest.mark.always("one thread")
def test_a_run_goes_on_while_nobody_asks_and_whoever_waits_reads(both):
    """By the clock on the wall, for longer than the silence that a board takes for the host's end."""
    with hl.connect("sim://hapkit?pace=real") as board:
        board.start(hl.wall()(k=150, x_o=0.01))
        run, enough = board.under_way, both.event()

        def add(frame):
            run.add(frame)
            if run.last_tick > 3 * HOST_SILENCE_MS:
                enough.set()

        board.exchange.give(add)
        assert enough.wait(20) and run.fault is None and board.exchange.state is not None
        reader = board.exchange._reader
        assert len(board.stop().t) > 3 * HOST_SILENCE_MS
        log = board.run(hl.wall()(k=150, x_o=0.01), duration=0.2, progress=False)
        assert len(log.t) == 200 and not log.fault
    assert not reader.is_alive()


def test_without_threads_what_breaks_a_port_is_heard_by_who_waits(one_thread):
    with hl.connect("sim://hapkit?pace=real") as board:
        board.exchange.port.close()
        with pytest.raises(PortError, match="is closed; connect again"):
            board.exchange.wait(lambda: False, 1.0)
        assert board.exchange.broken is not None and board.exchange._reader.join(1)
