"""A link that drops, cuts, repeats, flips, reorders and invents: the board never does what it was not told to.

Conversations of the Python encoder, damaged on their way, go into the C core under sanitizers; an independent model of
what was really sent judges the board after every frame.
"""

import os
import random
import struct
import subprocess
import zlib
from collections import Counter
from dataclasses import dataclass, field

import pytest
from host_driver import settings

from hapticlab.compiler.engines import firmware_library, toolchain
from hapticlab.compiler.engines.bytecode import encode as encode_program
from hapticlab.compiler.tick.compile_scene import compile
from hapticlab.device.board.settings import changed
from hapticlab.device.link.messages import MESSAGES, STATES, TARGETS
from hapticlab.device.link.wire import Decoder, encode
from hapticlab.scene.notation.symbols import n, parameters, x
from hapticlab.scene.scene import Scene

PIECE = 40
RUN, IDLE = STATES["RUN"], STATES["IDLE"]
REPORT = struct.Struct("<BBHIIQffI")
KEPT = settings(speed_max=1e3)
FULL = 32767
SANITIZERS = ("-g", "-O1", "-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all")
NOISE = ("drop", "cut", "repeat", "flip", "reorder", "garbage", "stale", "long")


def program(c, word_bits=16):
    """F = c (k x + push): for each c other bytes."""
    k, push, gain = parameters("k push gain", units="N/m N 1")
    scene = Scene(force=gain * (k * x(n) + push), name="fuzz")(gain=c)
    return encode_program(compile(scene, T=1e-3, velocity="backward_difference", live=("k", "push")), word_bits=word_bits)


def fnv(data):
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return value


@dataclass
class Said:
    """What a host really said in one session: guarded requests by their number."""

    starts: dict = field(default_factory=dict)  # number -> (CRC, most duty)
    sets: dict = field(default_factory=dict)  # number -> (k, push)
    commits: dict = field(default_factory=dict)  # number -> hash of the program


