"""An Arduino Uno in simavr, cycle by cycle in virtual time, with the motor's pins, the sensor and the link in Python."""

import ctypes
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
from build_image import tool

from hapticlab.device.setup.intel_hex import parse_hex

CYCLES_PER_SECOND = 16_000_000
POWER, EXTERNAL, BROWN_OUT, WATCHDOG = 1, 2, 4, 8  # bits of MCUSR
INT0, INT1, TIMER1_COMPA, USART_RX, USART_UDRE = 1, 2, 11, 18, 19  # interrupt vectors
RAM_BEGIN, RAM_END = 0x100, 0x900
PAINT = 0xC7
LOG = 1 << 14


def missing():
    """Why there can be no emulator here, or None."""
    if not shutil.which("cc"):
        return "the emulator needs a C compiler called cc"
    if not Path("/usr/include/simavr/sim_avr.h").exists():
        return "the emulator needs simavr: apt-get install libsimavr-dev libelf-dev"
    try:
        tool("avr-gcc")
    except SystemExit as problem:  # no toolchain, or another one
        return str(problem)
    return None


class Driver(ctypes.Structure):
    """The motor's driver, as simavr_paddle.h has it."""

    _fields_ = (
        ("drive", ctypes.c_int), ("pins", 4 * ctypes.c_uint8), ("conflicts", ctypes.c_uint64),
        ("shifting", ctypes.c_uint8), ("held", ctypes.c_uint8), ("was", ctypes.c_uint8),
    )  # fmt: skip


class As5048a(ctypes.Structure):
    """An angle sensor on the SPI, as simavr_paddle.h has it."""

    _fields_ = (
        ("select", ctypes.c_uint8), ("angle", ctypes.c_uint16), ("zeros", ctypes.c_uint16), ("ones", ctypes.c_uint16),
        ("flips", ctypes.c_uint16), ("diagnostics", ctypes.c_uint16), ("answer", ctypes.c_uint16), ("out", ctypes.c_uint16),
        ("in_", ctypes.c_uint16), ("errors", ctypes.c_uint16), ("bits", ctypes.c_uint8), ("selected", ctypes.c_uint8),
        ("since", ctypes.c_uint64), ("hasty", ctypes.c_uint64), ("latched", ctypes.c_uint64),
    )  # fmt: skip


@cache
def library():
    """The compiled shim."""
    folder = tempfile.mkdtemp(prefix="simavr")
    target = Path(folder) / "shim.so"
    sources = [Path(__file__).with_name(name) for name in ("simavr_shim.c", "simavr_paddle.c")]
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-I/usr/include/simavr", "-o", target, *sources, "-lsimavr"], check=True)
    shim = ctypes.CDLL(str(target))
    shutil.rmtree(folder)
    shim.uno_adc.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_uint16)
    shim.uno_fly.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_uint16, ctypes.c_uint64, ctypes.c_uint64)
    shim.uno_carrier.restype = ctypes.c_double
    shim.uno_driver.restype, shim.uno_sensor.restype = ctypes.POINTER(Driver), ctypes.POINTER(As5048a)
    shim.uno_run.argtypes = (ctypes.c_void_p, ctypes.c_uint64)
    shim.uno_new.restype = ctypes.c_void_p
    shim.uno_memory.restype = ctypes.POINTER(ctypes.c_uint8)
    shim.uno_cycle.restype = shim.uno_overruns.restype = ctypes.c_uint64
    shim.uno_pc.restype = ctypes.c_uint32
    shim.uno_waiting.restype = shim.uno_read.restype = shim.uno_events.restype = ctypes.c_uint32
    return shim


