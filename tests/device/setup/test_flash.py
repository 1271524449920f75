"""Flashing against a bootloader written here, which can be made to answer wrongly; test_bootloader.py has real ones."""

import contextlib
import os
import random
import threading

import pytest
from bootloader import hex_file, offer

from hapticlab.device.setup import flash as module
from hapticlab.device.setup.flash import STAND_STILL, flash
from hapticlab.errors import PaddleError, PortError

IMAGE = random.Random(5).randbytes(1000)


class Peer:
    """The commands of AVR061 that are used, in memory. ``change(command, answer)`` is what a test spoils."""

    def __init__(self):
        self.flash, self.address, self.written, self.commands = {}, 0, [], []

    def answers(self, command):
        kind, data = command[:1], b""
        self.commands.append(kind)
        if kind == b"U":
            self.address = 2 * int.from_bytes(command[1:3], "little")
        elif kind == b"d":
            assert command[1:4] == b"\x00\x80F" and len(command) == 4 + 128 + 1
            self.written.append((self.address, command[4:-1]))
            self.flash[self.address] = command[4:-1]
        elif kind == b"t":
            assert command[1:4] == b"\x00\x80F"
            data = self.flash[self.address]
        elif kind == b"u":
            data = b"\x1e\x95\x0f"
        assert command[-1:] == b" "
        return self.change(kind, b"\x14" + data + b"\x10")

    def change(self, kind, answer):
        return answer

    def content(self):
        return b"".join(self.flash[at] for at in sorted(self.flash))


class Line:
    """A pyserial port to a peer."""

    peer, rate = None, 115200
    lines, rates = (), ()

    def __init__(self, port=None, *, baudrate, timeout, write_timeout, exclusive):
        self.port, self.write_timeout, self.is_open = port, write_timeout, False
        self._coming, self._rate = b"", baudrate

    def open(self):
        self.is_open = True

    def close(self):
        self.is_open = False

    @property
    def baudrate(self):
        return self._rate

    @baudrate.setter
    def baudrate(self, rate):
        self._rate = rate
        type(self).rates += (rate,)

    @property
    def dtr(self):
        return self.lines[-1]

    @dtr.setter
    def dtr(self, level):
        type(self).lines += (level,)

    def write(self, data):
        if self._rate == self.rate:
            self._coming += self.peer.answers(bytes(data))

    def read(self, size):
        came, self._coming = self._coming[:size], self._coming[size:]
        return came


@pytest.fixture
def image(tmp_path):
    return hex_file(tmp_path / "image.hex", IMAGE)


@pytest.fixture
def talk(monkeypatch):
    """Put a peer at the other end of ``test://``; give the class of the port."""

    def talk(peer, **settings):
        line = type("ThisLine", (Line,), {"peer": peer, **settings})
        offer(monkeypatch, line)
        return line

    return talk


def test_all_pages_are_written_and_the_first_comes_last(talk, image):
    peer, told = Peer(), []
    line = talk(peer)
    done = flash("test://", image, tell=lambda sentence: told.append((sentence, len(peer.written))))
    assert told == [("Writing image.hex to test://. The motor stays off. Do not unplug the cable.", 0)]
    assert peer.content() == IMAGE.ljust(1024, b"\xff")
    assert [at for at, _ in peer.written] == [0, *range(128, 1024, 128), 0]
    assert peer.written[0] == (0, STAND_STILL * 64) and peer.written[-1] == (0, IMAGE[:128])
    assert peer.commands.count(b"t") == 8 and peer.commands[-1] == b"Q"
    assert line.lines == (False, True)  # the pulse that resets
    assert str(done) == (
        "image.hex: 1000 bytes written to test:// by optiboot at 115200 baud, read back and equal; the board starts it"
    )


def test_stand_still_is_a_jump_to_itself():
    """AVR instruction set manual: RJMP k is 1100 kkkk kkkk kkkk and goes to PC + k + 1."""
    word = int.from_bytes(STAND_STILL, "little")
    assert (word >> 12, (word & 0xFFF) - 0x1000 + 1) == (0b1100, 0)


def test_no_bootloader(talk, image):
    line = talk(Peer(), rate=None)
    with pytest.raises(PortError, match="test://: no bootloader answers.*reset button") as caught:
        flash("test://", image, tell=pytest.fail)
    assert caught.value.cause == "silent"
    assert line.rates == (115200, 57600) and line.lines == (False, True) * 6


@pytest.mark.parametrize("board", ["host", "cortex-m4f", "due"])
def test_a_board_without_firmware_is_refused_before_its_port_opens(board, image):
    with pytest.raises(PaddleError, match=f"board = '{board}' cannot be flashed from here; needs one of uno"):
        flash("/dev/no-such-port", image, board)


def test_an_older_bootloader_is_found_at_its_rate(talk, image):
    peer = Peer()
    talk(peer, rate=57600)
    assert flash("test://", image).bootloader.baudrate == 57600
    assert peer.content()[:1000] == IMAGE


@pytest.mark.parametrize(("rate", "start"), [(115200, 0x7E00), (57600, 0x7800)])
def test_the_bootloader_is_never_overwritten(talk, tmp_path, rate, start):
    peer = Peer()
    talk(peer, rate=rate)
    flash("test://", hex_file(tmp_path / "fits.hex", random.Random(1).randbytes(start)))
    assert max(peer.flash) == start - 128
    peer.written.clear()
    with pytest.raises(PaddleError, match=f"large.hex ends at {start:#06x}; .* below {start:#06x}.*too large"):
        flash("test://", hex_file(tmp_path / "large.hex", bytes(start + 1)))
    assert not peer.written


