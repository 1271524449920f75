"""Before firmware is written: is the paddle that is built the one that the board is told? No motor moves after it unasked."""

from contextlib import suppress

from ...errors import HapticlabError, LinkError
from ..board.serial_paddle import SerialPaddle
from ..board.settings import changed, pins_of
from ..wiring import Wiring
from ..wirings import built_as
from .built import ask_built, board_with_pins, show
from .stored_settings import store

#: s that firmware of this package may take to answer; a new board has none
HELLO = 1.0


def before_flash(port, board, person=None, *, tell=print):
    """Ask a board what it is told of its wiring, compare it with what is built, and warn where they differ.

    A wiring that is not the stored one is taken back: wired = 0 and checked = 0, and a kept scene does not start any more. The
    settings stay where they are while firmware is written, and new firmware keeps the motor off until `calibrate` has
    confirmed the wiring, unless settings of the same layout say that it is confirmed.

    Parameters
    ----------
    port : str or None
        None for a board that shows itself as a drive, and not as a port.
    board : str
        For which the firmware is.
    person : Person, optional
        The person who knows what is built; None compares nothing and says so.
    tell : callable
        Called with each sentence.
    """
    built = ask_built(person, board_with_pins(board)) if person is not None else None
    if built is not None:
        show(person, built)
    if port is None:
        tell(f"The settings on the board cannot be read. If another paddle is built than before, {OFF}, and calibrate again.")
        return
    try:
        paddle = SerialPaddle(port, hello=HELLO)
    except LinkError as problem:
        tell(OTHER if problem.result == "VERSION" else f"The board has no hapticlab firmware yet. {AFTER}")
        tell(f"Until then, {OFF}.")
        return
    except HapticlabError:
        return  # flashing itself says what is wrong with the port
    try:
        for sentence in _compared(paddle, board, built):
            tell(sentence)
    finally:
        paddle.close()


OFF, AGAIN = "switch the supply of the motor off", "run `hapticlab calibrate --only wiring` after flashing"
AFTER = "After flashing the motor stays off until `hapticlab calibrate` has confirmed the wiring."
#: settings of firmware 1 are lost; later ones may have the same layout, so that a confirmed wiring stays confirmed
OTHER = (
    "The board has firmware of another version, so its settings cannot be compared with what is built. Run `hapticlab calibrate` "
    "after flashing, because the calibration may be lost, or the wiring of another paddle may still be confirmed."
)


def _compared(paddle, board, built):
    """Yield sentences on what is stored and what is built, having taken back what does not fit."""
    kept, has = paddle.settings, paddle.board["board"]
    if has != board:
        yield f"Warning: the firmware on this board says that it is a board {has!r}; the new firmware is for {board!r}."
    if kept is None or not pins_of(kept.motor_pins):
        yield f"The board has no settings. {AFTER}"
        return
    told = built_as(board_with_pins(has), Wiring.of(kept))
    state = "confirmed" if kept.wired else "not confirmed"
    if built is None:
        yield f"The board is set to the wiring {told.in_short()}, {state}. If another one is built, {OFF}, and {AGAIN}."
    elif built.wiring == told.wiring:
        yield f"The board is set to this wiring, {state}."
    else:
        yield f"Warning: the board is set to {told.in_short()}, but {built.in_short()} is built. Now {OFF}."
        with suppress(LinkError):  # firmware without a kept scene
            paddle.forget()
        if kept.wired:
            store(paddle, changed(kept, wired=0, checked=0))
        yield f"The stored wiring counts no more. {AFTER}"