class Uno:
    """One board. Time stands still but for :meth:`run`.

    Parameters
    ----------
    image : path
        The .hex file.
    eeprom : bytes, optional
        What it holds from its address 0 on; 0xff elsewhere.
    cause : int
        MCUSR as the reset leaves it.
    carrier : int
        Give this pin, of D3, D5 and D6, the edges of its PWM: slower. 0: none.

    Attributes
    ----------
    cycle : int
        Cycles since it was made.
    memory : array of uint8
        Registers and RAM, live; what is written here goes past the hooks of registers.
    """

    hz = CYCLES_PER_SECOND

    def __init__(self, image, *, eeprom=b"", cause=POWER, carrier=0):
        self._shim = library()
        flash = parse_hex(Path(image).read_text(), str(image))
        self._uno = ctypes.c_void_p(self._shim.uno_new(flash, ctypes.c_uint32(len(flash)), int(carrier)))
        self.memory = np.ctypeslib.as_array(self._shim.uno_memory(self._uno), (RAM_END,))
        self.memory[RAM_BEGIN:] = PAINT
        self.cycle = 0
        self.eeprom = eeprom
        self.reset(cause)

    def close(self):
        """Give its memory back."""
        if self._uno:
            self.memory = None
            self._shim.uno_free(self._uno)
            self._uno = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def reset(self, cause=EXTERNAL):
        """Reset; RAM stays as it is."""
        self._shim.uno_reset(self._uno, ctypes.c_uint8(cause))

    def run(self, seconds):
        """Run this much longer."""
        self.run_to(self.cycle + round(seconds * CYCLES_PER_SECOND))

    def run_to(self, cycle):
        """Run to a cycle: the first instruction that ends there or behind it."""
        going = self._shim.uno_run(self._uno, cycle)
        self.cycle = self._shim.uno_cycle(self._uno)
        if not going:
            at = self._shim.uno_pc(self._uno)
            raise RuntimeError(f"the processor stopped at address 0x{at:04x} after {self.now:.6f} s")

    @property
    def now(self):
        """Virtual time [s]."""
        return self.cycle / CYCLES_PER_SECOND

    def adc(self, counts, channel=2):
        """Put a pin of the ADC at so many counts."""
        self._shim.uno_adc(self._uno, channel, int(counts))

    def fly(self, counts, seconds, after=0.0, channel=2):
        """Let a pin of the ADC fly to so many counts in some time, and begin after some time."""
        begin = self.cycle + round(after * CYCLES_PER_SECOND)
        self._shim.uno_fly(self._uno, channel, int(counts), begin, begin + round(seconds * CYCLES_PER_SECOND))

    def wire(self, drive, pins):
        """Connect the motor's driver, by the numbers of DRIVES and the pins of Settings."""
        self._shim.uno_drive(self._uno, drive, bytes(pins).ljust(4, b"\xff"))

    @property
    def driver(self):
        """The motor's Driver, live."""
        return self._shim.uno_driver(self._uno).contents

    @property
    def sensor(self):
        """The As5048a, live; it is connected where its ``select`` is a pin."""
        return self._shim.uno_sensor(self._uno).contents

    def high(self, pin):
        """How much of the time a pin is high, in 256ths; -1 where it is an input."""
        return self._shim.uno_high(self._uno, pin)

    def carrier(self, pin):
        """Frequency of the PWM on a pin [Hz], 0 where there is none."""
        return self._shim.uno_carrier(self._uno, pin)

    def pin(self, pin, level):
        """Drive D0 to D7."""
        self._shim.uno_pin(self._uno, pin, int(level))

    @property
    def duty(self):
        """Duty of the motor from the pins of its driver, -256 to 256; on a Hapkit's, positive with D8 high."""
        return self._shim.uno_duty(self._uno)

    def duties(self):
        """Every change of the duty, the latest 16384: cycles and duties."""
        return self._events(0)

    def edges(self):
        """Every change of ``carrier``'s pin, else D5, the latest 16384: cycles and levels. Of the PWM only with ``carrier``."""
        return self._events(1)

    def samples(self):
        """Cycles at which the ADC's conversions, the latest 16384, hold their input: 1.5 of its clocks after they begin."""
        begun, prescaler = self._events(2)
        return begun + 3 * prescaler // 2

    def updates(self):
        """Cycles at which the motor's registers were written, the latest 16384, whether the duty changed or not."""
        return self._events(3)[0]

    def update_duties(self):
        """The duty after each of them."""
        return self._events(3)[1]

    def _events(self, which):
        cycles, values = (ctypes.c_uint64 * LOG)(), (ctypes.c_int32 * LOG)()
        count = self._shim.uno_events(self._uno, which, cycles, values)
        return np.array(cycles[:count], dtype=np.int64), np.array(values[:count])

    def write(self, data):
        """Queue bytes for its receiver, one after the other at the true rate."""
        self._shim.uno_write(self._uno, bytes(data), ctypes.c_uint32(len(data)))

    @property
    def waiting(self):
        """Bytes it has sent that nobody has read."""
        return self._shim.uno_waiting(self._uno)

    def read(self, size=65536):
        """Bytes it has sent."""
        data = ctypes.create_string_buffer(size)
        count = self._shim.uno_read(self._uno, data, ctypes.c_uint32(size))
        return data.raw[:count]

    @property
    def overruns(self):
        """Bytes lost because the receiver's buffer was full."""
        return self._shim.uno_overruns(self._uno)

    def at(self, address, dtype="uint8"):
        """Memory from an address on as one number or record, live: ``board.at(0x100, "int16")[()] = 5``."""
        return self.memory[address : address + np.dtype(dtype).itemsize].view(dtype).reshape(())

    @property
    def eeprom(self):
        """All 1024 bytes of the EEPROM."""
        data = ctypes.create_string_buffer(1024)
        self._shim.uno_eeprom(self._uno, 0, data, ctypes.c_uint32(1024))
        return data.raw

    @eeprom.setter
    def eeprom(self, data):
        self._shim.uno_eeprom(self._uno, 1, bytes(data).ljust(1024, b"\xff"), ctypes.c_uint32(1024))

    def stack_left(self, end):
        """Bytes between address ``end`` and the deepest the stack has been; memory was painted at the beginning."""
        used = np.flatnonzero(self.memory[end:] != PAINT)
        return int(used[0]) if used.size else RAM_END - end

    def cost(self, vector):
        """An interrupt's count, mean and worst cycles from its call to the end of its return."""
        numbers = (ctypes.c_uint64 * 3)()
        self._shim.uno_cost(self._uno, vector, numbers)
        count, total, worst = numbers
        return count, total / count if count else 0.0, worst
