"""What gives a live view its samples, and how that is moved."""

from ..device.board.serial_paddle import SerialPaddle
from ..device.board.streaming import Streaming
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..device.simulated.stepping import Stepping
from ..device.turns import has_threads
from ..errors import PaddleError

ONE_THREAD = (
    "In this browser, views and cells take turns. While a cell computes, the view stands still. While a cell awaits, the view "
    "continues, but your input takes effect only after the cell."
)


def source_of(paddle, scene, **options):
    """A source of samples of a scene on a paddle."""
    kinds = {SimulatedPaddle: Stepping, SerialPaddle: Streaming}
    for kind, source in kinds.items():
        if isinstance(paddle, kind):
            return source(paddle, scene, **options)
    raise PaddleError(
        f"paddle = {paddle!r}; a live view needs a SimulatedPaddle, or a board: hl.connect(). "
        "hl.SimulatedPaddle.from_profile(...) makes one of a profile or its file"
    )


def overview_words(source, scene, along):
    """Say what a view shows, to who does not see it."""
    ways = "left and right" if abs(along[0]) > 0.5 else "down and up"
    kind = "real" if source.kind == "board" else "simulated"
    parameters = ", ".join(scene.parameters) or "none"
    return (
        f"Live view of {source.program.name}. The picture shows a handle that moves {ways}, and what it touches or carries. "
        f"The paddle is {kind}. Below the picture are numbers, traces over time, the loop of force over position, and the "
        f"parameters: {parameters}. Press D for the present details."
    )


def help_words(source):
    """Say what moves a handle on view, and what a cell does to it where there are no threads."""
    words = _moved_by_words(source)
    return words if has_threads() else f"{words} {ONE_THREAD}"


def _moved_by_words(source):
    if source.kind == "board":
        return "Start switches the motor on: hold the handle. The motor goes off with Stop, and when this view closes."
    hand = source.paddle.hand
    return (
        "Drag the handle, or use the arrow keys: they move the target position of the hand, and the spring and damper of the "
        f"hand pull the handle there ({hand.k:g} N/m, {hand.b:g} N s/m, {1e3 * hand.m:g} g)."
    )
