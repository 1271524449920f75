"""Frames against published values, against a bit-wise second derivation, and against the firmware's C."""

import random
import struct
import zlib

import pytest
from host_driver import Host

from hapticlab.device.link.messages import LARGEST_PAYLOAD, MESSAGES
from hapticlab.device.link.wire import Decoder, Frame, decode, encode, stuff, unstuff

#: data and encoding without the end: by hand from Cheshire and Baker (1999), table 1; rows as in many a description of COBS
COBS = {
    "": "01", "00": "01 01", "00 00": "01 01 01", "00 11 00": "01 02 11 01", "11 22 00 33": "03 11 22 02 33",
    "11 22 33 44": "05 11 22 33 44", "11 00 00 00": "02 11 01 01 01", "00 01 02 00": "01 03 01 02 01",
    "45 00 00 2c 4c 79 00 00 40 06 4f 37": "02 45 01 04 2c 4c 79 01 05 40 06 4f 37",
}  # fmt: skip


def crc_by_bits(data, width, polynomial, value, reflected):
    """The textbook shift register, one bit at a time (Williams, A painless guide to CRC, 1993)."""
    top = 1 << (width - 1)
    for byte in data:
        for k in range(8):
            bit = byte >> (k if reflected else 7 - k) & 1
            value, out = (value << 1) & (2 * top - 1), bool(value & top) ^ bit
            value ^= polynomial if out else 0
    return value


def reversed_bits(value, width):
    return int(f"{value:0{width}b}"[::-1], 2)


def crc16(data):
    return crc_by_bits(data, 16, 0x1021, 0xFFFF, False)


def crc32(data, begin=0):
    start = reversed_bits(~begin & 0xFFFFFFFF, 32)
    return ~reversed_bits(crc_by_bits(data, 32, 0x04C11DB7, start, True), 32) & 0xFFFFFFFF


def test_the_shift_register_gives_the_published_check_values():
    assert crc16(b"123456789") == 0x29B1
    assert crc32(b"123456789") == 0xCBF43926


@pytest.mark.parametrize("data, stuffed", COBS.items())
def test_cobs_of_published_examples(data, stuffed):
    data, stuffed = bytes.fromhex(data), bytes.fromhex(stuffed)
    assert stuff(data) == stuffed and unstuff(stuffed) == data


def test_cobs_has_no_zero_and_costs_one_byte_whatever_the_data():
    rng = random.Random(1)
    for length in range(254):
        data = bytes(rng.choice((0, 0, 1, rng.randrange(256))) for _ in range(length))
        assert 0 not in stuff(data) and len(stuff(data)) == length + 1
        assert unstuff(stuff(data)) == data


@pytest.mark.parametrize("text", ["00", "02", "03 11", "05 11 22 33", "01 00", "02 11 03 22", "ff 01"])
def test_what_is_not_cobs_is_refused(text):
    assert unstuff(bytes.fromhex(text)) is None


def test_a_frame_is_made_as_its_description_says():
    """Every byte of one guarded frame, from the description and the shift register alone."""
    body = bytes([1 << 5 | 11, 0x2C]) + struct.pack("<f", -0.25)  # HOME, the 300th guarded request
    body += struct.pack("<I", crc32(body, begin=77 + 1))  # the sequence turned over once
    body += struct.pack(">H", crc16(body))
    assert encode("HOME", 300, -0.25, session=77) == stuff(body) + b"\0"
    assert decode(stuff(body), session=78) == Frame("HOME", 0x2C, struct.pack("<f", -0.25))
    assert decode(stuff(body), session=77) is None


@pytest.mark.parametrize("name", MESSAGES)
def test_every_message_comes_back_field_by_field(name):
    rng, row = random.Random(name), MESSAGES[name]
    for _ in range(20):
        values = row.struct.unpack(rng.randbytes(row.struct.size)) if "f" not in row.struct.format else [
            rng.randint(0, 100) for _ in row.fields]  # fmt: skip
        rest = rng.randbytes(rng.randrange(8)) if row.open else b""
        data = encode(name, 201, *values, rest=rest, session=9)
        (frame,) = Decoder().feed(data) if not row.guarded else [decode(data[:-1], session=9)]
        expected = dict(zip((field for _, field in row.fields), values, strict=True)) | ({"rest": rest} if row.open else {})
        assert frame.message == name and frame.sequence == 201 and frame.fields == expected
        assert data.count(b"\0") == 1 and data[-1] == 0


