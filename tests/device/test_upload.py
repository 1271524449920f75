"""Uploads over a line that loses, and settings back."""

import pytest
from bad_line import lossy_port
from host_driver import fixed, settings, spring

from hapticlab.compiler.bytecode import encode
from hapticlab.device.exchange import Exchange
from hapticlab.device.messages import LARGEST_PAYLOAD, TARGETS
from hapticlab.device.upload import PIECE, read_settings, upload
from hapticlab.errors import LinkError


def talking(**judges):
    exchange = Exchange(lossy_port(**judges))
    exchange.ask("HELLO", exchange.session)
    return exchange


def every_third():
    count = 0

    def keep(frame):
        nonlocal count
        count += 1
        return count % 3 != 0

    return keep


@pytest.mark.parametrize("way", ["told", "heard"])
@pytest.mark.parametrize("target", TARGETS)
def test_an_upload_survives_every_third_frame_lost(way, target):
    exchange = talking(**{way: every_third()})
    data = settings().to_bytes() if target == "SETTINGS" else encode(fixed(0.5), word_bits=16)
    assert len(data) > 2 * PIECE - LARGEST_PAYLOAD
    upload(exchange, target, data)
    if target == "SETTINGS":
        assert read_settings(exchange) == settings().to_float32()


@pytest.mark.parametrize("lost", range(1, 5))
def test_a_piece_that_never_arrives_ends_in_words_and_nothing_is_taken(lost):
    pieces = 0

    def told(frame):
        nonlocal pieces
        pieces += frame is not None and frame.message == "DATA" and frame.sequence != told.last
        told.last = frame.sequence if frame is not None and frame.message == "DATA" else told.last
        return not (frame is not None and frame.message == "DATA" and pieces == lost)

    told.last = None
    exchange = talking(told=told)
    data = encode(spring(K=2.0), word_bits=16) + b"x" * 200
    with pytest.raises(LinkError, match="does not answer DATA"):
        upload(exchange, "PROGRAM", data)
    assert not exchange.refresh()["flags"] & 32


@pytest.mark.parametrize("data, result", [
    (b"x" * 40000, "TOO_LARGE"), (b"not a program, though long enough for one: 40 bytes", "MAGIC"), (b"x", "SIZE")])  # fmt: skip
def test_what_is_no_program_is_refused_by_name(data, result):
    with pytest.raises(LinkError, match=result) as refusal:
        upload(talking(), "PROGRAM", data)
    assert refusal.value.result == result


def test_a_board_without_settings_has_none():
    exchange = talking()
    exchange.port.put_on(None, store=b"")
    exchange.ask("HELLO", exchange.session)
    assert read_settings(exchange) is None
