"""An emulated Uno with its paddle, connected as any board is."""

import tempfile
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from build_image import build
from closed_loop import ClosedLoop, PaddleHandle
from emulator import Uno
from uno_port import offer

from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle


@cache
def image():
    """The firmware as the sources are now."""
    folder = tempfile.mkdtemp(prefix="uno")
    return Path(build("uno", folder)[1])


@contextmanager
def emulated_uno(hand=None, *, T=1e-3, home=True, settings=None, **changes):
    """A SerialPaddle on an emulated Uno whose handle is a simulated hapkit's; it is told where that is, unless not ``home``."""
    settings = settings or nominal("hapkit", wired=1, checked=1, ident=0x3F2A, date=20261120)
    mechanics = SimulatedPaddle.from_profile("hapkit", hand=hand, **changes)
    with Uno(image(), eeprom=settings.to_bytes()) as board:
        loop = ClosedLoop.of(settings.to_float32(), board, PaddleHandle(mechanics))
        with SerialPaddle(offer(f"emulated{id(loop)}", loop), T=T) as paddle:
            paddle.loop = loop
            if home:
                paddle.home(at=loop.x)
            yield paddle
