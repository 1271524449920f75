"""Write firmware into a board over its bootloader: STK500 version 1, Atmel's AVR061, as Arduino's optiboot speaks it."""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ...compiler.boards.board_records import BOARDS, Bootloader, Flashing
from ...compiler.engines.firmware_library import firmware_folder
from ...errors import PaddleError, PortError
from ..link.serial_ports import open_port, port_watched
from ..progress import progress_bar
from .intel_hex import parse_hex

#: other chips that answer in the same way, to name what was met
CHIPS = {
    bytes.fromhex("1e9514"): "ATmega328",
    bytes.fromhex("1e9516"): "ATmega328PB",
    bytes.fromhex("1e9406"): "ATmega168",
    bytes.fromhex("1e940b"): "ATmega168P",
    bytes.fromhex("1e9307"): "ATmega8",
    bytes.fromhex("1e9587"): "ATmega32U4",
    bytes.fromhex("1e9801"): "ATmega2560",
}
#: board -> how firmware comes onto it
FLASHED = {name: board.flashing for name, board in BOARDS.items() if isinstance(board.flashing, Flashing)}
SYNC, ENTER, LEAVE, ADDRESS, WRITE, READ, SIGN = b"0", b"P", b"Q", b"U", b"d", b"t", b"u"
END_OF_COMMAND, IN_SYNC, OK = b" ", b"\x14", b"\x10"
#: s. The first is longer than optiboot blinks (0.4 s) before it listens: more than two bytes sent meanwhile are lost,
#: and the rest then reads as nonsense, at which optiboot leaves.
SYNC_WAITS, RESETS = (0.6, 0.2, 0.2), 3
REPLY_WAIT = 1.0  # s; the bootloader's own watchdog
#: rjmp to itself. It fills the first page until all others are verified, so that after a cut the board does nothing,
#: with its motor pins off, and never runs half a program.
STAND_STILL = b"\xff\xcf"


@dataclass(frozen=True)
class Flashed:
    """What was written, where, and by which bootloader."""

    port: str
    image: str
    size: int
    bootloader: Bootloader

    def __str__(self):
        by = f"{self.bootloader.name} at {self.bootloader.baudrate} baud"
        return f"{self.image}: {self.size} bytes written to {self.port} by {by}, read back and equal; the board starts it"


class VerificationError(PaddleError):
    """A byte reads back as another than was written."""


def flash(port, image=None, board="uno", *, progress=True, tell=lambda sentence: None):
    """Write a firmware image into a board and compare every byte; the board then starts it.

    Parameters
    ----------
    port : str
        The port of the board.
    image : path of an Intel HEX file, optional
        The one that comes with the package if None.
    board : str
        One of :data:`FLASHED`.
    progress : bool
        Show a bar if it lasts longer than two seconds.
    tell : callable
        Called with a sentence when board and image are known to fit, just before anything is written.

    Returns
    -------
    Flashed

    Raises
    ------
    PortError
        If the port does not open, no bootloader answers (``cause`` "silent") or the board left meanwhile.
    PaddleError
        If there is no firmware for the board, the image is damaged or too large, the chip is another, or a byte reads back
        wrong.
    """
    if board not in FLASHED:
        raise PaddleError(f"board = {board!r} cannot be flashed from here; needs one of {', '.join(FLASHED)}")
    how = FLASHED[board]
    path = Path(image) if image is not None else prebuilt_image(how)
    content = read_image(path)
    opened = open_port(port, baudrate=how.bootloaders[0].baudrate)
    try:
        bootloader = find_bootloader(opened, how)
        check_fits(content, bootloader, path.name)
        check_chip(opened, how)
        tell(f"Writing {path.name} to {port}. The motor stays off. Do not unplug the cable.")
        _write_and_verify(opened, content, how.page, progress)
    finally:
        opened.close()
    return Flashed(port, path.name, len(content), bootloader)


def prebuilt_image(how):
    """Return the path of the image that comes with the package."""
    path = firmware_folder() / "prebuilt" / how.image
    if not path.is_file():
        raise PaddleError(f"this installation does not contain {how.image}; give an image, or install a release")
    return path


def read_image(path):
    """Return the bytes of an image, and see that it is one a board could start."""
    try:
        text = path.read_text("ascii")
    except UnicodeDecodeError:
        raise PaddleError(f"{path.name} is not an Intel HEX file (is it an .elf or .bin?); give the .hex file") from None
    except OSError as problem:
        raise PaddleError(f"{path} does not open ({problem.strerror}); give the path of a .hex file") from None
    content = parse_hex(text, path.name)
    if content[:2] == b"\xff\xff":
        raise PaddleError(f"{path.name} has no data at address 0, where a board starts. Is it the file of a bootloader?")
    return content


