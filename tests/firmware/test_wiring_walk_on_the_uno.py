"""An owner tells a real image the wrong paddle, is told which wires are silent, corrects it, and confirms."""

import pytest
from emulated import emulated_uno
from emulator import missing
from wired import high_pins

import hapticlab as hl
from hapticlab.device.board.settings import nominal
from hapticlab.device.setup.practice import PractisingPerson
from hapticlab.device.wiring import Wiring
from hapticlab.device.wirings import build
from hapticlab.errors import PaddleError

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))


class Hands:
    """The handle of an emulated board, as a simulated person takes it."""

    def __init__(self, loop):
        self._loop = loop

    handle = property(lambda self: self._loop.handle.handle, lambda self, handle: setattr(self._loop.handle, "handle", handle))


class Owner(PractisingPerson):
    """Whoever is asked says what they believe to have built, and stops where a wire is named."""

    def __init__(self, paddle, built):
        self.board, self.port, self.built, self.said = paddle, Hands(paddle.loop), built, []

    def say(self, text):
        self.said.append(text)

    def choose(self, question, options):
        return "no" if question.startswith("Correct it") else super().choose(question, options)


@pytest.mark.wide
def test_a_hapkit_that_is_told_to_be_a_longhorn_and_then_what_it_is():
    confirmed = nominal("hapkit", wired=1, checked=1, ident=7, date=20261120)
    with emulated_uno(settings=confirmed) as paddle:
        board = paddle.loop.board
        owner = Owner(paddle, "longhorn_d6")
        hl.calibrate(paddle, owner, only="wiring")
        assert "changed by 0 counts" in "".join(owner.said) and "Check A on D2 and B on D3" in "".join(owner.said)
        assert (paddle.settings.wired, paddle.settings.checked) == (0, 0)
        assert Wiring.of(paddle.settings) == build("longhorn_d6").wiring
        assert "wiring not confirmed, so the motor stays off" in str(paddle)
        with pytest.raises(PaddleError, match="nobody has confirmed the wiring"):
            paddle.start(hl.wall(k=100, x_o=0.01))
        assert not set(high_pins(board)) & {4, 5, 6, 8}, "pins of either driver"
        owner = Owner(paddle, "hapkit")
        hl.calibrate(paddle, owner, only="wiring")
        assert "largest jump" in "".join(owner.said) and "Confirmed" in "".join(owner.said)
        assert Wiring.of(paddle.settings) == Wiring.of(confirmed)
        assert (paddle.settings.wired, paddle.settings.checked) == (1, 0)
        assert board.duty == 0
