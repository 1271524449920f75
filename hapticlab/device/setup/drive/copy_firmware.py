"""Copy firmware to a board whose own ROM shows itself as a drive, such as a Raspberry Pi Pico.

The ROM takes a UF2 file, checks no byte of it, and starts the firmware when the last block has come: the drive then vanishes,
often before the computer has finished with the file. So what counts is whether the board comes back as a paddle's port.
"""

import os
import sys
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ....compiler.boards.board_records import BOARDS, Drive
from ....errors import PaddleError, PortError
from ...link.serial_ports import available_ports, open_port
from ...progress import progress_bar
from ..flash import prebuilt_image
from .uf2_blocks import parse_uf2

#: board -> how firmware is copied to it
COPIED = {name: board.flashing for name, board in BOARDS.items() if isinstance(board.flashing, Drive)}
INFO = "INFO_UF2.TXT"
#: s: for a drive that the firmware was asked for, for a person at the button, for a drive that failed to vanish, for the port
#: to come, and between two looks
ASKED_WAIT, PERSON_WAIT, LEAVE_WAIT, PORT_WAIT, LOOK = 5.0, 60.0, 3.0, 15.0, 0.25
PIECE = 4096  # bytes


@dataclass(frozen=True)
class Copied:
    """What was copied, and the port on which the board came back."""

    port: str
    image: str
    size: int

    def __str__(self):
        return f"{self.image}: {self.size} bytes copied; the board started the firmware and is at {self.port}"


def copy_firmware(image=None, board="pico", port=None, *, progress=True, tell=lambda sentence: None):
    """Copy a firmware image to a board's drive, and wait until the board comes back with a serial port.

    Parameters
    ----------
    image : path of a UF2 file, optional
        The one that comes with the package if None.
    board : str
        One of :data:`COPIED`.
    port : str, optional
        Of the board that is to be asked for its drive; by default the only board of this kind.
    progress : bool
        Show a bar if it lasts longer than two seconds.
    tell : callable
        Called with a sentence where a person has to do something, and just before the image is copied.

    Returns
    -------
    Copied

    Raises
    ------
    PortError
        If no drive appears (``cause`` "missing"), if there is more than one, or if the board does not come back.
    PaddleError
        If the image is damaged or for another chip, if the drive belongs to another chip, or if it takes no file.
    """
    how = COPIED[board]
    path = Path(image) if image is not None else prebuilt_image(how)
    try:
        content = path.read_bytes()
    except OSError as problem:
        raise PaddleError(f"{path} does not open ({problem.strerror}); give the path of a .uf2 file") from None
    parse_uf2(content, path.name, how.family)
    drive = _wait_for_drive(board, how, port, tell)
    before = {port.device for port in available_ports()}
    tell(f"Copying {path.name} to {drive}. The motor stays off. Do not unplug the cable.")
    trouble = _copy(content, drive / path.name, progress)
    if trouble and not _within(LEAVE_WAIT, lambda: not is_drive(drive)):
        raise PaddleError(f"{drive} took no file ({trouble.strerror or trouble}). {_by_hand(how)}, then flash it again")
    port = _within(PORT_WAIT, lambda: _new_port(usb_numbers(board), before))
    if port is None:
        raise PortError(f"{path.name} was copied, but {_not_back(how, drive)}", "missing")
    return Copied(port.device, path.name, len(content))


def _new_port(numbers, before):
    return next((p for p in available_ports() if (p.vid, p.pid) in numbers and p.device not in before), None)


def _not_back(how, drive):
    """Return what happened instead of a port, and what to do."""
    if is_drive(drive):
        return f"{drive} is still there: the board did not accept the image. {_by_hand(how)}, then flash it again"
    return (
        f"no new port of {how.called} appeared within {PORT_WAIT:.0f} s. Unplug the board and plug it in again without "
        "its button, then run hapticlab doctor. If there is still no port, flash the board again"
    )


def _by_hand(how):
    return (
        "Unplug the board, hold down its BOOTSEL button, plug it in again, and release the button when the drive "
        f"{how.name} appears"
    )