def check_fits(content, bootloader, name):
    """Refuse an image that would overwrite the bootloader."""
    if len(content) > bootloader.start:
        raise PaddleError(
            f"{name} ends at 0x{len(content) - 1:04x}; a program must end below 0x{bootloader.start:04x}, where "
            f"{bootloader.name} begins. The program is too large for this board"
        )


def find_bootloader(port, how):
    """Reset the board and return the bootloader that answers."""
    for bootloader in how.bootloaders:
        with port_watched(port):
            port.baudrate = bootloader.baudrate
        for _ in range(RESETS):
            _reset(port)
            for wait in SYNC_WAITS:
                _send(port, SYNC)
                if _receive(port, 2, wait)[-2:] == IN_SYNC + OK:
                    _receive(port, 256, 0.05)  # late answers to earlier tries
                    return bootloader
    raise PortError(
        f"{port.port}: no bootloader answers. Is this the right port? Is the board {how.called}? Are pins 0 and 1 free? "
        "Press the board's reset button at the moment when you start again",
        "silent",
    )


def check_chip(port, how):
    """Refuse a board with another chip than the image was built for."""
    signature = _ask(port, SIGN, 3)
    if signature != how.signature:
        name = CHIPS.get(signature, "an unknown chip")
        raise PaddleError(
            f"{port.port} is {name} (signature {signature.hex()}); needs {how.chip} ({how.signature.hex()}); "
            f"nothing was written. Choose the port of {how.called}"
        )


def _write_and_verify(port, content, size, progress):
    """Write the pages but the first, compare them, and only then let the board have a beginning."""
    first, *rest = [(at, content[at : at + size].ljust(size, b"\xff")) for at in range(0, len(content), size)]
    stand_still = STAND_STILL * (size // len(STAND_STILL))
    _ask(port, ENTER)
    at = 0
    try:
        _write(port, 0, stand_still)
        with progress_bar(2 * size * (1 + len(rest)), progress, unit="B") as bar:
            for pages in (rest, [first]):
                for at, page in pages:
                    _write(port, at, page)
                    bar.update(size)
                for at, page in pages:
                    _verify(port, at, page)
                    bar.update(size)
    except VerificationError:
        _write(port, 0, stand_still)
        raise
    except PortError as problem:
        # the 20 ms in which the first page is erased and not yet written are the only ones without it
        state = "is stopped with its motor off" if at else "cannot start: switch off the supply of its motor"
        raise PortError(
            f"{problem}. The old firmware is erased and the new one is incomplete; the board {state}. Flash it again",
            problem.cause,
        ) from problem
    with suppress(PortError):  # all is compared; unasked, the bootloader starts it a second later
        _ask(port, LEAVE)


def _write(port, at, page):
    _ask(port, ADDRESS + (at // 2).to_bytes(2, "little"))
    _ask(port, WRITE + len(page).to_bytes(2, "big") + b"F" + page)


def _verify(port, at, page):
    _ask(port, ADDRESS + (at // 2).to_bytes(2, "little"))
    found = _ask(port, READ + len(page).to_bytes(2, "big") + b"F", len(page))
    wrong = next((i for i in range(len(page)) if found[i] != page[i]), None)
    if wrong is not None:
        raise VerificationError(
            f"{port.port}: verification failed at 0x{at + wrong:04x}: it reads 0x{found[wrong]:02x}, needs "
            f"0x{page[wrong]:02x}. The board is stopped with its motor off. Flash it again; if it fails at the same "
            "address, the chip's flash is worn out"
        )


def _ask(port, command, length=0):
    """Send a command and return its answer's bytes."""
    _send(port, command)
    answer = _receive(port, length + 2, REPLY_WAIT)
    if len(answer) < length + 2 or answer[:1] != IN_SYNC or answer[-1:] != OK:
        got = answer.hex(" ") or "nothing"
        raise PortError(
            f"{port.port}: the bootloader gave an invalid answer: to {command[:1]!r} it sent {got[:60]}; needs 14, {length} "
            "bytes, 10. Flash it again",
            "silent",
        )
    return answer[1:-1]


def _reset(port):
    """Pulse the lines that reset an Uno as they fall, and throw away what the old program still says."""
    for level, wait in ((False, 0.25), (True, 0.05)):  # s; the capacitor in the line has to discharge
        with suppress(OSError):  # a link without these lines: then it is the button
            port.dtr = port.rts = level
        _receive(port, 4096, wait)


def _send(port, command):
    with port_watched(port):
        port.write(command + END_OF_COMMAND)


def _receive(port, length, wait):
    with port_watched(port):
        port.timeout = wait
        return port.read(length)
