"""Write link_frames.json: frames that a session with this computer's board really had, and what a host must make of them.

``python tests/vectors/write_link_frames.py``. Both hosts are held to it, Python's and the page's: each request as it is
encoded and what the board replied; the board's words whole, in pieces, damaged, cut, doubled and out of order; guards; and
which of the frames that come answers a request. A test proves the file fresh: a message that changes changes it too.
"""

import json
import random
import sys
from pathlib import Path

HERE = Path(__file__).parent
if __name__ == "__main__":
    sys.path.insert(0, str(HERE.parent / "firmware"))

from host_driver import Host, settings, spring  # noqa: E402

from hapticlab.device.link.messages import MESSAGES, PROTOCOL, SETTINGS_STRUCT  # noqa: E402
from hapticlab.device.link.wire import Decoder, decode, encode, stuff, unstuff  # noqa: E402

FILE = HERE / "link_frames.json"
#: its lowest bits are up, so that a guard that does not add the turns of the sequence differs
SESSION = 0x7FFF_FFFF
#: of streams: so many frames of the board are enough
FRAMES = 24


class Recording(Host):
    """A host whose words and the board's are kept."""

    def __init__(self):
        super().__init__(session=SESSION)
        self.rows, self.said = [], []

    def frame(self, message, *values, rest=b""):
        data = super().frame(message, *values, rest=rest)
        sequence = self.sent[MESSAGES[message].guarded]
        self.rows.append({"message": message, "sequence": sequence, "values": values, "rest": rest.hex(), "bytes": data.hex()})
        return data

    def hear(self):
        data = self.board.transmit()
        self.said += [piece + b"\0" for piece in data.split(b"\0")[:-1]]
        board, self.board = self.board, _Said(data)
        try:
            return super().hear()
        finally:
            self.board = board


class _Said:
    """A board that has said this."""

    def __init__(self, data):
        self.data = data

    def transmit(self):
        return self.data


def session():
    """Say every request there is to a board, and hear every message that it has; return the host."""
    host = Recording()
    host.tick()
    host.hello()
    host.ask("PING", 0x0100_00FF)
    assert host.load(settings(force_max=3.0).to_bytes(), "SETTINGS") == "OK"
    for offset in range(0, SETTINGS_STRUCT.size, 46):
        host.ask("READ", offset, min(46, SETTINGS_STRUCT.size - offset))
    for _ in range(256):  # the guard takes in how often the sequence has turned over
        host.ask("CLEAR")
    del host.rows[-256:-1]
    host.said = [*host.said[:-256], host.said[-1]]
    assert host.start(crc=7) == "NO_PROGRAM"
    assert host.ask("HOME", 0.0) == "OK"
    assert host.load(spring()) == "OK" and host.set(_0=100.0) == "OK"
    assert host.start() == "OK"
    for k in range(8):
        host.tick(100 * k)
    host.state()
    assert host.ask("STOP") == "OK" and host.start(passive=1) == "OK"
    assert host.ask("STOP") == "OK" and host.start() == "OK"
    host.tick(9000, times=2)
    assert host.faults and host.ask("CLEAR") == "OK" and host.ask("ARM", 0) == "OK"
    assert {row["message"] for row in host.rows} == {name for name, m in MESSAGES.items() if m.number < 16}
    assert {frame.message for frame in host.frames} == {name for name, m in MESSAGES.items() if m.number >= 16}
    return host


def chosen(said):
    """One frame of each message, and others, in their order; ``said`` are frames as they came."""
    seen, kept = {}, []
    for data in said:
        name = decode(data[:-1]).message
        seen[name] = seen.get(name, 0) + 1
        if seen[name] <= 3:
            kept.append(data)
    return kept[:FRAMES]


