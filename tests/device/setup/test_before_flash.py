"""What a board is told of its wiring is compared with what is built before firmware is written, and taken back if it differs."""

import pytest
import workbench as bench

import hapticlab as hl
from hapticlab.device.board.settings import changed, nominal
from hapticlab.device.setup import before_flash as module
from hapticlab.device.setup.before_flash import before_flash
from hapticlab.errors import LinkError, PortError

HAPKIT = nominal("hapkit", ident=7, wired=1, checked=1)


@pytest.fixture
def ask(monkeypatch):
    """Ask a board before its flashing; return what was told, and the board."""

    def asked(store, built=None, board="host"):
        paddle = bench.paddle(store=store)
        port = paddle.exchange.port
        if isinstance(port, Exception):
            raise port
        monkeypatch.setattr(module, "SerialPaddle", lambda url, hello: paddle)
        told, person = [], None if built is None else bench.Scripted(paddle, {"Which paddle is built": built})
        before_flash("COM3", board, person, tell=told.append)
        assert not port.is_open, "the bootloader needs the port"
        return "\n".join(told), port.board.store, person

    return asked


def settings_in(store):
    return hl.device.board.settings.Settings.from_bytes(store[: hl.device.link.messages.SETTINGS_STRUCT.size])


def test_the_same_wiring_stays_confirmed(ask):
    told, store, person = ask(HAPKIT.to_bytes(), "hapkit")
    assert told == "The board is set to this wiring, confirmed."
    assert settings_in(store).wired == 1
    assert "board D5       driver PWM" in person.words


def test_another_wiring_is_a_warning_and_takes_back_what_was_confirmed(ask):
    told, store, _ = ask(HAPKIT.to_bytes(), "longhorn_d11")
    assert "Warning: the board is set to hapkit (PWM D5, DIR D8, OUT A2), but longhorn_d11 (IN1 D4, IN2 D5, EN D11" in told
    assert "Now switch the supply of the motor off." in told and "stays off until `hapticlab calibrate`" in told
    assert (settings_in(store).wired, settings_in(store).checked, settings_in(store).motor_pins) == (0, 0, HAPKIT.motor_pins)


def test_nobody_to_ask_is_told_what_is_stored(ask):
    told, store, _ = ask(changed(HAPKIT, wired=0, checked=0).to_bytes())
    assert told.startswith("The board is set to the wiring hapkit (PWM D5, DIR D8, OUT A2), not confirmed. If another one")
    assert told.endswith("run `hapticlab calibrate --only wiring` after flashing.")
    assert settings_in(store).wired == 0


def test_a_new_board_keeps_its_motor_off(ask):
    assert ask(b"", "hapkit")[0].startswith("The board has no settings. After flashing the motor stays off")


def test_firmware_of_another_board_is_a_warning(ask):
    assert "says that it is a board 'host'; the new firmware is for 'uno'" in ask(HAPKIT.to_bytes(), board="uno")[0]


@pytest.mark.parametrize(
    ("problem", "words"),
    [
        (LinkError("no paddle answers"), "no hapticlab firmware yet. After flashing the motor stays off"),
        (
            LinkError("other tables", "VERSION"),
            "another version, so its settings cannot be compared with what is built. Run `",
        ),
        (PortError("COM3 is in use", "busy"), ""),
    ],
)
def test_a_board_that_cannot_be_asked(monkeypatch, problem, words):
    def fails(url, hello):
        raise problem

    monkeypatch.setattr(module, "SerialPaddle", fails)
    told = []
    before_flash("COM3", "uno", tell=told.append)
    assert words in "\n".join(told)


def test_a_board_that_is_a_drive_cannot_be_asked():
    told = []
    before_flash(None, "pico", tell=told.append)
    assert told == [
        "The settings on the board cannot be read. If another paddle is built than before, switch the supply of the motor off, "
        "and calibrate again."
    ]
