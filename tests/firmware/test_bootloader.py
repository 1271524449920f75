"""Flashing against Arduino's real bootloaders: optiboot writes the emulated chip's flash itself, over its UART."""

import random
import re
import struct

import pytest
import serial
from bootloader import Board, BoardPort, bootloader_folder, build_shim, hex_file, offer

from hapticlab.compiler.engines.firmware_library import firmware_folder
from hapticlab.device.link.serial_ports import KNOWN
from hapticlab.device.setup.flash import STAND_STILL, flash
from hapticlab.errors import PaddleError, PortError

PAGE = 128
DDRD = 0x2A
UCSR0A, UCSR0B, UBRR0L, UDR0 = 0xC0, 0xC1, 0xC4, 0xC6


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("bootloader")


@pytest.fixture(scope="module")
def library(folder):
    return build_shim(folder)


@pytest.fixture
def connect(library, folder, monkeypatch):
    """Make a board with a bootloader, reached through ``test://``."""
    boards = []

    def connect(kind="optiboot", port_class=BoardPort):
        board = Board(library, folder, kind)
        boards.append(board)
        offer(monkeypatch, type("ThisPort", (port_class,), {"board": board}))
        return board

    yield connect
    for board in boards:
        board.ask("free")


def talker(letter, size):
    """Return a program that says a letter for ever at 117647 baud, the motor's pins driven; the rest of it is noise.

    Assembled by hand (AVR instruction set manual): its code lies in the last page, so that every page matters.
    """

    def ldi(value):
        return 0xE000 | (value & 0xF0) << 4 | value & 0xF  # into r16

    store, skip_if_ready, load = 0x9300, 0xFF15, 0x9110  # sts k, r16; sbrs r17, UDRE0; lds r17, k
    begin = size // 2 - 24
    code = [
        *(ldi(0xFF), store, DDRD),
        *(ldi(2), store, UCSR0A, ldi(16), store, UBRR0L, ldi(8), store, UCSR0B),
        *(ldi(ord(letter)), load, UCSR0A, skip_if_ready, 0xCFFC, store, UDR0, 0xCFF9),  # rjmp .-8, rjmp .-14
    ]
    words = list(struct.unpack(f"<{size // 2}H", random.Random(letter).randbytes(size)))
    words[:2] = 0x940C, begin  # jmp
    words[begin : begin + len(code)] = code
    return struct.pack(f"<{size // 2}H", *words)


def heard(board, seconds=0.1):
    board.says()
    board.run(seconds)
    return set(board.says())


def stands_still(board):
    """Nothing is said and no pin is an output, seconds after the watchdog has let the bootloader's program begin."""
    board.run(3)
    board.says()
    board.run(1)
    return board.ask("pc") == 0 and not board.says() and board.data[DDRD] == 0


@pytest.mark.parametrize(("kind", "size"), [("optiboot", 2000), ("optiboot", 2048), ("ATmegaBOOT", 2000)])
@pytest.mark.always("optiboot-2048")
def test_the_image_is_in_flash_and_runs(connect, tmp_path, kind, size):
    """Sizes with and without a last page that is part full; the board talked at another rate before."""
    board, start = connect(kind), 0.1 if kind == "optiboot" else 2  # s; ATmegaBOOT waits for more to come
    bootloader = bytes(board.flash[board.start :])
    board.flash[:1100] = talker("o", 1100)
    board.run(3)  # the bootloader gives up waiting
    assert heard(board) == {ord("o")}
    image = talker("n", size)
    done = flash("test://", hex_file(tmp_path / "new.hex", image))
    assert bytes(board.flash[:size]) == image
    assert bytes(board.flash[board.start :]) == bootloader
    board.run(start)
    assert heard(board) == {ord("n")} and board.data[DDRD] == 0xFF
    rate = 115200 if kind == "optiboot" else 57600
    assert str(done).startswith(f"new.hex: {size} bytes written to test:// by {kind}") and f"at {rate} baud" in str(done)


@pytest.mark.wide
def test_the_largest_image_ends_below_the_bootloader(connect, tmp_path):
    board = connect()
    bootloader, image = bytes(board.flash[0x7E00:]), random.Random(7).randbytes(0x7E00)
    flash("test://", hex_file(tmp_path / "large.hex", image))
    assert bytes(board.flash) == image + bootloader


def test_the_image_of_the_package(connect):
    image = firmware_folder() / "prebuilt" / "uno.hex"
    board = connect()
    done = flash("test://")
    records = [line for line in image.read_text().split() if line[7:9] == "00"]
    assert done.size > 4000 and len(records) > 200
    for line in records:
        at, data = int(line[3:7], 16), bytes.fromhex(line[9:-2])
        assert bytes(board.flash[at : at + len(data)]) == data


