"""The two images that hapkit.py compares, each on an emulated Uno with a handle: hapticlab's firmware, and hapkit.c."""

import subprocess
import tempfile
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from unittest import mock

import numpy as np
from build_image import symbols, tool
from closed_loop import SQRT, STEP, ClosedLoop, MagnetoresistiveSensor, PaddleHandle
from emulated import emulated_uno
from emulator import Uno

import hapticlab as hl
from hapticlab.device.board.settings import nominal

SOURCE = Path(__file__).with_name("hapkit.c")
FLAGS = "-mmcu=atmega328p -DF_CPU=16000000UL -std=c99 -Os -Wall -Wextra -Wpedantic -Wconversion".split()
K, X_WALL, METRES = 150.0, 0.002, 12.8e-6  # N/m, m, m of a count: as in hapkit.c
FULL = 0.03 / (0.004191 * 0.065659 / 0.073152)  # N at full duty: 0.03 N m of torque at the motor
HOLD = 0.005  # s, on every step of the staircase
LEVELS = METRES * (np.floor(np.arange(0, 0.0121, 0.00025) / METRES) + 0.5)  # m, in the middle of a count
SETTINGS = nominal("hapkit", wired=1, checked=1, ident=1, date=20261120, force_full=FULL)
k, x_o = hl.parameters("k x_o", units="N/m m")
SPRING_WALL = hl.Scene(force=hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o)), name="wall")(k=K, x_o=X_WALL)


class Led:
    """A handle led along ``path(t)`` [m] whatever the force; keeps the motor's force [N] of every step."""

    def __init__(self, path):
        self.path, self.forces = path, []

    def step(self, force, seconds):
        """Go on by ``seconds``; the force is the one until now."""
        self.forces.append(force)
        return self.path(len(self.forces) * seconds)


@cache
def sketch_image(every=0, millis=1):
    """Build hapkit.c; return the paths of its .hex and .elf."""
    folder = Path(tempfile.mkdtemp(prefix="hapkit"))
    elf, image = folder / "hapkit.elf", folder / "hapkit.hex"
    options = [f"-DEVERY={every}", f"-DMILLIS={millis}"]
    subprocess.run([tool("avr-gcc"), *FLAGS, *options, SOURCE, "-lm", "-o", elf], check=True)
    subprocess.run([tool("avr-objcopy"), "-O", "ihex", elf, image], check=True)
    return image, elf


class Sketch:
    """The published loop on an emulated Uno."""

    def __init__(self, loop, names):
        self.loop, self._names = loop, names

    def wait(self, seconds):
        self.loop.run(seconds)

    def variable(self, name, dtype="float32"):
        """Return one of the sketch's global variables, now: read until it is the same 200 cycles later, for it has 4 bytes."""
        board, address = self.loop.board, self._names[name] - 0x800000
        last = None
        while last != (last := board.at(address, dtype)[()]):
            board.run_to(board.cycle + 200)
        return last

    def velocities(self, seconds):
        """Go on for so long, and return the velocity that the sketch sees, every millisecond [m/s]."""
        found = []
        for _ in range(round(1e3 * seconds)):
            self.wait(1e-3)
            found.append(self.variable("vh"))
        return np.array(found)


@contextmanager
def sketch(every=0, millis=1, hand=None):
    """Run the sketch from its reset on; timer 0 must run in the emulator, for its interrupt."""
    image, elf = sketch_image(every, millis)
    with Uno(image, carrier=5) as board:
        handle = PaddleHandle(hl.SimulatedPaddle.from_profile("hapkit", hand=hand))
        loop = ClosedLoop(board, handle, MagnetoresistiveSensor(METRES), force_full=FULL, law=SQRT)
        yield Sketch(loop, symbols(elf))


@contextmanager
def firmware(T, hand=None):
    """Run hapticlab's firmware with the wall in its bytecode; a session's number is random, and moves some bytes: not here."""
    with mock.patch("secrets.randbits", return_value=1), emulated_uno(hand, T=T, settings=SETTINGS) as paddle:
        paddle.start(SPRING_WALL, check_fit=False)
        yield paddle


def staircase(board):
    """Lead the handle into the wall in steps, and return the duty at the end of each."""
    board.loop.handle = Led(lambda t: LEVELS[min(int(t / HOLD), len(LEVELS) - 1)])
    board.wait(len(LEVELS) * HOLD)
    ends = np.round(np.arange(1, len(LEVELS)) * HOLD / STEP).astype(int) - 1
    return np.rint(256 * np.sqrt(np.abs(np.array(board.loop.handle.forces)[ends]) / FULL))


def wall_force():
    """Return the force of the wall at LEVELS, as the sensor counts them [N]; the last is on its way still."""
    return K * np.maximum(METRES * np.floor(LEVELS[:-1] / METRES) - X_WALL, 0)
