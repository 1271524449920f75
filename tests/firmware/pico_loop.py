"""The emulated Pico closed around a handle, connected as any board is: ``pico://name``, :func:`emulated_pico`."""

import math
import tempfile
import zlib
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import serial
from build_image import build
from closed_loop import LINEAR, SQRT, ClosedLoop, MagnetoresistiveSensor, PaddleHandle
from pico_emulator import FIRST_ADC_PIN, Pico

from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal, pin_word, pins_of
from hapticlab.device.link.messages import DRIVES, MOTOR_LAWS, SENSORS
from hapticlab.device.setup.drive.uf2_blocks import parse_uf2
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle

BOARDS, HANDLERS = {}, "ports"
SECTOR, FLASH = 4096, 2 << 20
#: a Hapkit whose parts are on a Pico: 4 counts of its converter for one of an Uno's, PWM on GP2, direction on GP3
WRAP, LOW = 3680, 208
WIRING = {
    "MAGNETORESISTIVE": {"sensor_pins": pin_word(26), "wrap": WRAP, "metres_per_count": 3.2e-6},
    "QUADRATURE": {"sensor_pins": pin_word(10, 11), "metres_per_count": 1e-5},
    "AS5048A": {"sensor_pins": pin_word(17), "wrap": 16384, "metres_per_count": 7e-7},
}


def offer(name, loop):
    """Let ``pico://name`` open this loop, and return the URL."""
    if HANDLERS not in serial.protocol_handler_packages:
        serial.protocol_handler_packages.append(HANDLERS)
    BOARDS[name] = loop
    return f"pico://{name}"


@cache
def image():
    """The firmware as the sources are now."""
    return Path(build("pico", tempfile.mkdtemp(prefix="pico"))[1])


def hapkit(sensor="MAGNETORESISTIVE", **changes):
    """Return settings of a Hapkit on a Pico."""
    found = {"motor_pins": pin_word(2, 3), "wired": 1, "checked": 1, "ident": 0x3F2A, "date": 20261120}
    return nominal("hapkit", **{**found, "sensor": SENSORS[sensor], **WIRING[sensor], **changes})


def kept(settings, turn=1):
    """Return the sector of flash that keeps these settings, as store.c has it."""
    content = settings.to_bytes().ljust(SECTOR - 16, b"\xff")
    number = turn.to_bytes(4, "little")
    return number + b"\xff" * 8 + zlib.crc32(content, zlib.crc32(number)).to_bytes(4, "little") + content


def flash_of(settings=None):
    """Return all of the flash: the image, and what it keeps."""
    flash = bytearray(b"\xff" * FLASH)
    for at, data in parse_uf2(image().read_bytes()):
        flash[at & 0xFFFFFF : (at & 0xFFFFFF) + len(data)] = data
    if settings:
        flash[-2 * SECTOR : -SECTOR] = kept(settings)
    return bytes(flash)


class AngleSensor:
    """A magnet before an AS5048A."""

    def __init__(self, settings, offset=5000):
        self.settings, self.offset = settings, offset

    def show(self, board, x):
        """Turn the magnet to where a handle at ``x`` [m] has it."""
        board.angle(math.floor(x / self.settings.metres_per_count + self.offset) % self.settings.wrap)


class Encoder:
    """A quadrature encoder on two pins, the first leading when counts grow; its edges are spread over one step."""

    def __init__(self, settings, spread=40e-6):
        self.metres_per_count, self.pins, self.spread = settings.metres_per_count, pins_of(settings.sensor_pins)[:2], spread
        self.count = None

    def show(self, board, x):
        """Walk the lines to where a handle at ``x`` [m] puts them."""
        goal = math.floor(x / self.metres_per_count)
        edges = abs(goal - self.count) if self.count is not None else 0
        if not edges:
            self._drive(board, goal)
        for k in range(edges):
            self._drive(board, self.count + (1 if goal > self.count else -1))
            if k < edges - 1:
                board.run(self.spread / edges)

    def _drive(self, board, count):
        self.count = count
        for pin, level in zip(self.pins, ((0, 0), (1, 0), (1, 1), (0, 1))[count % 4], strict=True):
            board.pin(pin, level)


def loop_of(settings, board, handle):
    """Close a board around a handle as its settings say that both are."""
    drive = next(name for name, number in DRIVES.items() if number == settings.drive)
    pin = pins_of(settings.sensor_pins)[0]
    board.wire(drive, pins_of(settings.motor_pins), pin if settings.sensor == SENSORS["AS5048A"] else None)
    if settings.sensor == SENSORS["MAGNETORESISTIVE"]:
        sensor = MagnetoresistiveSensor(
            settings.metres_per_count, settings.wrap, LOW, offset=1200, flight=settings.sensor_flight, channel=pin - FIRST_ADC_PIN
        )
    else:
        sensor = AngleSensor(settings) if settings.sensor == SENSORS["AS5048A"] else Encoder(settings)
    law = SQRT if settings.motor_law == MOTOR_LAWS["SQRT"] else LINEAR
    return ClosedLoop(
        board, handle, sensor, force_full=settings.force_full, law=law, motor_sign=settings.motor_sign,
        dead=settings.duty_dead, delay=settings.sensor_delay, noise=settings.sensor_noise,
    )  # fmt: skip


@contextmanager
def emulated_pico(hand=None, *, T=1e-3, home=True, settings=None, **changes):
    """A SerialPaddle on an emulated Pico whose handle is a simulated hapkit's; it is told where that is, unless not ``home``."""
    settings = settings or hapkit()
    mechanics = SimulatedPaddle.from_profile("hapkit", hand=hand, **changes)
    with Pico(flash=flash_of(settings)) as board:
        loop = loop_of(settings.to_float32(), board, PaddleHandle(mechanics))
        with SerialPaddle(offer(f"emulated{id(loop)}", loop), T=T) as paddle:
            paddle.loop = loop
            if home:
                paddle.home(at=loop.x)
            yield paddle
