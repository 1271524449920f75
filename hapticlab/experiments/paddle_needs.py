"""What an experiment asks of a paddle before it begins."""

from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import PaddleError


def check_simulated(paddle, asker):
    """Refuse what is no SimulatedPaddle, a board too: its person, or its mechanics, cannot be simulated.

    Examples
    --------
    >>> from hapticlab.experiments.paddle_needs import check_simulated
    >>> check_simulated(SimulatedPaddle(m=0.05, b=0.1, T=1e-3), "juggle")
    """
    if not isinstance(paddle, SimulatedPaddle):
        what = getattr(paddle, "__name__", type(paddle).__name__)
        raise PaddleError(f"{asker} runs in simulation alone; needs hl.SimulatedPaddle(...), not a {what}.")


def check_held(paddle, asker):
    """Refuse a paddle that is not simulated, or that no hand with a spring holds."""
    check_simulated(paddle, asker)
    if paddle.hand is None or paddle.hand.k <= 0:
        raise PaddleError(
            f"{asker} needs a hand that holds the handle by a spring; give hl.SimulatedPaddle(..., hand=hl.hand('grip')) or "
            "hl.Hand(k=...)."
        )
