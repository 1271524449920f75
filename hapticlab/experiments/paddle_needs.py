"""What an experiment asks of a paddle before it begins."""

from ..device.hand.hand import Hand
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import PaddleError


def check_simulated(paddle: object, asker: str) -> None:
    """Refuse what is no SimulatedPaddle, a board too: its person, or its mechanics, cannot be simulated.

    Examples
    --------
    >>> from hapticlab.experiments.paddle_needs import check_simulated
    >>> check_simulated(SimulatedPaddle(m=0.05, b=0.1, T=1e-3), "juggle")
    """
    if not isinstance(paddle, SimulatedPaddle):
        what = getattr(paddle, "__name__", type(paddle).__name__)
        raise PaddleError(f"{asker} runs in simulation alone; needs hl.SimulatedPaddle(...), not a {what}.")


def check_held(paddle: SimulatedPaddle, asker: str) -> Hand:
    """The hand that holds a simulated paddle by a spring; other paddles are refused."""
    check_simulated(paddle, asker)
    if paddle.hand is None or paddle.hand.k <= 0:
        raise PaddleError(
            f"{asker} needs a hand that holds the handle by a spring; give hl.SimulatedPaddle(..., hand=hl.Hand('grip')) or "
            "hl.Hand(k=...)."
        )
    return paddle.hand