def waiting_boards(board):
    """Return the drives of boards of this kind that wait for firmware; none where a drive is of another chip."""
    try:
        return _drives(COPIED[board])
    except PaddleError:
        return []


def _wait_for_drive(board, how, port, tell):
    """Return the drive of the one board that waits for firmware; ask for it where there is none."""
    found = _drives(how) or _asked(board, how, port, tell)
    if not found:
        tell(f"No drive {how.name} is there. Switch off the supply of the motor. {_by_hand(how)}.")
        found = _within(PERSON_WAIT, lambda: _drives(how))
    if not found:
        words = f"no drive {how.name} appeared within {PERSON_WAIT:.0f} s. Use a USB cable that carries data. {_by_hand(how)}"
        raise PortError(f"{words}, then run the command again", "missing")
    if len(found) > 1:
        named = " and ".join(map(str, found))
        raise PortError(f"{named}: more than one board waits for firmware. Leave only one of them plugged in", "several")
    return found[0]


def _asked(board, how, port, tell):
    """Ask a board that runs this firmware for its drive, by closing its port at 1200 baud; it obeys with its motor off only."""
    numbers = usb_numbers(board)
    ports = [one.device for one in available_ports() if (one.vid, one.pid) in numbers and port in (None, one.device)]
    if len(ports) != 1:
        return None
    tell(f"Asking {how.called} at {ports[0]} to show its drive.")
    try:
        with suppress(OSError, ValueError):  # the port leaves while it is closed
            open_port(ports[0], baudrate=1200).close()
    except PortError:  # taken, or forbidden: a person can press the button
        return None
    return _within(ASKED_WAIT, lambda: _drives(how))


def usb_numbers(board):
    """Return vendor and product of each USB device that a board may be."""
    return {(usb.vendor, usb.product) for usb in BOARDS[board].usb}


def _drives(how):
    """Return the drives of boards with this chip. A drive of another chip is named in an error: its board may be meant."""
    ids = {folder: _board_id(folder) for folder in mounted()}
    ours = [folder for folder, name in ids.items() if name == how.name]
    others = [(folder, name) for folder, name in ids.items() if name and name != how.name]
    if others and not ours:
        folder, name = others[0]
        raise PaddleError(f"{folder} is the drive of a board that calls itself {name}; {how.called} calls itself {how.name}. "
                          "Nothing was copied. Choose the board's own firmware")  # fmt: skip
    return ours


def is_drive(folder):
    """Whether a board's drive is at this folder."""
    return _board_id(folder) is not None


def _board_id(folder):
    """Return the Board-ID in a drive's INFO_UF2.TXT; None where there is none."""
    try:
        lines = (folder / INFO).read_text("ascii", "replace").splitlines()
    except OSError:
        return None
    return next((line.partition(":")[2].strip() for line in lines if line.lower().startswith("board-id:")), None)


def mounted():
    """Return the folders at which this computer shows removable drives."""
    if sys.platform == "win32":
        return [Path(f"{letter}:\\") for letter in "DEFGHIJKLMNOPQRSTUVWXYZ"]
    if sys.platform == "darwin":
        return sorted(Path("/Volumes").glob("*"))
    try:
        lines = Path("/proc/mounts").read_text().splitlines()
    except OSError:
        return []
    parts = [line.split() for line in lines]
    return sorted(Path(at.replace("\\040", " ")) for _, at, kind, *_ in parts if kind in ("vfat", "msdos"))


def _copy(content, target, progress):
    """Write a file in order; return the OSError that ended it early, or None. A board that has all leaves at once."""
    try:
        with progress_bar(len(content), progress, unit="B") as bar, open(target, "wb", buffering=0) as file:
            for at in range(0, len(content), PIECE):
                file.write(content[at : at + PIECE])
                bar.update(len(content[at : at + PIECE]))
            os.fsync(file.fileno())
    except OSError as problem:
        return problem
    return None


def _within(seconds, look):
    """Return the first true value of ``look()``, or None when the time is over."""
    end = time.monotonic() + seconds
    while not (found := look()) and time.monotonic() < end:
        time.sleep(LOOK)
    return found or None