def test_another_chip(talk, image):
    for signature, name in (("1e9801", "ATmega2560"), ("aabbcc", "an unknown chip")):
        peer = Peer()
        peer.change = lambda kind, answer, s=signature: b"\x14" + bytes.fromhex(s) + b"\x10" if kind == b"u" else answer
        talk(peer)
        with pytest.raises(PaddleError, match=f"{name} .signature {signature}.; needs ATmega328P .*nothing was written"):
            flash("test://", image)
        assert not peer.written


@pytest.mark.parametrize("kind", [b"u", b"P", b"U", b"d", b"t"])
@pytest.mark.parametrize(
    ("spoil", "got"),
    [
        (lambda a: b"", "nothing"),
        (lambda a: a[:-1], ""),
        (lambda a: b"\x15" + a[1:], "15 "),  # not in sync
        (lambda a: a[:-1] + b"\x11", "14 "),  # failed
    ],
)
@pytest.mark.always("*-U*", "*-nothing-t")
def test_an_answer_that_is_none(talk, image, kind, spoil, got):
    peer = Peer()
    peer.change = lambda asked, answer: spoil(answer) if asked == kind else answer
    talk(peer)
    with pytest.raises(PortError, match=f"an invalid answer: to {kind!r} it sent {got}.*Flash it again") as caught:
        flash("test://", image)
    assert caught.value.cause == "silent"
    assert ("is erased" in str(caught.value)) == (kind in b"Udt")  # from the first page on


def test_late_answers_to_earlier_tries(talk, image):
    peer = Peer()
    peer.change = lambda kind, answer: answer * 3 if kind == b"0" else answer
    talk(peer)
    flash("test://", image)
    assert peer.content()[:1000] == IMAGE


def test_a_lost_goodbye_is_no_failure(talk, image):
    peer = Peer()
    peer.change = lambda kind, answer: b"" if kind == b"Q" else answer
    talk(peer)
    flash("test://", image)
    assert peer.content()[:1000] == IMAGE


@pytest.mark.parametrize("at", [0, 127, 128, 999])
@pytest.mark.always("127", "128")
def test_a_wrong_byte_puts_the_board_to_rest(talk, image, at):
    peer = Peer()

    def spoiled(kind, answer):
        if kind == b"t" and peer.address == at // 128 * 128:
            answer = bytearray(answer)
            answer[1 + at % 128] ^= 0xFF
        return bytes(answer)

    peer.change = spoiled
    talk(peer)
    words = f"failed at 0x{at:04x}: it reads 0x{IMAGE[at] ^ 0xFF:02x}, needs 0x{IMAGE[at]:02x}"
    with pytest.raises(PaddleError, match=words):
        flash("test://", image)
    assert peer.written[-1] == (0, STAND_STILL * 64)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b":00000001FF\n", "bad.hex holds no data"),
        (b"\x7fELF\xff\x00", r"bad.hex is not an Intel HEX file \(is it an .elf or"),
        (b":02000000FFFF00\n:00000001FF\n", "no data at address 0,"),
        (b":010100004" + b"2BC\n:00000001FF\n", "no data at address 0,"),
        (None, "does not open .No such file"),
    ],
)
def test_an_image_that_is_none_never_reaches_the_board(talk, tmp_path, content, words):
    line = talk(Peer())
    path = tmp_path / "bad.hex"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(PaddleError, match=words):
        flash("test://", path, tell=pytest.fail)
    assert line.lines == ()


def test_a_package_without_an_image(monkeypatch, tmp_path):
    monkeypatch.setattr(module, "firmware_folder", lambda: tmp_path)
    with pytest.raises(PaddleError, match="contain uno.hex; give an image,"):
        flash("test://")


def test_the_bar_counts_what_is_written_and_compared(talk, image, monkeypatch):
    seen = []

    @contextlib.contextmanager
    def bar(ticks, shown, unit):
        seen.append((ticks, shown, unit))
        yield type("Bar", (), {"update": staticmethod(seen.append)})

    monkeypatch.setattr(module, "progress_bar", bar)
    talk(Peer())
    flash("test://", image, progress=False)
    assert seen[0] == (2048, False, "B") and sum(seen[1:]) == 2048


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="this system has no pseudo-terminals")
def test_over_a_real_port(image):
    """A pseudo-terminal has no reset line: the person at the button is a thread."""
    ours, theirs = os.openpty()
    peer, lengths = Peer(), {b"0": 2, b"P": 2, b"Q": 2, b"u": 2, b"U": 4, b"t": 5, b"d": 133}

    def serve():
        waiting = b""
        while True:
            try:
                waiting += os.read(ours, 4096)
            except OSError:
                return
            while waiting and len(waiting) >= lengths[waiting[:1]]:
                length = lengths[waiting[:1]]
                os.write(ours, peer.answers(waiting[:length]))
                waiting = waiting[length:]

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    name = os.ttyname(theirs)
    assert flash(name, image).port == name
    os.close(theirs)
    thread.join(timeout=10)
    os.close(ours)
    assert not thread.is_alive()
    assert peer.content()[:1000] == IMAGE and peer.commands[-1] == b"Q"
