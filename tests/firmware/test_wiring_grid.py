"""What Python says that a board can do and what its firmware takes are the same, over a grid of wirings on the real image."""

import random
import struct

import pico_emulator
import pytest
from emulated import image
from emulator import Uno, missing
from pico_bench import FREE, Rp2040
from wiring_grid import grid

from hapticlab.compiler.boards.board_pins import PICO_PINS, UNO_PINS
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.messages import LOOP_SETTINGS
from hapticlab.device.link.wire import Decoder, encode
from hapticlab.device.setup.wiring_check import rewired
from hapticlab.device.wiring import pin_problem
from hapticlab.device.wirings import BUILDS

needs_uno = pytest.mark.skipif(missing() is not None, reason=str(missing()))
needs_pico = pytest.mark.skipif(pico_emulator.missing() is not None, reason=str(pico_emulator.missing()))
IDENT = 0x5AFE
#: s: a board reads its store, and answers
STARTS, ANSWERS = 0.008, 0.004


def taken(board, wiring):
    """Power a board whose store holds settings of a wiring; return whether it takes them: then it tells the paddle's name."""
    board.eeprom = rewired(nominal("hapkit", ident=IDENT), wiring).to_bytes()
    board.reset()
    board.run(STARTS)
    board.read()
    board.write(encode("HELLO", 1, 7))
    board.run(ANSWERS)
    (welcome,) = Decoder().feed(board.read())
    return int.from_bytes(welcome.payload[12:14], "little") == IDENT


@needs_uno
def test_the_uno_takes_every_wiring_of_a_known_paddle_and_no_other():
    few = random.Random(4).sample(list(grid(UNO_PINS, carriers=(100, 7_812))), 20)
    known = [one.wiring for one in BUILDS.values() if one.board == "uno"]
    with Uno(image()) as board:
        assert all(taken(board, wiring) for wiring in known)
        assert [taken(board, wiring) for wiring in few] == [pin_problem(wiring, UNO_PINS) is None for wiring in few]


@needs_uno
@pytest.mark.wide
def test_the_uno_and_python_agree_on_half_the_wirings_of_a_grid():
    some = random.Random(5).sample(list(grid(UNO_PINS)), 1500)
    with Uno(image()) as board:
        odd = [str(one) for one in some if taken(board, one) != (pin_problem(one, UNO_PINS) is None)]
    assert not odd, "\n".join(odd[:20])


def accepted(board, wiring):
    """Call the Pico's board_accepts with a wiring."""
    record = rewired(nominal("hapkit"), wiring).to_bytes()
    board.write(FREE, record[4:][: struct.calcsize("<" + "".join(kind for kind, *_ in LOOP_SETTINGS))])
    return bool(board.call("board_accepts", FREE)[0])


def rejected_otherwise(wirings):
    """Return the wirings of which a Pico and Python say different things."""
    board = Rp2040()
    return [str(one) for one in wirings if accepted(board, one) != (pin_problem(one, PICO_PINS) is None)]


@needs_pico
def test_the_pico_takes_every_wiring_of_a_known_paddle():
    known = [one.wiring for one in BUILDS.values() if one.board == "pico"]
    few = random.Random(6).sample(list(grid(PICO_PINS, carriers=(1_000, 20_000))), 40)
    assert not rejected_otherwise([*known, *few])


@needs_pico
@pytest.mark.wide
def test_the_pico_and_python_agree_on_every_wiring_of_a_grid():
    assert not rejected_otherwise(grid(PICO_PINS, carriers=(1_000, 20_000)))
