"""Somebody who talks to the host's board frame by frame and turns its clock by hand."""

import struct
import zlib

import numpy as np

from hapticlab.compiler.engines.bytecode import encode as encode_program
from hapticlab.compiler.tick.compile_scene import compile
from hapticlab.device.board.host_board import WORD_BITS, HostBoard
from hapticlab.device.board.settings import Settings
from hapticlab.device.link.messages import FAULTS, FLAGS, MESSAGES, RESULTS, STATES, TARGETS
from hapticlab.device.link.wire import Decoder, encode
from hapticlab.scene.notation.symbols import n, parameters, x
from hapticlab.scene.scene import Scene

PIECE = 40
#: 10 um per count, +-50 mm, linear motor of 8 N, limited to 4 N
SETTINGS = dict(
    wired=1, checked=1, metres_per_count=1e-5, travel_min=-0.05, travel_max=0.05, force_full=8.0, force_max=4.0,
    force_continuous=4.0, heating_time=60.0, speed_max=2.0,
)  # fmt: skip


def settings(**changes):
    return Settings(**SETTINGS | changes)


def spring(K=None, T=1e-3, **options):
    """F = k x, with or without its value."""
    k = parameters("k", units="N/m")
    scene = Scene(force=k * x(n), name="spring")
    return compile(scene if K is None else scene(k=K), T=T, velocity="backward_difference", **options)


def fixed(push=0.0, k=0.0, over=0.0):
    """F = push + k x + over / x, a program without parameters: as a store keeps it."""
    constants = parameters("push k over", units="N N/m N*m")
    law = constants[0] + constants[1] * x(n) + (constants[2] / x(n) if over else 0)
    values = {"push": push, "k": k} | ({"over": over} if over else {})
    return compile(Scene(force=law, name="fixed")(**values), T=1e-3, velocity="backward_difference", live=())


class Host:
    """One session with one board."""

    def __init__(self, board=None, session=12345, **kept):
        self.board = HostBoard(settings(**kept).to_bytes()) if board is None else board
        self.decoder, self.session = Decoder(), session
        self.sent = {True: 0, False: 0}
        self.samples, self.faults, self.frames, self.t, self.counts = [], [], [], 0.0, 0

    def frame(self, message, *values, rest=b""):
        """Return the bytes of the next request."""
        guarded = MESSAGES[message].guarded
        self.sent[guarded] += 1
        return encode(message, self.sent[guarded], *values, rest=rest, session=self.session)

    def give(self, data):
        """Hand bytes to the board; return the replies."""
        self.board.receive(data)
        return self.hear()

    def hear(self):
        came, replies = self.decoder.feed(self.board.transmit()), []
        self.frames += came
        for frame in came:
            {"SAMPLE": self.samples, "FAULTED": self.faults}.get(frame.message, replies).append(frame)
        return replies

    def ask(self, message, *values, rest=b""):
        """Send a request and return the reply's fields; of an ACK the result's name."""
        (reply,) = self.give(self.frame(message, *values, rest=rest))
        assert reply.sequence == self.sent[MESSAGES[message].guarded] & 255
        known = reply.fields
        return result_name(known["result"]) if reply.message == "ACK" else known

    def hello(self):
        return self.ask("HELLO", self.session)

    def state(self):
        return self.ask("STATUS", self.session)

    def has(self, flag):
        return bool(self.state()["flags"] & FLAGS[flag])

    def load(self, program, target="PROGRAM", damage=None):
        """Send a program or bytes; return COMMIT's result. ``damage`` changes the bytes on their way."""
        data = program if isinstance(program, bytes) else encode_program(program, word_bits=WORD_BITS)
        self.crc = struct.unpack("<I", data[-4:])[0]
        begun = self.ask("BEGIN", TARGETS[target], len(data))
        if begun != "OK":
            return begun
        sent = damage(data) if damage else data
        for offset in range(0, len(sent), PIECE):
            assert self.ask("DATA", offset, rest=sent[offset : offset + PIECE]) == "OK"
        return self.ask("COMMIT", TARGETS[target], len(data), zlib.crc32(data[:-4]))

    def set(self, **values):
        """Set parameters by index, _0=...: several at once."""
        rest = b"".join(bytes([int(k[1:])]) + np.float32(v).tobytes() for k, v in values.items())
        return self.ask("SET", len(values), rest=rest)

    def start(self, every=1, passive=0, force_max=100.0, crc=None):
        return self.ask("START", self.crc if crc is None else crc, every, passive, force_max)

    def tick(self, counts=None, times=1, step=0.0, beat=False):
        """Turn the clock; return the duty after the last tick."""
        for _ in range(times):
            self.counts = self.counts if counts is None else counts
            duty = self.board.tick(self.counts, self.t, step)
            self.t += self.board.period
            self.hear()
            if beat:
                self.state()
        return duty

    def ready(self, program=None, at=0.0, **values):
        """Say hello, home, load and set: all but START."""
        self.tick()
        self.hello()
        assert self.ask("HOME", at) == "OK"
        assert self.load(spring() if program is None else program) == "OK"
        if values or program is None:
            assert self.set(**(values or {"_0": 100.0})) == "OK"
        return self

    def running(self, *args, **values):
        """Say everything up to START."""
        self.ready(*args, **values)
        assert self.start() == "OK"
        return self


def result_name(number):
    return next(name for name, (n, _) in RESULTS.items() if n == number)


def fault_name(number):
    return next((name for name, row in FAULTS.items() if row[0] == number), None)


def state_name(number):
    return next(name for name, n in STATES.items() if n == number)
