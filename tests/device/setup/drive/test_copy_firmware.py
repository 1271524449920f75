"""Copying firmware to a drive: a folder that vanishes as a board's does, with time that passes in looks alone."""

import os
import struct

import pytest

from hapticlab.cli.main import main
from hapticlab.device.link.serial_ports import Port
from hapticlab.device.setup.drive import copy_firmware as module
from hapticlab.device.setup.drive.copy_firmware import COPIED, INFO, copy_firmware
from hapticlab.device.setup.drive.uf2_blocks import HEAD, as_uf2, parse_uf2
from hapticlab.errors import PaddleError, PortError

HOW = COPIED["pico"]
PAGES = [(0x10000000 + 256 * k, bytes([k]) * 256) for k in range(40)]
IMAGE = as_uf2(PAGES, HOW.family)
BOARD_PORT = Port("/dev/ttyACM7", vid=0x2E8A, pid=0x000A)


class Bench:
    """Drives, ports and a clock. The board takes the file at the first look at which it is whole, unless ``deaf``."""

    def __init__(self, folder, monkeypatch):
        self.folder, self.now, self.ports, self.drives = folder, 0.0, [], []
        self.deaf, self.silent, self.at_the_button, self.told = False, False, None, []
        monkeypatch.setattr(module, "mounted", lambda: [d for d in self.drives if d.exists()])
        monkeypatch.setattr(module, "available_ports", lambda: list(self.ports))
        monkeypatch.setattr(module.time, "monotonic", lambda: self.now)
        monkeypatch.setattr(module.time, "sleep", self.sleep)

    def plug_in(self, name="RPI-RP2", board_id="RPI-RP2"):
        drive = self.folder / name
        drive.mkdir()
        (drive / INFO).write_text(f"UF2 Bootloader v3.0\nModel: Raspberry Pi RP2\nBoard-ID: {board_id}\n")
        self.drives.append(drive)
        return drive

    def leave(self, drive):
        self.taken = {file.name: file.read_bytes() for file in drive.iterdir()}
        drive.rename(self.folder / "gone")
        if not self.silent:
            self.ports.append(BOARD_PORT)

    def sleep(self, seconds):
        self.now += seconds
        if self.at_the_button and self.now > 5:
            self.at_the_button, act = None, self.at_the_button
            act()
        for drive in self.drives:
            if drive.exists() and not self.deaf and len(list(drive.iterdir())) > 1:
                self.leave(drive)


@pytest.fixture
def bench(tmp_path, monkeypatch):
    return Bench(tmp_path, monkeypatch)


@pytest.fixture
def image(tmp_path):
    path = tmp_path / "new.uf2"
    path.write_bytes(IMAGE)
    return path


def test_blocks_are_as_the_format_says():
    assert len(IMAGE) == 512 * len(PAGES)
    for k, (address, data) in enumerate(PAGES):
        block = IMAGE[512 * k : 512 * (k + 1)]
        assert block[:4] == b"UF2\n" and block[508:] == bytes.fromhex("306fb10a")
        assert struct.unpack("<7I", block[4:32]) == (0x9E5D5157, 0x2000, address, 256, k, len(PAGES), 0xE48BFF56)
        assert block[32:288] == data and not any(block[288:508])
    assert parse_uf2(IMAGE, family=HOW.family) == PAGES


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda b: b[:700], "has 700 bytes; needs a multiple of 512. It is cut"),
        (lambda b: b[:512] + b[1024:], "block 0 of 40 is at place 0 of 39; needs every block once"),
        (lambda b: b[:508] + b"1234" + b[512:], "block 0 is damaged"),
        (lambda b: b":100000000C94", "is not a UF2 file"),
        (lambda b: as_uf2(PAGES, 0xE48BFF59), "is for family 0xe48bff59; needs 0xe48bff56. Choose the image of this board"),
        (lambda b: HEAD.pack(*HEAD.unpack(b[:32])[:2], 0, *HEAD.unpack(b[:32])[3:]) + b[32:], "a chip that it does not name"),
    ],
)
def test_a_damaged_image_never_reaches_a_drive(bench, image, spoil, words):
    drive = bench.plug_in()
    image.write_bytes(spoil(IMAGE))
    with pytest.raises(PaddleError, match=words):
        copy_firmware(image)
    assert [file.name for file in drive.iterdir()] == [INFO]


def test_the_image_arrives_whole_and_the_new_port_is_named(bench, image):
    bench.plug_in()
    bench.ports.append(Port("/dev/ttyACM1", vid=0x2E8A, pid=0x000A))  # another Pico, which runs already
    copied = copy_firmware(image, tell=bench.told.append)
    assert bench.taken["new.uf2"] == IMAGE and copied.port == "/dev/ttyACM7" and copied.size == len(IMAGE)
    assert len(bench.told) == 1 and "Do not unplug the cable" in bench.told[0]
    assert str(copied) == "new.uf2: 20480 bytes copied; the board started the firmware and is at /dev/ttyACM7"


