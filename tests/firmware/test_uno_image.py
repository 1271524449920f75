"""The whole image of the Uno under emulation, closed around a paddle, with the package on the other end of the link."""

import numpy as np
import pytest
import serial
from build_image import FLASH, RAM, build, sizes
from closed_loop import ClosedLoop, PaddleHandle
from emulator import RAM_BEGIN, TIMER1_COMPA, USART_RX, Uno, missing
from five_scenes import SCENES, compiled
from stack_bound import StackBound
from uno_port import offer

import hapticlab as hl
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal
from hapticlab.device.board.upload import read_settings, upload
from hapticlab.device.hand.hand import Hand

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))

KEPT_FREE = 512  # bytes of flash
GUARD = 4  # bytes of board_alive's mark between variables and stack
FITS = SCENES[:4]  # the double pendulum's program is larger than the arena


@pytest.fixture(scope="module")
def image(tmp_path_factory):
    return build("uno", tmp_path_factory.mktemp("image"))


@pytest.fixture
def connect(image):
    """Connect to a board around a handle that a hand holds and pushes."""
    open_paddles = []

    def connect(T=1e-3, **settings):
        kept = nominal("hapkit", **{"wired": 1, "checked": 1, "date": 20261120, "ident": 0x3F2A, **settings})
        paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3, hand=Hand(m=0.1, b=2, k=50, push=1.0))
        board = Uno(image[1], eeprom=kept.to_bytes())
        loop = ClosedLoop.of(kept, board, PaddleHandle(paddle))
        connected = SerialPaddle(offer("board", loop), T=T)
        open_paddles.append((connected, board))
        return connected, loop

    yield connect
    for paddle, board in open_paddles:
        paddle.close()
        board.close()


@pytest.mark.wide
def test_the_port_is_pyserials(image):
    with Uno(image[1]) as board:
        url = offer("bare", ClosedLoop.of(nominal("hapkit"), board, PaddleHandle(hl.SimulatedPaddle(m=1, b=1, T=1e-3))))
        with serial.serial_for_url(url, baudrate=500000, timeout=0.05) as port:
            assert port.lockstep and port.is_open and port.in_waiting == 0
            begin = port.now()
            assert port.read(5) == b"" and port.now() - begin == pytest.approx(0.05, abs=1e-6)
            assert port.read(0) == b"" and port.now() - begin == pytest.approx(0.05, abs=1e-6)
        with pytest.raises(serial.PortNotOpenError):
            port.read(1)
        with pytest.raises(serial.SerialException, match="no board is offered as 'nobody'"):
            serial.serial_for_url("uno://nobody", baudrate=500000)


@pytest.mark.wide
def test_a_kilohertz_of_telemetry_without_loss(connect):
    paddle, loop = connect()
    paddle.home(at=0.0)
    log = paddle.run(compiled(SCENES[0]), duration=1.0, every=1, progress=False)
    assert log.fault is None and len(log.t) == 1000
    assert loop.board.overruns == 0
    assert np.abs(np.diff(log.t) - 1e-3).max() < 1e-9, "a sample is missing"


def test_the_store_takes_longer_than_the_watchdog_waits(connect):
    """3.4 ms a byte: settings are written while the tick runs on, and nothing resets the board."""
    paddle, loop = connect()
    session = paddle.state()["session"]
    changed = nominal("hapkit", ident=0x1234, wired=1, checked=1, wrap=900, force_max=2.5, m=0.07, b=0.4)
    loop.board.eeprom = bytes(1024)  # so that every byte is written
    begin = loop.now
    upload(paddle.exchange, "SETTINGS", changed.to_bytes())
    print(f"settings: {loop.now - begin:.2f} s")
    assert loop.now - begin > 0.125
    assert read_settings(paddle.exchange) == changed.to_float32()
    assert loop.board.eeprom == (2 * changed.to_bytes()).ljust(1024, b"\0")
    assert paddle.state()["session"] == session, "the board was reset"


def test_the_stack_fits(image):
    """The deepest chains of calls of main loop, tick and link at the same moment end above the guard."""
    bound, (flash, ram) = StackBound(image[0]), sizes(image[0])
    print(f"flash {flash} of {FLASH}, static RAM {ram}, stack {bound.image()} at most, of {RAM} bytes")
    for name, meaning in (("main", "main loop"), ("__vector_11", "tick"), ("__vector_18", "byte received")):
        depth, chain = bound.of(name)
        print(f"  {meaning}: {depth} bytes: {' > '.join(chain)}")
    assert flash <= FLASH - KEPT_FREE
    assert ram + GUARD + bound.image() <= RAM


@pytest.mark.parametrize("make", FITS, ids=lambda make: make.__name__)
@pytest.mark.always("cart_pole")
def test_the_stack_keeps_its_bound(connect, image, make):
    T = 1e-3 if make in SCENES[:1] else 2e-3
    paddle, loop = connect(T=T)
    paddle.home(at=0.0)
    log = paddle.run(compiled(make, T), duration=0.25, progress=False)
    assert log.fault is None and len(log.t) == round(0.25 / T)
    end = sizes(image[0])[1] + GUARD
    used = RAM - end - loop.board.stack_left(RAM_BEGIN + end)
    print(f"{make.__name__}: {used} bytes of stack used")
    for vector, name in ((TIMER1_COMPA, "tick"), (USART_RX, "byte received")):
        count, mean, worst = loop.board.cost(vector)
        print(f"  {name}: {count} times, mean {mean:.0f}, worst {worst} cycles")
    assert 100 < used <= StackBound(image[0]).image()