def streams(said):
    """{name: chunks} of what may come to a host."""
    draw, whole = random.Random(23), b"".join(said)
    flipped = [bytearray(data) for data in said]
    for data in flipped[::2]:
        data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)  # of an end too: then two frames are one
    noise = bytes(draw.randrange(1, 256) for _ in range(700))
    middle = [data if k % 3 else data[: len(data) // 2] + data[len(data) // 2 + 1 :] for k, data in enumerate(said)]
    bodies = [unstuff(data[:-1]) for data in said]
    return {
        "whole": [whole],
        "byte by byte": [bytes([byte]) for byte in b"".join(said[:4])],
        "pieces": [whole[k : k + 7] for k in range(0, len(whole), 7)],
        "bits flipped": [bytes(b"".join(flipped))],
        "a byte lost": [b"".join(middle)],
        "cut": [whole[:-9], whole[:40]],
        "doubled": [b"".join(data * 2 for data in said)],
        "out of order": [b"".join(reversed(said))],
        "noise before": [noise[:650], noise[650:] + b"\0" + whole],
        "noise without an end": [noise[:300], whole],
        "zeros between": [b"\0\0".join(said) + b"\0"],
        "another protocol": [sealed(bytes([body[0] ^ 1 << 5]) + body[1:-2]) for body in bodies[:3]],
        "an unknown message": [sealed(bytes([PROTOCOL << 5 | 31, 1, 2, 3]))],
        "too short": [sealed(body[:-3]) for body in bodies[:3]] + [sealed(b""), sealed(b"\x30"), b"\x01\0", b"\x09\x01\0"],
        "too long": [sealed(body[:-2] + b"\x01") for body in bodies],
    }


def sealed(body):
    """A frame with the right CRC around whatever it is."""
    return stuff(body + crc(body)) + b"\0"


def crc(body):
    """CRC-16/CCITT, bit by bit, of a body: derived here once more, from its polynomial."""
    register = 0xFFFF
    for byte in body:
        for bit in range(7, -1, -1):
            turn = (register >> 15) ^ (byte >> bit & 1)
            register = (register << 1 & 0xFFFF) ^ (0x1021 if turn else 0)
    return register.to_bytes(2, "big")


def decoded(chunks):
    """What a host's decoder makes of chunks of bytes."""
    decoder = Decoder()
    frames = [frame for chunk in chunks for frame in decoder.feed(chunk)]
    return {"frames": [_frame(frame) for frame in frames], "damaged": decoder.damaged}


def _frame(frame):
    try:
        fields = {name: value.hex() if isinstance(value, bytes) else value for name, value in frame.fields.items()}
    except ValueError:
        fields = None
    return [frame.message, frame.sequence, frame.payload.hex(), fields]


def guards(rows):
    """Guarded requests as a board checks them: with their own session, another's, one bit flipped, and cut."""
    found = []
    for row in rows:
        data, begun = bytes.fromhex(row["bytes"])[:-1], SESSION + (row["sequence"] >> 8) & 0xFFFFFFFF
        body = unstuff(data)
        other = sealed(bytes([body[0], body[1] ^ 1]) + body[2:-2])[:-1]
        for piece, session in ((data, begun), (data, begun ^ 1), (other, begun), (sealed(body[:2])[:-1], begun)):
            frame = decode(piece, session)
            found.append([piece.hex(), session, frame and [frame.message, frame.sequence, frame.payload.hex()]])
    return found


def asks(said):
    """Requests with the number 1, the frames that come after each, and what the host must take for the reply, by hand.

    That is (result, tick) of an ACK, the tick of a STATE, or None.
    """
    ack = {name: encode("ACK", 1, MESSAGES[name].number, 0, k) for k, name in enumerate(("STOP", "CLEAR"), 40)}
    state = decode(next(data for data in said if decode(data[:-1]).message == "STATE")[:-1]).fields
    states = [encode("STATE", k, *(state | {"tick": k}).values()) for k in (1, 2, 3)]
    samples = b"".join(data for data in said if decode(data[:-1]).message in ("SAMPLE", "FAULTED"))
    cases = {
        "its reply": ("STOP", [ack["STOP"]], [0, 40]),
        "doubled": ("STOP", [ack["STOP"] * 2], [0, 40]),
        "another's reply before": ("STOP", [ack["CLEAR"] + states[0], ack["STOP"]], [0, 40]),
        "of another request": ("STOP", [ack["CLEAR"]], None),
        "of another number": ("STOP", [encode("ACK", 2, MESSAGES["STOP"].number, 0, 9)], None),
        "refused": ("STOP", [encode("ACK", 1, MESSAGES["STOP"].number, 36, 4)], [36, 4]),
        "damaged": ("STOP", [ack["STOP"][:-3] + b"\0"], None),
        "damaged, then whole": ("STOP", [ack["STOP"][:-3] + b"\0", ack["STOP"]], [0, 40]),
        "states out of order": ("STATUS", [states[2] + states[1], states[0]], 1),
        "a reply of another kind": ("STATUS", [encode("PONG", 1, 5)], None),
        "samples before": ("STATUS", [samples, states[0]], 1),
    }
    return {name: {"message": m, "came": [c.hex() for c in came], "reply": reply} for name, (m, came, reply) in cases.items()}


def content():
    """What the file holds."""
    host = session()
    said = chosen(host.said)
    return {
        "session": SESSION,
        "requests": host.rows,
        "streams": {name: {"chunks": [c.hex() for c in chunks], **decoded(chunks)} for name, chunks in streams(said).items()},
        "guards": guards([row for row in host.rows if MESSAGES[row["message"]].guarded][:12]),
        "asks": asks(said),
    }


def text():
    """The file, a row a line."""
    rows = []
    for name, part in content().items():
        lines = part.items() if isinstance(part, dict) else enumerate(part) if isinstance(part, list) else None
        if lines is None:
            rows.append(f'"{name}": {json.dumps(part)}')
        elif isinstance(part, dict):
            rows.append(f'"{name}": {{\n' + ",\n".join(f" {json.dumps(k)}: {json.dumps(v)}" for k, v in lines) + "\n}")
        else:
            rows.append(f'"{name}": [\n' + ",\n".join(f" {json.dumps(v)}" for _, v in lines) + "\n]")
    return "{\n" + ",\n".join(rows) + "\n}\n"


if __name__ == "__main__":
    FILE.write_text(text(), "utf-8")
