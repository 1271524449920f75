"""The first words with a board: is it a paddle, does it speak this version, what did it go through."""

import math

from ... import __version__
from ...compiler.boards.board_records import BOARDS, Drive
from ...errors import LinkError
from ..link.messages import FIRMWARE, RESET_CAUSES, STATES, row_of, table_hash
from .run import fault_words
from .settings import day_in_words

#: how long a board may take to answer, from reset [s]
HELLO = 3.0
#: seconds between two hellos: opening the port has reset many a board, whose bootloader listens first
AGAIN = 0.2


def say_hello(exchange, url, seconds):
    """The board's answer to HELLO, the fields of WELCOME.

    Raises
    ------
    LinkError
        If nothing answers within so many seconds, or in another version.
    """
    try:
        said = exchange.ask("HELLO", exchange.session, patience=AGAIN, tries=max(1, round(seconds / AGAIN))).fields
    except LinkError:
        raise LinkError(
            f"{url}: no paddle answers within {seconds:g} s. Either the board has no hapticlab firmware (`hapticlab flash` "
            "installs it) or this is a different device. `hapticlab ports` lists the devices that are plugged in."
        ) from None
    name = said["board"].rstrip(b"\0").decode("ascii", "replace")
    if said["table"] != table_hash():
        which = f" --board {name}" if isinstance(BOARDS[name].flashing if name in BOARDS else None, Drive) else ""
        raise LinkError(
            f"{url}: the board's firmware {said['major']}.{said['minor']} uses a different version of the messages from "
            f"firmware {FIRMWARE[0]}.{FIRMWARE[1]}, which comes with hapticlab {__version__}. Flash it: hapticlab flash{which}",
            "VERSION",
        )
    return said | {"board": name}


def what_happened(exchange, url, reset_cause):
    """Return sentences about what the board went through before this hello, and clear a standing fault."""
    told = []
    if reset_cause in (RESET_CAUSES["BROWN_OUT"][0], RESET_CAUSES["WATCHDOG"][0]):
        told.append(f"{url}: the board was reset by {row_of(RESET_CAUSES, reset_cause)[1]}")
    return told + cleared(exchange, url)


def cleared(exchange, url):
    """Clear a standing fault; return the sentence that tells it, in a list that is empty where none stood."""
    state = exchange.refresh()
    if state["state"] != STATES["FAULT"]:
        return []
    exchange.command("CLEAR")
    return [f"{url}: a fault was pending: {fault_words(state | {'absent': exchange.absent()})}"]


def introduction(board, settings, T):
    """Return a paddle in one line: board, firmware, period, calibration, limit."""
    parts = [f"{board['board']} {board['ident']:04X}", f"firmware {board['major']}.{board['minor']}", f"T = {T * 1e3:g} ms"]
    if settings is None:
        return ", ".join([*parts, "not calibrated, so the motor stays off (run `hapticlab calibrate`)"])
    calibrated = "nominal constants, not calibrated" if settings.is_nominal else f"calibrated {day_in_words(settings.date)}"
    parts += [calibrated, f"|F| <= {min(settings.force_max, settings.force_full):.4g} N"]
    if not settings.wired:
        parts.append("wiring not confirmed, so the motor stays off (run `hapticlab calibrate`)")
    elif not settings.checked:
        parts.append("motor sign not checked, so at most 0.5 N")
    return ", ".join(parts)


def silent_fault(state, exchange):
    """Return the fault that a STATE tells, as a FAULTED frame would have."""
    return {"fault": state["fault"], "tick": state["tick"], "value": math.nan, "absent": exchange.absent()}


def explain_silence(exchange, url):
    """Return the fault that keeps a running board from sending samples, or raise LinkError with another reason."""
    state = exchange.refresh()
    if state["session"] not in (0, exchange.session):
        raise LinkError(
            f"{url}: another program connected to the board while the scene ran, which ended the scene. End that program "
            "(another notebook, another user of the same socket), then connect again."
        )
    if state["session"] != exchange.session:
        raise LinkError(
            f"{url}: the board was reset while the scene ran, and its motor is off. Either its supply voltage fell too low "
            "when the motor drew current, or its reset button was pressed. Check the supply, then connect again."
        )
    if state["state"] == STATES["FAULT"]:  # and the report of it was lost on its way
        return silent_fault(state, exchange)
    what = "runs but sends no samples" if state["state"] == STATES["RUN"] else "was stopped by another program"
    raise LinkError(f"{url}: the board {what}; connect again")
