"""What gives a live view its samples, and how that is moved."""

from ..device.board.serial_paddle import SerialPaddle
from ..device.board.streaming import Streaming
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..device.simulated.stepping import Stepping
from ..errors import PaddleError


def source_of(paddle, scene, **options):
    """A source of samples of a scene on a paddle."""
    kinds = {SimulatedPaddle: Stepping, SerialPaddle: Streaming}
    for kind, source in kinds.items():
        if isinstance(paddle, kind):
            return source(paddle, scene, **options)
    raise PaddleError(f"paddle = {paddle!r}; a live view needs a SimulatedPaddle, or a board: hl.connect()")


def help_words(source, speed):
    """Say what moves a handle on view."""
    if source.kind == "board":
        return "Start switches the motor on: hold the handle. The motor goes off with Stop, and when this view closes."
    hand = source.paddle.hand
    slow = f" Time runs at {speed:g} of the clock's." if speed != 1 else ""
    return (
        "Drag the handle, or use the arrow keys: they move where the hand means to be, and the hand's spring follows "
        f"({hand.k:g} N/m, {hand.b:g} N s/m, {1e3 * hand.m:g} g).{slow}"
    )
