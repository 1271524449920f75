"""The boards, one record each: what a program has there, how it is found on a USB port, and how firmware comes onto it.

What is measured of a board stands in ``costs.json``, its firmware in a folder of ``firmware/boards``. All else that knows
boards reads these records: the cost model, ``hapticlab ports`` and ``flash``, the choices of the command line, the build
of an image, the rules for udev; a test compares them with the firmware's constants.
"""

from __future__ import annotations

from dataclasses import dataclass

from .board_pins import PICO_PINS, UNO_PINS, Pins


@dataclass(frozen=True)
class Usb:
    """A USB device by which a board is known: its vendor's and product's numbers, and what people call it."""

    vendor: int
    product: int
    words: str


@dataclass(frozen=True)
class Bootloader:
    """A bootloader that speaks STK500: its name, its speed, and where it begins, which is where a program ends."""

    name: str
    baudrate: int
    start: int


@dataclass(frozen=True)
class Flashing:
    """How firmware is built and written.

    Attributes
    ----------
    called : str
        The board in a sentence, with its article.
    image : str
        In firmware/prebuilt.
    chip : str
        As its compiler names it, but for capitals.
    signature : bytes
    ram, page : int
        Of the chip [bytes].
    bootloaders : tuple of Bootloader
    """

    called: str
    image: str
    chip: str
    signature: bytes
    ram: int
    page: int
    bootloaders: tuple[Bootloader, ...]


@dataclass(frozen=True)
class Drive:
    """How firmware is built, and copied to a board whose own ROM shows itself as a drive (UF2).

    Attributes
    ----------
    called : str
        The board in a sentence, with its article.
    image : str
        In firmware/prebuilt.
    chip : str
        As people call it.
    processor : str
        As its compiler names it.
    name : str
        What the drive is called, and the Board-ID in its INFO_UF2.TXT.
    family : int
        Of UF2 files for this chip.
    ram, flash : int
        What an image may take [bytes].
    """

    called: str
    image: str
    chip: str
    processor: str
    name: str
    family: int
    ram: int
    flash: int


@dataclass(frozen=True)
class Board:
    """A board.

    Attributes
    ----------
    name : str
    hz : float or None
        Processor clock [Hz]; None where time is not the program's to fill.
    word_bits : int
        Of a program's words: 8 numbers 256 registers.
    arena : int
        Memory of one program, its bytes and its registers [bytes].
    channels : int
        Numbers in a sample: x, v, F and what is watched; a frame of the link carries at most 10.
    T_max : float
        Longest period [s].
    link : float or None
        What its own USB carries [bytes/s]; None where the line's baud rate says so.
    usb : tuple of Usb
        Empty for a board that is modelled and was never on a port.
    flashing : Flashing or Drive, optional
        None where this package brings no firmware for it.
    pins : Pins, optional
        What a wiring may ask of it; None where this package brings no firmware for it.
    """

    name: str
    hz: float | None
    word_bits: int
    arena: int
    channels: int
    T_max: float = 10e-3
    link: float | None = None
    usb: tuple[Usb, ...] = ()
    flashing: Flashing | Drive | None = None
    pins: Pins | None = None


UNO = Board(
    name="uno",
    hz=16e6,
    word_bits=8,
    arena=848,
    channels=8,
    # boards.txt of ArduinoCore-avr; for the bridges on copies the device tables of Linux's ch341.c, cp210x.c, ftdi_sio_ids.h
    usb=(
        Usb(0x2341, 0x0043, "Arduino Uno R3"),
        Usb(0x2341, 0x0001, "Arduino Uno"),
        Usb(0x2341, 0x0243, "Genuino Uno"),
        Usb(0x2A03, 0x0043, "Arduino Uno (arduino.org)"),
        Usb(0x2341, 0x006A, "Arduino Uno Mini"),
        Usb(0x1A86, 0x7523, "CH340 (copies of the Uno and Nano)"),
        Usb(0x1A86, 0x5523, "CH341 (copies of the Uno and Nano)"),
        Usb(0x0403, 0x6001, "FT232R (Hapkit board, Nano)"),
        Usb(0x0403, 0x6015, "FT231X (copies of the Uno)"),
        Usb(0x10C4, 0xEA60, "CP210x (copies of the Uno)"),
    ),
    flashing=Flashing(
        called="an Uno",
        image="uno.hex",
        chip="ATmega328P",
        signature=bytes.fromhex("1e950f"),
        ram=2048,
        page=128,
        bootloaders=(Bootloader("optiboot", 115200, 0x7E00), Bootloader("ATmegaBOOT (older Nano)", 57600, 0x7800)),
    ),
    pins=UNO_PINS,
)
PICO = Board(
    name="pico",
    hz=125e6,
    word_bits=8,
    arena=16_384,
    channels=10,
    link=500e3,  # half of what a full-speed bulk endpoint can carry; untried on silicon
    # github.com/raspberrypi/usb-pid: product numbers of Raspberry Pi's vendor number for firmware on an RP2040
    usb=(Usb(0x2E8A, 0x000A, "Raspberry Pi Pico"),),
    flashing=Drive(
        called="a Raspberry Pi Pico",
        image="pico.uf2",
        chip="RP2040",
        processor="cortex_m0plus",
        name="RPI-RP2",
        family=0xE48BFF56,
        ram=256 * 1024,
        flash=2048 * 1024 - 8 * 1024,  # the last two sectors hold the settings
    ),
    pins=PICO_PINS,
)
CORTEX_M4 = Board(name="cortex-m4f", hz=168e6, word_bits=8, arena=16_384, channels=10)
HOST = Board(name="host", hz=None, word_bits=16, arena=32_768, channels=10, T_max=30e-3)

BOARDS = {board.name: board for board in (UNO, PICO, CORTEX_M4, HOST)}