def test_another_chip_is_refused(connect, tmp_path):
    board = connect("optiboot on an ATmega168")
    before = bytes(board.flash)
    with pytest.raises(PaddleError, match=r"is ATmega168 \(signature 1e9406\); needs ATmega328P \(1e950f\); nothing was written"):
        flash("test://", hex_file(tmp_path / "new.hex", talker("n", 1000)))
    assert bytes(board.flash) == before


@pytest.mark.parametrize("at", [0x0000, 0x0001, 0x0080, 0x0123, 999])
@pytest.mark.always("0")
def test_a_byte_that_is_not_as_written(connect, tmp_path, at):
    """One bit of flash flips as the host begins to read its page back."""

    class Flipping(BoardPort):
        address, flips = None, 1

        def write(self, data):
            if data[:1] == b"U":
                self.address = 2 * int.from_bytes(data[1:3], "little")
            if data[:1] == b"t" and self.address == at // PAGE * PAGE and self.flips:
                self.board.flash[at] ^= 0x10
                self.flips = 0
            return super().write(data)

    board = connect(port_class=Flipping)
    image = talker("n", 1000)
    words = f"failed at 0x{at:04x}: it reads 0x{image[at] ^ 0x10:02x}, needs 0x{image[at]:02x}. "
    words += "The board is stopped with its motor off. Flash it again"
    with pytest.raises(PaddleError, match=words):
        flash("test://", hex_file(tmp_path / "new.hex", image))
    assert stands_still(board)


@pytest.mark.parametrize(("page", "bytes_of_it"), [(2, 0), (2, 70), (5, 1), (8, 132), (9, 0)])
@pytest.mark.always("5-1")
def test_a_cut_leaves_a_board_that_stands_still(connect, tmp_path, page, bytes_of_it):
    """The cable is pulled while a page is on its way, with an old program on the board that drives the motor's pins."""

    cut_at = [None]  # the how manieth page

    class Cut(BoardPort):
        pages = 0

        def write(self, data):
            self.pages += data[:1] == b"d"
            if data[:1] == b"d" and self.pages == cut_at[0]:
                super().write(data[:bytes_of_it])
                raise serial.SerialException("write failed: [Errno 5] Input/output error")
            return super().write(data)

    board = connect(port_class=Cut)
    old, new = (hex_file(tmp_path / f"{letter}.hex", talker(letter, 1024)) for letter in "on")
    flash("test://", old)
    assert heard(board) == {ord("o")}
    cut_at[0] = page
    state = "is stopped with its motor off" if page < 9 else "switch off the supply of its motor"  # the ninth is the first page
    with pytest.raises(PortError, match=f"disconnected during use.*old firmware is erased.*{state}. Flash it again") as caught:
        flash("test://", new)
    assert caught.value.cause == "left"
    assert stands_still(board) and bytes(board.flash[:PAGE]) == STAND_STILL * 64
    cut_at[0] = None
    flash("test://", new)
    assert heard(board) == {ord("n")}


def test_every_uno_that_arduino_knows_is_known():
    text = (bootloader_folder().parent / "boards.txt").read_text()
    pairs = re.findall(r"^uno\.vid\.\d+=(\w+)\nuno\.pid\.\d+=(\w+)$", text, re.M)
    unos = {(int(vendor, 16), int(product, 16)) for vendor, product in pairs}
    assert len(unos) >= 5 and unos <= set(KNOWN)


def test_lost_requests_are_asked_again(connect, tmp_path):
    """The first five tries never reach the board, nor a byte of the sixth; two resets go by."""

    class Deaf(BoardPort):
        losses = 5

        def write(self, data):
            if data[:1] == b"0" and self.losses:
                self.losses -= 1
                return len(data) if self.losses else super().write(data[:1])
            return super().write(data)

    board = connect(port_class=Deaf)
    flash("test://", hex_file(tmp_path / "new.hex", talker("n", 1000)))
    assert heard(board) == {ord("n")}


@pytest.mark.wide
def test_a_board_that_only_runs_its_program(connect, tmp_path):
    """No reset line: the old program talks on, and no bootloader answers."""

    class NoReset(BoardPort):
        dtr = None

    board = connect(port_class=NoReset)
    image = talker("o", 1000)
    board.flash[: len(image)] = image
    board.run(2)
    assert heard(board) == {ord("o")}
    with pytest.raises(PortError, match="no bootloader answers.*reset button") as caught:
        flash("test://", hex_file(tmp_path / "new.hex", talker("n", 1000)))
    assert caught.value.cause == "silent" and bytes(board.flash[: len(image)]) == image
