"""The bad link of test_fuzz.py into the real image of the Pico, in USB packets of any size: it moves only as it was told."""

import random
import re
import struct
import subprocess
from functools import cache

import pytest
from bare import scratch
from build_image import FIRMWARE, build_image, symbols
from pico_emulator import Pico, missing
from pico_loop import PaddleHandle, flash_of, hapkit, image, loop_of
from test_fuzz import FULL, IDLE, NOISE, RUN, Said, talk_of

from hapticlab.device.link.messages import MOTOR_LAWS
from hapticlab.device.link.wire import Decoder, encode
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
LINEAR = MOTOR_LAWS["LINEAR"]
#: as host_driver has them: 8 N at full duty, at most 4 N
KEPT = hapkit("QUADRATURE", motor_law=LINEAR, force_full=8.0, force_max=4.0, force_continuous=4.0, speed_max=1e3)
TICK, PIECE = 0.8e-3, 0.2e-3  # [s] for a tick of the talk, and after what came: 130 ticks are longer than a host may be silent
FIELDS = ("state", "session", "obeyed")


@cache
def offsets():
    """Return where the fields of hl_core are, as the image's compiler lays them."""
    code = '#include "core.h"\n#include <stddef.h>\n'
    code += "".join(f"const unsigned at_{name} = offsetof(hl_core, {name});\n" for name in FIELDS)
    source, listing = scratch() / "offsets.c", scratch() / "offsets.s"
    source.write_text(code)
    subprocess.run([*build_image.clang("pico"), "-S", source, "-o", listing], cwd=FIRMWARE, check=True)
    text = listing.read_text()
    return {name: int(re.search(rf"at_{name}:\n\s+\.long\s+(\d+)", text)[1]) for name in FIELDS}


class Board:
    """The emulated Pico and what is known of it after each event."""

    def __init__(self, board, seed):
        self.board, self.rng, self.core = board, random.Random(seed), symbols(image().with_suffix(".elf"))["pico_core"]
        self.session = self.obeyed = 0

    def look(self):
        """Return state, session, number of the last request that was obeyed, and the duty's magnitude of 1."""
        numbers = [struct.unpack("<I", self.board.peek(self.core + offsets()[name], 4))[0] for name in FIELDS]
        return numbers[0] & 255, *numbers[1:], abs(self.board.duty) / 256

    def take(self, data):
        """Bytes come in packets as a host happens to make them."""
        while data:
            size = self.rng.choice((1, 3, 17, 64, 200))
            self.board.write(data[:size])
            data = data[size:]
        self.board.run(PIECE)
        while self.board.unsent:
            self.board.run(PIECE)

    def judge(self, sessions):
        assert self.board.halted is None
        state, session, obeyed, duty = self.look()
        assert session == 0 or session in sessions, "a session nobody began"
        if session != self.session:
            self.session, self.obeyed = session, 0
        assert obeyed >= self.obeyed, "an older request was obeyed after a newer one"
        self.obeyed = obeyed
        most = max((most for _, most in sessions.get(session, Said()).starts.values()), default=0) / FULL
        assert duty <= most + 1 / 4096, "more force than was allowed"
        assert state == RUN or duty == 0, "the motor is on and nothing runs"
        return state


def fuzz(frames, seed):
    """Return how many frames came, how many of them damaged, and how often it had to recover and did."""
    talk, recoveries = talk_of(frames, seed, word_bits=8), 0
    with Pico(flash=flash_of(KEPT)) as chip:
        loop = loop_of(KEPT.to_float32(), chip, PaddleHandle(SimulatedPaddle.from_profile("hapkit")))
        loop.run_until(lambda: chip.configured, 0.1)
        chip.open_port()
        chip.run(0.001)
        board = Board(chip, seed)
        for kind, data, why in talk.events:
            if kind == "R":
                board.take(data)
            elif kind == "T":
                count = struct.unpack("<HII", data)[0]
                chip.run(TICK * count)
            elif kind == "?" and why is None:
                state = board.judge(talk.sessions)
                said = [frame.message for frame in Decoder().feed(chip.read())]
                assert data != "WELCOME" or "WELCOME" in said, "one hello was not enough"
                assert data != "silent" or state != RUN, "it runs without a host"
                assert data != "stopped" or state == IDLE
                assert data != "runs" or state == RUN
                recoveries += data == "runs"
            board.judge(talk.sessions)
        facts = chip.facts
    assert facts["usb"]["errors"] == facts["violations"] == []
    return talk.frames, sum(talk.kinds[kind] for kind in NOISE), recoveries


@pytest.mark.wide
@pytest.mark.parametrize("frames", [500, pytest.param(40_000, marks=pytest.mark.slow)])
def test_a_bad_link_never_moves_the_motor_wrongly_and_always_recovers(frames, capsys):
    count, damaged, recoveries = fuzz(frames, seed=3)
    with capsys.disabled():
        print(f"\nPico: {count} frames, {damaged} of them damaged or moved; {recoveries} recoveries of as many")
    assert count >= frames and damaged > frames / 50 and recoveries > 0


@pytest.mark.wide
def test_no_control_request_of_a_strange_host_stops_it():
    """Any eight bytes but those by which a host takes its address or configuration away, or closes the port."""
    rng = random.Random(4)
    with Pico(flash=flash_of(KEPT)) as chip:
        chip.run(0.03)
        chip.open_port()
        for k in range(200):
            kind, request = rng.choice((0x80, 0x00, 0x81, 0x01, 0xA1, 0x21, 0xC0, 0x40, rng.randrange(256))), rng.randrange(40)
            if request in (5, 9, 0x20, 0x22):
                continue
            length = rng.choice((0, 1, 7, 18, 64, 255))
            value, index = rng.choice((0, 0x100, 0x200, 0x300, 0x600, rng.randrange(65536))), rng.choice((0, 1, 0x409))
            chip.setup(struct.pack("<BBHHH", kind, request, value, index, min(length, 255 if kind & 0x80 else 64)))
            chip.run(0.002)
            chip.write(encode("PING", k & 255, k))
            chip.run(0.001)
            frames = Decoder().feed(chip.read())
            assert [frame.fields["token"] for frame in frames] == [k], f"request {kind:02x} {request:02x} {value:04x}"
        assert chip.facts["usb"]["errors"] == chip.facts["violations"] == []


@pytest.mark.wide
def test_plugged_in_again_it_forgets_a_request_that_was_cut():
    """What was given for the old request answered the first one of the new session, and the computer found no port."""
    with Pico(flash=flash_of(KEPT)) as chip:
        chip.run(0.03)
        for late in (20e-6, 30e-6, 40e-6, 60e-6, 80e-6):
            chip.setup(struct.pack("<BBHHH", 0x80, 6, 0x200, 0, 75))  # its configuration: two packets
            chip.run(late)
            chip.attach(False)
            chip.run(0.004)
            chip.attach(True)
            chip.run(0.03)
            assert chip.configured, late
        assert chip.facts["usb"]["errors"] == []