class Talk:
    """Events for the board: what hosts said, as it arrived, beside what they meant."""

    def __init__(self, seed, word_bits=16):
        self.rng = random.Random(seed)
        self.programs = [program(1.0 + k / 8, word_bits) for k in range(6)]
        self.hashes = [fnv(p) for p in self.programs]
        self.events, self.sessions, self.recent, self.held = [], {}, [], []
        self.noise, self.frames, self.kinds = 0.0, 0, Counter()
        self.counts, self.value = 0, 0
        self.calibrate()

    def calibrate(self):
        self.hello()
        for kept in (changed(KEPT, wired=0, checked=0), KEPT):  # a new wiring, then confirmed
            data = kept.to_bytes()
            self.send("BEGIN", TARGETS["SETTINGS"], len(data))
            for at in range(0, len(data), PIECE):
                self.send("DATA", at, rest=data[at : at + PIECE])
            self.send("COMMIT", TARGETS["SETTINGS"], len(data), zlib.crc32(data[:-4]))

    def hello(self):
        self.session = self.rng.getrandbits(31) + 1
        self.said = self.sessions.setdefault(self.session, Said())
        self.number = self.plain = 0
        self.send("HELLO", self.session)

    def encoded(self, message, *values, rest=b""):
        guarded = MESSAGES[message].guarded
        self.number, self.plain = self.number + guarded, self.plain + (not guarded)
        return encode(message, self.number if guarded else self.plain, *values, rest=rest, session=self.session)

    def send(self, message, *values, rest=b""):
        frame = self.encoded(message, *values, rest=rest)
        for _ in range(2 if self.noise and self.rng.random() < 0.2 else 1):  # a host says again what is not answered
            self.pass_on(frame)

    def deliver(self, data, why=None):
        self.events.append(("R", data, why))

    def pass_on(self, frame):
        """One frame over the link."""
        self.frames += 1
        rng, due = self.rng, [h for h in self.held if h[0] <= 0]
        self.held = [(wait - 1, data) for wait, data in self.held if wait > 0]
        self.recent = [*self.recent[-299:], frame]
        kind = rng.choice(NOISE) if rng.random() < self.noise else None
        self.kinds[kind] += 1
        if kind == "cut":
            frame = frame[: rng.randrange(len(frame))] + (b"\0" if rng.random() < 0.5 else b"")
        elif kind == "repeat":
            frame = frame * rng.randrange(2, 4)
        elif kind == "flip":
            changed = bytearray(frame)
            for _ in range(rng.randrange(1, 6)):
                changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
            frame = bytes(changed)
        elif kind == "reorder":
            self.held.append((rng.randrange(1, 6), frame))
        elif kind == "garbage":
            frame = rng.randbytes(rng.randrange(1, 30)) + frame
        elif kind == "stale":
            frame = rng.choice(self.recent) + frame
        elif kind == "long":
            frame = bytes(rng.randrange(1, 256) for _ in range(rng.randrange(40, 200))) + frame
        if kind not in ("drop", "reorder"):
            self.deliver(frame, kind)
        for _, data in due:
            self.deliver(data, "late")

    def ticks(self, count, jump=0.0):
        """The handle moves; sometimes it is where it cannot be."""
        if self.rng.random() < jump:
            at, step = self.rng.choice(((6000, 0), (-(2**31), 1), (2**31 - 5, 1), (0, 2**31 - 1))), 0
            at, step = at
        else:
            step = self.rng.randrange(-20, 21)
            at = self.counts
            if abs(at + count * step) > 4000:
                step = 0
            self.counts = at + count * step
        self.events.append(("T", struct.pack("<HII", count, at & 0xFFFFFFFF, step & 0xFFFFFFFF), None))

    def upload(self):
        which = self.rng.randrange(len(self.programs))
        data = self.programs[which]
        self.send("BEGIN", 0, len(data))
        for at in range(0, len(data), PIECE):
            self.send("DATA", at, rest=data[at : at + PIECE])
            if self.noise:
                self.ticks(1)
        self.said.commits[self.number + 1] = self.hashes[which]
        self.send("COMMIT", 0, len(data), zlib.crc32(data[:-4]))
        return struct.unpack("<I", data[-4:])[0]

    def set(self):
        """Values that were never sent before."""
        self.value += 1
        k, push = 1.0 + self.value % 4096 / 64, self.value * 2.0**-10
        self.said.sets[self.number + 1] = (k, push)
        self.send("SET", 2, rest=struct.pack("<BfBf", 0, k, 1, push))

    def start(self, crc, force_max=None, passive=None):
        force_max = self.rng.choice((0.25, 1.0, 3.0, 100.0)) if force_max is None else force_max
        passive = self.rng.random() < 0.1 if passive is None else passive
        most = 0 if passive else round(min(force_max, KEPT.force_max) / KEPT.force_full * FULL) + 1
        self.said.starts[self.number + 1] = (crc, most)
        self.send("START", crc, self.rng.choice((1, 1, 5)), int(passive), force_max)

    def converse(self):
        """One session, as a person makes them."""
        rng = self.rng
        self.hello()
        self.send("CLEAR")
        self.send("HOME", self.counts * KEPT.metres_per_count)
        crc = self.upload()
        self.set()
        self.start(crc)
        for _ in range(rng.randrange(1, 12)):
            self.ticks(rng.randrange(1, 12), jump=0.02)
            act = rng.random()
            if act < 0.5:
                self.set()
            elif act < 0.6:
                self.send("STOP")
            elif act < 0.7:
                self.start(crc)
            elif act < 0.8:
                crc = self.upload()  # refused in a run where there is one place
                self.set()
                self.start(crc)
            elif act < 0.84:
                self.send("CLEAR")
            elif act < 0.86:
                self.send("ARM", rng.randrange(2))
            elif act < 0.87:
                for _ in range(13):  # the host does not speak for 100 ms, whatever others on the line ask
                    self.ticks(10)
                    other = rng.choice((("PING", 7), ("READ", 0, 40), ("STATUS", self.session ^ 1)))
                    self.deliver(encode(other[0], rng.randrange(256), *other[1:]))
                self.events.append(("?", "silent", None))
            else:
                self.send(*rng.choice((("STATUS", self.session), ("PING", 7), ("READ", 0, 40))))
        if rng.random() < 0.7:
            self.send("STOP")
        if rng.random() < 0.02:
            self.events.append(("N", b"", None))

    def recover(self):
        """The noise is over: one hello is enough, and everything works. The first ends what garbage had begun."""
        self.noise, self.held = 0.0, []
        self.deliver(b"\0")
        self.hello()
        self.events.append(("?", "WELCOME", None))
        self.send("CLEAR")
        self.ticks(3)
        self.send("HOME", self.counts * KEPT.metres_per_count)
        crc = self.upload()
        self.set()
        self.start(crc, 100.0, False)
        self.ticks(20)
        self.events.append(("?", "runs", None))
        self.send("STOP")
        self.events.append(("?", "stopped", None))


