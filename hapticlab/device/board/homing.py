"""Where the handle is: a board forgets with every reset, and gives no force until it knows."""

from ...base.arguments import number
from ...errors import PaddleError
from ..link.messages import FLAGS

LOOK_AGAIN = 0.05  # [s]


def home(exchange, settings, at=None, timeout=60.0):
    """Tell the board that the handle is at a position [m], or have it led to both stops within timeout [s].

    A simulated handle is led back to the middle, at rest: no hand is there to lead it to the stops.

    Raises
    ------
    PaddleError
        If the stops were not met, or lie further apart than was calibrated.
    """
    if at is None and state_flag(exchange, "HOMED"):
        return
    if settings is None:
        raise PaddleError(
            "the board has no calibration, so the positions of its stops are not known. Run `hapticlab calibrate` first."
        )
    if at is not None:
        at = number("at", at, "m", "a position", error=PaddleError)
        if not settings.travel_min <= at <= settings.travel_max:
            raise PaddleError(
                f"at = {at:g} m; the handle's travel is {settings.travel_min:g} to {settings.travel_max:g} m. "
                "Hold the handle within this range, or calibrate its stops again."
            )
        exchange.command("HOME", at)
        return
    if hasattr(exchange.port, "lead"):
        exchange.port.lead(0.0)
        exchange.command("HOME", 0.0)
        return
    print("Move the handle slowly to one stop, then to the other, and back, so that the board finds its position.")
    timeout = number("timeout", timeout, "s", least=0, error=PaddleError)
    deadline = exchange.now() + timeout
    while exchange.now() < deadline:
        if state_flag(exchange, "HOMED"):
            return
        exchange.wait(lambda: False, LOOK_AGAIN)
    met = (
        "the handle met more travel than was calibrated"
        if state_flag(exchange, "TRAVEL_MISMATCH")
        else "the handle did not meet both stops"
    )
    raise PaddleError(
        f"home: {met} within {timeout:g} s. Move the handle to both stops, or hold it in the middle and call "
        "paddle.home(at=0.0). If this happens again, run `hapticlab calibrate`."
    )


def state_flag(exchange, name):
    """Return whether a flag of messages.FLAGS is up in the board's state."""
    return bool(exchange.refresh()["flags"] & FLAGS[name])
