"""Frames on the wire: a message, its CRCs, COBS around them. The format is described in messages.py."""

import struct
import zlib
from binascii import crc_hqx
from typing import NamedTuple

from .messages import MESSAGES, PROTOCOL

NAMES = {m.number: name for name, m in MESSAGES.items()}


class Frame(NamedTuple):
    """One message as it came: its name, sequence number and payload."""

    message: str
    sequence: int
    payload: bytes

    @property
    def fields(self):
        """The payload's fields by name."""
        return MESSAGES[self.message].unpack(self.payload)


def encode(message, sequence, *values, rest=b"", session=0):
    """Return the bytes of one frame, the zero byte at its end included.

    Parameters
    ----------
    message : str
        A name in MESSAGES; its fields are ``values``, bytes after them ``rest``.
    sequence : int
        Its low 8 bits are sent; the guard takes in the others.
    session : int
        The number said in HELLO, which the guard of guarded messages begins from.

    Examples
    --------
    >>> from hapticlab.device.link.wire import encode
    >>> encode("STOP", 7).hex(" ")
    '09 29 07 b7 18 fb 9b a3 f9 00'
    """
    row = MESSAGES[message]
    body = bytes([PROTOCOL << 5 | row.number, sequence & 255]) + row.struct.pack(*values) + rest
    if row.guarded:
        body += struct.pack("<I", zlib.crc32(body, session + (sequence >> 8) & 0xFFFFFFFF))
    # big endian, unlike all else: so the CRC of a frame with its own CRC is 0, which is what both ends ask
    return stuff(body + struct.pack(">H", crc_hqx(body, 0xFFFF))) + b"\0"


def decode(stuffed, session=None):
    """Return the Frame in the bytes before a zero byte, or None if they are damaged.

    With a session the guard of a guarded message is checked and taken off too.
    """
    body = unstuff(stuffed)
    if body is None or len(body) < 4 or crc_hqx(body, 0xFFFF) != 0 or body[0] >> 5 != PROTOCOL:
        return None
    name = NAMES.get(body[0] & 31)
    if name is None:
        return None
    end = len(body) - 2
    if session is not None and MESSAGES[name].guarded:
        end -= 4
        if end < 2 or zlib.crc32(body[:end], session) != struct.unpack_from("<I", body, end)[0]:
            return None
    return Frame(name, body[1], body[2:end])


def stuff(data):
    """Return data without zero bytes: each run up to a zero is led by its length plus one (COBS, below 254 bytes)."""
    return b"".join(bytes([len(run) + 1]) + run for run in data.split(b"\0"))


def unstuff(data):
    """Undo :func:`stuff`; None where data is not of it."""
    body, at = bytearray(data), 0
    while at < len(body):
        step = body[at]
        if step == 0:
            return None
        body[at] = 0  # each length stands where a zero was, the first before them all
        at += step
    return bytes(body[1:]) if at == len(body) else None


class Decoder:
    """Frames out of bytes as they come, whatever came before them; ``damaged`` counts what was none."""

    def __init__(self):
        self.damaged = 0
        self._begun = b""

    def feed(self, data):
        """Return the frames that data completes."""
        *whole, self._begun = (self._begun + data).split(b"\0")
        self._begun = self._begun[-256:]  # no frame is as long: what precedes is noise
        frames = [decode(piece) for piece in whole if piece]
        self.damaged += sum(frame is None for frame in frames)
        return [frame for frame in frames if frame is not None]
