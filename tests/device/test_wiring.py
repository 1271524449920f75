"""Wirings to and from settings; what a board cannot do is rejected in words; the known paddles fit their boards."""

from dataclasses import replace

import pytest
from wiring_grid import grid

from hapticlab.compiler.boards.board_pins import PICO_PINS, PINS, UNO_PINS
from hapticlab.compiler.boards.board_records import HOST, UNO
from hapticlab.device.board.settings import Settings, changed, nominal
from hapticlab.device.wiring import Wiring, pin_problem, require_possible
from hapticlab.device.wirings import BUILDS, build, built_as
from hapticlab.errors import PaddleError

HAPKIT = build("hapkit").wiring
LONGHORN = build("longhorn_d11").wiring
MOST = "AS5048A", "SHIFT_REGISTER"


@pytest.mark.parametrize("name", BUILDS)
def test_a_board_keeps_a_wiring_in_its_settings(name):
    wiring = BUILDS[name].wiring
    kept = Settings.from_bytes(changed(nominal("hapkit"), **wiring.settings()).to_bytes())
    assert Wiring.of(kept) == wiring
    assert built_as(BUILDS[name].board, Wiring.of(kept)) is BUILDS[name]


@pytest.mark.parametrize("name", BUILDS)
def test_the_board_of_a_known_paddle_can_do_its_wiring(name):
    assert pin_problem(BUILDS[name].wiring, BUILDS[name].pins) is None
    assert BUILDS[name].source


def test_the_wiring_that_a_new_hapkit_has_is_the_published_one():
    assert Wiring.of(nominal("hapkit")) == HAPKIT


def test_a_pin_is_a_byte_the_first_one_lowest():
    assert LONGHORN.settings() == {
        "sensor": 1, "drive": 2, "motor_pins": 0xFF0B0504, "sensor_pins": 0xFFFF0302, "carrier": 31_372,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("wiring", "words"),
    [
        (replace(HAPKIT, motor_pins=(9, 8)), "PWM on D9: an Uno has PWM on D3, D5, D6, D11. Move this wire to one of them."),
        (replace(HAPKIT, motor_pins=(5, 1)), "DIR on D1: an Uno uses D1 for the serial link to the computer. Move this wire"),
        (replace(HAPKIT, motor_pins=(5, 5)), "PWM and DIR on D5: an Uno takes one wire per pin"),
        (replace(HAPKIT, motor_pins=(5, 40)), "DIR on pin 40: an Uno has D2 to D12, A0 to A5. Move this wire to another pin"),
        (replace(HAPKIT, sensor_pins=(7,)), "OUT on D7: an Uno reads voltages on A0, A1, A2, A3, A4, A5"),
        (replace(HAPKIT, carrier=100), "PWM of 100 Hz: an Uno has 490 Hz to 62500 Hz. Choose one of 62500, 31372, 7812"),
        (replace(HAPKIT, motor_pins=(5, 13)), "DIR on D13: an Uno uses D13 for the light that its bootloader blinks"),
        (Wiring("AS5048A", "PWM_DIRECTION", (5, 12), (10,)), "DIR and MISO on D12: an Uno takes one wire per pin"),
        (Wiring("QUADRATURE", "SHIFT_REGISTER", (11, 10, 4, 8), (2, 3)), "LATCH on D10: an Uno has the shield's LATCH on D12"),
        (Wiring("MAGNETORESISTIVE", "SHIFT_REGISTER", (11, 12, 4, 8), (12,)), "LATCH and OUT on D12: an Uno takes one wire"),
        (Wiring("AS5048A", "SHIFT_REGISTER", (5, 12, 4, 8), (7,)), "LATCH and MISO on D12: an Uno takes one wire per pin"),
        (replace(LONGHORN, sensor_pins=(3, 2)), "A on D3 and B on D2: an Uno counts an encoder on D2 and D3, in this order"),
        (replace(LONGHORN, motor_pins=(4, 5, 10)), "EN on D10: an Uno has PWM on"),
        (Wiring("QUADRATURE", "TWO_INPUTS", (4, 5), (2, 3)), "IN1 on D4: an Uno has PWM on"),
        (Wiring(*MOST, (11, 12, 4, 8), (10,)), "PWM and MOSI on D11: an Uno takes one wire per pin"),
        (Wiring("MAGNETORESISTIVE", "SHIFT_REGISTER", (2, 12, 4, 8), (16,)), "PWM on D2: an Uno has PWM on"),
    ],
)
def test_what_an_uno_cannot_do_is_rejected_in_words(wiring, words):
    with pytest.raises(PaddleError) as told:
        require_possible(wiring, UNO)
    assert str(told.value).startswith(words)


def test_a_pico_takes_no_shield():
    given, why, cure = pin_problem(Wiring("QUADRATURE", "SHIFT_REGISTER", (11, 12, 4, 8), (2, 3)), PICO_PINS)
    assert (given, why, cure) == ("a motor shield on GP11", "takes a shield's motor on no pin", "Choose one of them")


def test_a_board_without_pins_is_rejected():
    with pytest.raises(PaddleError, match="host has no pins"):
        require_possible(HAPKIT, HOST)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("ENCODER", "TWO_INPUTS", (5, 6), (2, 3)), "sensor = 'ENCODER'; needs one of MAGNETORESISTIVE"),
        (("QUADRATURE", "BRIDGE", (5, 6), (2, 3)), "drive = 'BRIDGE'; needs one of PWM_DIRECTION"),
        (("QUADRATURE", "TWO_INPUTS", (5,), (2, 3)), r"motor_pins = \(5,\); TWO_INPUTS needs 2 pins: IN1, IN2"),
        (("AS5048A", "TWO_INPUTS", (5, 6), (300,)), r"sensor_pins = \(300,\); AS5048A needs 1 pins: CSn"),
    ],
)
def test_what_is_no_wiring_is_rejected(given, words):
    with pytest.raises(PaddleError, match=words):
        Wiring(*given)


def test_a_name_that_is_none_lists_those_there_are():
    with pytest.raises(PaddleError, match="no wiring 'falcon'; there are hapkit, hapkit_as5048a, longhorn_d11"):
        build("falcon")


def test_every_pin_is_wired_once_and_the_table_has_every_wire():
    for one in BUILDS.values():
        wires = [wire for wire in one.wires() if wire.begin[0] == "board" and wire.carries == "signal"]
        pins = [wire.begin[1] for wire in wires]
        assert len(set(pins)) == len(pins) == len(one.wiring.pins()) + 3 * (one.wiring.sensor == "AS5048A")
        assert len(one.table()) == 3 + len(one.wires())


def test_names_and_numbers_of_a_boards_pins_are_one_to_one():
    for pins in PINS.values():
        assert len(set(pins.names.values())) == len(pins.names)
        assert set(pins.pwm) | set(pins.analog) | set(pins.spi.values()) | {a for p in pins.quadrature for a in p} <= set(
            pins.names
        )
    assert (UNO_PINS.name(16), UNO_PINS.name(13)) == ("A2", "D13")


def test_a_test_of_the_boards_themselves_has_wirings_of_both_kinds():
    """What the grid of wirings holds, which the firmware's own board_accepts is asked about in tests/firmware."""
    found = [pin_problem(one, UNO_PINS) is None for one in grid(UNO_PINS)]
    assert 20 < sum(found) < len(found) / 2