class Model:
    """What the board may be, from what was said."""

    def __init__(self, talk):
        self.sessions = talk.sessions
        self.crc_of = {h: struct.unpack("<I", p[-4:])[0] for h, p in zip(talk.hashes, talk.programs, strict=True)}
        self.session = self.obeyed = self.most = self.before = 0
        self.last_set, self.start = 0, None
        self.seen = Counter()

    def restart(self):
        self.session = self.obeyed = 0

    def judge(self, state, duty, session, obeyed, hash, values, out, ticked):
        if session != self.session:
            assert session in self.sessions, "a session nobody began"
            self.session, self.obeyed, self.start = session, 0, None
        assert obeyed >= self.obeyed, "an older request was obeyed after a newer one"
        said = self.sessions.get(session, Said())
        self.before = self.most if ticked else max(self.before, self.most)  # what a switch finds stays until the tick
        for number in range(self.obeyed + 1, obeyed + 1):  # one piece of the line may hold a START and what follows it
            if number in said.starts and state == RUN and accepted(out, number):
                self.start, self.last_set = number, 0
                self.seen["starts"] += 1
        self.obeyed = obeyed
        if state == RUN:
            assert self.start is not None, "it runs, and nobody in this session said START"
            crc, self.most = said.starts[self.start]
            commits = [k for k, h in said.commits.items() if h == hash and k < self.start]
            assert commits and self.crc_of[hash] == crc, "a program that was never sent runs"
            sets = [k for k, v in said.sets.items() if v == values and min(commits) < k <= obeyed]
            assert sets and max(sets) >= self.last_set, "parameters that were never sent, or older ones"
            self.last_set = max(sets)
        assert duty <= max(self.before, self.most), "more force than was allowed"
        if state != RUN:
            self.most = self.before = 0
        self.seen["states", state] += 1


def accepted(out, number):
    """Whether a START of this number was said to be done: while the old program ran it may have been refused."""
    acks = [f for f in Decoder().feed(out) if f.message == "ACK" and f.sequence == number & 255]
    return any(f.fields["request"] == MESSAGES["START"].number and f.fields["result"] == 0 for f in acks)


def build(tmp_path, slots):
    """Return the driver, with sanitizers."""
    firmware = firmware_library.firmware_folder()
    files = [f for f in toolchain.sources(firmware) if f != "boards/host/host.c"]
    path = tmp_path / (f"fuzz{slots}" + (".exe" if os.name == "nt" else ""))
    here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fuzz_link.c")
    flags = (*SANITIZERS, f"-DHL_SLOTS={slots}")
    compiler = toolchain.compilers(toolchain.running_target())[0]
    command = toolchain.build_command(compiler, firmware, 16, path, *flags, files=[*files, here])
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"no sanitizers here: {done.stderr.splitlines()[:1]}")
    return path


def fuzz(path, talk):
    """Run the events; return what was seen."""
    packed = []
    for kind, data, _ in talk.events:
        if kind == "R":
            packed.append(b"R" + struct.pack("<H", len(data)) + data)
        elif kind in "TN":
            packed.append(kind.encode() + data)
    environment = {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}
    ran = subprocess.run([path], input=b"".join(packed), capture_output=True, env=environment)
    assert ran.returncode == 0, ran.stderr.decode()[:3000]
    model, at, out, report = Model(talk), 0, b"", None
    for kind, data, why in talk.events:
        if kind == "?":
            check(data, report, out, model)
            continue
        report = REPORT.unpack_from(ran.stdout, at)
        at += REPORT.size + report[-1]
        out = ran.stdout[at - report[-1] : at]
        if kind == "N":
            model.restart()
        state, _, duty, session, obeyed, hash, k, push, _ = report
        try:
            model.judge(state, duty, session, obeyed, hash, (k, push), out, kind == "T")
        except AssertionError as wrong:
            raise AssertionError(f"{wrong}; after {kind} {data.hex(' ')} ({why})") from wrong
    assert at == len(ran.stdout)
    return model.seen


def check(what, report, out, model):
    state, duty = report[0], report[2]
    if what == "WELCOME":
        assert [f.message for f in Decoder().feed(out)] == ["WELCOME"], "one hello was not enough"
    elif what == "silent":
        assert state != RUN, "it runs without a host"
    elif what == "runs":
        assert state == RUN and duty > 0
        model.seen["recoveries"] += 1
    else:
        assert state == IDLE


def talk_of(frames, seed, word_bits=16):
    talk = Talk(seed, word_bits)
    while talk.frames < frames:
        talk.noise = talk.rng.choice((0.02, 0.05, 0.1, 0.3))
        for _ in range(10):
            talk.converse()
        talk.recover()
    return talk


@pytest.mark.wide
@pytest.mark.parametrize("frames", [60_000, pytest.param(250_000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("slots", [1, 2])
def test_a_bad_link_never_moves_the_motor_wrongly_and_always_recovers(tmp_path, slots, frames, capsys):
    talk = talk_of(frames, seed=slots)
    seen = fuzz(build(tmp_path, slots), talk)
    damaged = sum(talk.kinds[kind] for kind in NOISE)
    with capsys.disabled():
        print(f"\n{slots} place(s): {talk.frames} frames, {damaged} of them damaged or moved {dict(talk.kinds)}; "
              f"{seen['starts']} starts, {seen['recoveries']} recoveries of as many")  # fmt: skip
    assert talk.frames >= frames and min(talk.kinds[kind] for kind in NOISE) > 50
    assert seen["starts"] > frames / 100 and seen["states", RUN] > frames / 20
    assert seen["recoveries"] == sum(e[1] == "runs" for e in talk.events) > 5