def test_fields_of_a_wrong_length_are_refused():
    with pytest.raises(ValueError, match="3 bytes for fields of 4"):
        Frame("PONG", 1, b"abc").fields  # noqa: B018
    with pytest.raises(ValueError, match="5 bytes for fields of 4"):
        Frame("PONG", 1, b"abcde").fields  # noqa: B018
    with pytest.raises(ValueError, match="1 bytes for fields of 2"):
        Frame("DATA", 1, b"a").fields  # noqa: B018


def test_bytes_may_come_in_any_pieces_and_after_any_noise():
    frames = [encode("PONG", k, k * 0x01010101) for k in range(1, 60)]
    stream = b"\x07noise\0" + b"\x55" * 700 + b"\0" + b"\0\0\0" + b"".join(frames)
    rng = random.Random(3)
    for _ in range(20):
        decoder, found, at = Decoder(), [], 0
        while at < len(stream):
            step = rng.choice((1, 2, 3, 50, 300))
            found += decoder.feed(stream[at : at + step])
            at += step
        assert [f.sequence for f in found] == list(range(1, 60))
        assert decoder.damaged == 2


def test_every_damage_of_one_or_two_bits_is_seen():
    """CRC-16/CCITT sees every error of one, two and three bits and every burst of 16 in frames this short; damage to
    the lengths of COBS moves bytes, and is left to the odds."""
    data = encode("SAMPLE", 4, 100, 1, rest=bytes(range(1, 9)))[:-1]
    bits = 8 * len(data)
    for first in range(bits):
        for second in range(first, bits):
            damaged = bytearray(data)
            damaged[first // 8] ^= 1 << first % 8
            if second != first:
                damaged[second // 8] ^= 1 << second % 8
            assert Decoder().feed(bytes(damaged) + b"\0") == [], (first, second)


# ---------------------------------------------------------------- the firmware's own


def answer(data):
    """The board's answer to raw bytes."""
    host = Host()
    return host.give(data), host.board


def test_the_board_reads_python_and_python_reads_the_board_whatever_the_payload():
    rng, host = random.Random(5), Host()
    special = [0, 1, 0xFF, 0xFF00, 0x00FF00FF, 0xFFFFFFFF, 0x01000000]
    for k in range(2000):
        token = special[k] if k < len(special) else rng.getrandbits(32)
        (reply,) = host.give(encode("PING", k & 255, token))
        assert reply == Frame("PONG", k & 255, struct.pack("<I", token))


def test_the_boards_crcs_are_the_published_ones():
    """A frame built by the shift register alone is obeyed; with any other CRC-16 it is not."""
    body = bytes([1 << 5 | 2, 9]) + b"1234"
    right = stuff(body + struct.pack(">H", crc16(body))) + b"\0"
    assert answer(right)[0] == [Frame("PONG", 9, b"1234")]
    for bit in range(16):
        wrong = stuff(body + struct.pack(">H", crc16(body) ^ 1 << bit)) + b"\0"
        assert answer(wrong)[0] == []


def test_the_guard_of_the_board_is_the_published_crc_from_the_sessions_number():
    for begin, result in ((12345, 0), (12346, 36), (0, 36)):
        host = Host()
        host.hello()
        body = bytes([1 << 5 | 12, 1])  # CLEAR
        body += struct.pack("<I", crc32(body, begin=begin))
        body += struct.pack(">H", crc16(body))
        (reply,) = host.give(stuff(body) + b"\0")
        assert reply.fields["result"] == result


def test_frames_of_every_length_up_to_the_buffers_and_beyond():
    """DATA takes the longest payload; what is longer than the buffer is dropped whole, and the next frame is heard."""
    host = Host()
    for count in range(0, LARGEST_PAYLOAD + 60):
        (*replies, pong) = host.give(encode("DATA", 1, 0, rest=b"\x07" * count) + encode("PING", 2, 3))
        assert pong.message == "PONG"
        assert len(replies) == 1 or count > LARGEST_PAYLOAD - 2
    assert host.state()["damaged"] > 0


def test_the_zlib_of_python_is_the_same_crc():
    assert zlib.crc32(b"123456789", 5) == crc32(b"123456789", 5)