def test_a_person_is_told_how_to_get_the_drive(bench, image):
    bench.at_the_button = bench.plug_in
    copy_firmware(image, tell=bench.told.append)
    assert "Switch off the supply of the motor" in bench.told[0] and "hold down its BOOTSEL button" in bench.told[0]


def test_a_board_that_runs_this_firmware_is_asked_for_its_drive(bench, image, monkeypatch):
    bench.ports.append(BOARD_PORT)
    asked = []

    class Opened:
        def close(self):
            bench.ports.clear()
            bench.plug_in()

    monkeypatch.setattr(module, "open_port", lambda url, baudrate: asked.append((url, baudrate)) or Opened())
    assert copy_firmware(image, tell=bench.told.append).port == "/dev/ttyACM7"
    assert asked == [("/dev/ttyACM7", 1200)] and "Asking a Raspberry Pi Pico at /dev/ttyACM7" in bench.told[0]


def test_of_several_boards_the_named_one_is_asked(bench, image, monkeypatch):
    bench.ports += [Port("/dev/ttyACM5", vid=0x2E8A, pid=0x000A), BOARD_PORT]
    asked = []

    class Opened:
        def close(self):
            bench.ports.remove(BOARD_PORT)
            bench.plug_in()

    monkeypatch.setattr(module, "open_port", lambda url, baudrate: asked.append(url) or Opened())
    assert copy_firmware(image, port="/dev/ttyACM7", tell=bench.told.append).port == "/dev/ttyACM7"
    assert asked == ["/dev/ttyACM7"]


def test_a_port_that_is_taken_leaves_it_to_the_person(bench, image, monkeypatch):
    bench.ports.append(BOARD_PORT)
    bench.at_the_button = lambda: (bench.ports.clear(), bench.plug_in())

    def taken(url, baudrate):
        raise PortError("another program has it", "taken")

    monkeypatch.setattr(module, "open_port", taken)
    copy_firmware(image, tell=bench.told.append)
    assert "BOOTSEL" in bench.told[1]


def test_nobody_at_the_button(bench, image):
    with pytest.raises(PortError, match="no drive RPI-RP2 appeared within 60 s. Use a USB cable that carries data. Unplug") as e:
        copy_firmware(image)
    assert e.value.cause == "missing" and 60 <= bench.now < 61


def test_the_drive_of_another_chip_is_left_alone(bench, image):
    drive = bench.plug_in("RP2350", "RP2350")
    words = "calls itself RP2350; a Raspberry Pi Pico calls itself RPI-RP2. Nothing was copied"
    with pytest.raises(PaddleError, match=words):
        copy_firmware(image)
    assert [file.name for file in drive.iterdir()] == [INFO]


def test_two_drives(bench, image):
    bench.plug_in(), bench.plug_in("RPI-RP21")
    with pytest.raises(PortError, match="more than one board waits for firmware. Leave only one of them") as e:
        copy_firmware(image)
    assert e.value.cause == "several"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full, a file that is always full")
def test_a_full_drive(bench, image):
    drive = bench.plug_in()
    (drive / "new.uf2").symlink_to("/dev/full")
    bench.deaf = True
    with pytest.raises(PaddleError, match=r"RPI-RP2 took no file \(No space left on device\). Unplug the board, hold"):
        copy_firmware(image)


def test_a_drive_that_takes_no_file(bench, image):
    drive = bench.plug_in()
    (drive / "new.uf2").mkdir()  # as root a folder without rights could be written
    bench.deaf = True
    with pytest.raises(PaddleError, match="took no file"):
        copy_firmware(image)


def test_a_drive_that_vanishes_before_the_last_byte_is_no_failure(bench, image, monkeypatch):
    """The board starts at the last block; the computer still wants to write a directory, and is told that there is no drive."""
    drive = bench.plug_in()

    def sync(_):
        bench.leave(drive)
        raise OSError(19, "No such device")

    monkeypatch.setattr(module.os, "fsync", sync)
    assert copy_firmware(image).port == "/dev/ttyACM7" and bench.taken["new.uf2"] == IMAGE


def test_a_board_that_does_not_take_the_image(bench, image):
    bench.plug_in()
    bench.deaf = True
    with pytest.raises(PortError, match="was copied, but .* is still there: the board did not accept the image. Unplug"):
        copy_firmware(image)


def test_a_board_that_vanishes_and_does_not_come_back(bench, image):
    bench.plug_in()
    bench.silent = True
    with pytest.raises(PortError, match="no new port of a Raspberry Pi Pico appeared within 15 s. Unplug the board and plug"):
        copy_firmware(image)


def test_the_command_copies(bench, image, capsys):
    bench.plug_in()
    assert main(["flash", "--board", "pico", "--image", str(image)]) == 0
    said = capsys.readouterr()
    assert "is at /dev/ttyACM7" in said.out and "Copying new.uf2 to" in said.err
