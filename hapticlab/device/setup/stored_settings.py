"""Settings onto a board, never unasked: shown, agreed to, written, read back, compared."""

from ...compiler.boards.board_records import BOARDS
from ...errors import LinkError, PaddleError
from ..board.homing import state_flag
from ..board.upload import read_settings, upload
from ..wiring import Wiring, require_possible
from .person import agrees

#: s: the longest wait for a motor that is taken to be warm, and from one look to the next
COOLS, LOOK = 300.0, 1.0
#: how often a person may try to lead the handle to both stops
TRIES = 3


def offer(paddle, person, settings, found):
    """Show what is to be stored and store it if the person agrees; return whether it was."""
    person.say("\n".join(["", *found]))
    if not agrees(person, "Store these settings on the board?"):
        person.say("Nothing was written.")
        return False
    store(paddle, settings)
    person.say("Stored, read back and found equal in every bit.")
    return True


def store(paddle, settings):
    """Write settings on the board and read them back; the board forgets its position over it.

    Raises
    ------
    PaddleError
        If the board cannot do their wiring: nothing is sent.
    LinkError
        If the board refuses, or keeps anything else than was sent.
    """
    board = BOARDS.get(paddle.board["board"])
    if board is not None and board.pins is not None:
        require_possible(Wiring.of(settings), board)
    upload(paddle.exchange, "SETTINGS", settings.to_bytes())
    kept = read_settings(paddle.exchange)
    if kept is None or kept.to_bytes() != settings.to_bytes():
        raise LinkError(
            f"{paddle.url}: the board stored settings that differ from those sent; write them again, and if it "
            "fails again, replace the board",
            "STORE",
        )
    paddle.settings = kept
    paddle.board["ident"] = kept.ident


def lead_home(paddle, person):
    """Have the person lead the handle to both stops, until the board knows where it is."""
    if state_flag(paddle.exchange, "HOMED"):
        return
    for _ in range(TRIES):
        person.ask("Move the handle slowly to one stop, then to the other, then back to the middle, and press Enter.")
        if state_flag(paddle.exchange, "HOMED"):
            return
        person.say("The handle has not met both stops yet. Move it once more against each stop.")
    if state_flag(paddle.exchange, "TRAVEL_MISMATCH"):
        raise PaddleError("the handle moved further than the distance between the calibrated stops: calibrate the stops again")
    raise PaddleError("the handle did not reach both calibrated stops: remove any obstacle, or calibrate the stops again")


def let_cool(paddle, person):
    """Wait until the board takes its motor to be cool enough; settings of a weaker motor make what it gave before count more."""
    if paddle.state()["heat"] <= 1:
        return
    person.say("By its past forces, the motor is warm. The motor stays off until it has cooled, which takes some minutes.")
    until = paddle.exchange.now() + COOLS
    while paddle.state()["heat"] > 1 and paddle.exchange.now() < until:
        paddle.exchange.wait(lambda: False, LOOK)
