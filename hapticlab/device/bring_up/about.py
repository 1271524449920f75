"""What a bench report says of board, firmware and settings: facts that identify them, and no person."""

import json
import struct
import sys
import zlib
from datetime import date
from pathlib import Path

from ... import __version__
from ...compiler.boards.board_records import BOARDS
from ...compiler.engines.firmware_library import firmware_folder
from ...errors import PaddleError
from ..board.settings import Settings, changed
from ..link.messages import RESET_CAUSES, row_of, table_hash
from ..wiring import Wiring


def is_simulated(paddle):
    """Return whether no board of silicon is there."""
    return paddle.exchange.lockstep or paddle.url.startswith("sim://")


def what_happened(paddle):
    """Return what a board went through before it was connected, without the address of its port."""
    return "; ".join(notice.removeprefix(f"{paddle.url}: ") for notice in paddle.notices)


def about_board(paddle):
    """Return what identifies board, firmware and settings; no person, no computer's name, no path."""
    board, name = paddle.board, paddle.board["board"]
    cause, meaning = row_of(RESET_CAUSES, board["reset_cause"]) or ("?", "unknown")
    shipped = BOARDS[name].flashing if name in BOARDS else None
    return {
        "paddle": f"{name} {board['ident']:04X}",
        "date": f"{date.today():%Y-%m-%d}",
        "port": paddle.url.split("://")[0] if "://" in paddle.url else "serial",
        "simulated": is_simulated(paddle),
        "period": f"{paddle.T:g} s",
        "hapticlab": __version__,
        "firmware": f"{board['major']}.{board['minor']}, messages {board['table']:08x} (this package: {table_hash():08x})",
        "image that comes with this package": _image(shipped),
        "last reset": f"{cause}: {meaning}",
        "pending before": what_happened(paddle) or "nothing",
        "python": f"{sys.version_info.major}.{sys.version_info.minor} on {sys.platform}",
    }


def about_settings(settings):
    """Return the settings in words, and as the bytes that --restore stores."""
    return {"settings": str(settings), "settings_hex": settings.to_bytes().hex()} if settings else {"settings": "none"}


def settings_of(path):
    """Return the Settings that a report has as data.

    Raises
    ------
    PaddleError
        If the file is not a report, or its settings are of firmware with another layout.
    """
    try:
        kept = Settings.from_bytes(bytes.fromhex(json.loads(Path(path).read_text("utf-8"))["about"]["settings_hex"]))
    except (OSError, ValueError, KeyError, TypeError, struct.error) as problem:
        raise PaddleError(f"{path} holds no settings ({problem}); give the .json file of a bench report") from None
    if kept is None:
        raise PaddleError(f"{path}: its settings are of firmware with another layout. Calibrate the paddle again.")
    return kept


def restorable(kept, now):
    """Return settings of a report as the connected board may store them: a person confirms a wiring and a sign, no file does.

    Parameters
    ----------
    kept : Settings
        Of a report.
    now : Settings or None
        What the board stores now.

    Raises
    ------
    PaddleError
        If they are of another paddle.
    """
    if now is None:
        return changed(kept, wired=0, checked=0)
    if kept.ident != now.ident:
        raise PaddleError(
            f"the report is of paddle {kept.ident:04X}, and this is {now.ident:04X}: what was measured on one is wrong on "
            "another. Give a report of this paddle, or run `hapticlab calibrate`."
        )
    wired = now.wired and kept.wired and Wiring.of(kept) == Wiring.of(now)
    alike = len({one.motor_sign * one.metres_per_count > 0 for one in (kept, now)}) == 1  # the same force pushes the same way
    return changed(kept, wired=int(wired), checked=int(wired and kept.checked and now.checked and alike))


def _image(flashing):
    """Name and CRC-32 of an image's file; the board does not tell the CRC-32 of its own flash."""
    if flashing is None:
        return "none: this board is not flashed"
    path = firmware_folder() / "prebuilt" / flashing.image
    return f"{flashing.image}, CRC-32 {zlib.crc32(path.read_bytes()):08x}" if path.is_file() else f"{flashing.image} is missing"
