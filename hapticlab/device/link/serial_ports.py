"""Serial ports, opened in one place: which there are, and what is wrong when one does not open.

The only module that opens pyserial, which opens ``urls``. It asks of it what its successors have too: ``serial_for_url``,
``read``, ``write``, ``in_waiting``, ``close`` and ``comports``.
"""

import os
import re
from contextlib import contextmanager, suppress
from dataclasses import dataclass

from ...base.in_notebook import is_in_browser
from ...base.profile.profile_file import SUFFIX
from ...compiler.boards.board_records import BOARDS
from ...errors import HapticlabError, PortError
from .port_faults import explain

try:
    from termios import error as TerminalError  # pyserial lets it through, and it is no OSError
except ImportError:  # Windows
    TerminalError = OSError  # type: ignore[assignment, misc]

#: pyserial looks for protocol_<scheme> in these packages
HANDLERS = "hapticlab.device.urls"
#: of every board
BAUDRATE = 500000
#: bytes that are worth waking a reader for at once: two samples
ENOUGH = 64
#: an environment variable; where it is "sim", as while grading, nobody's hand is at the handle and no other port opens
PORTS = "HAPTICLAB_PORTS"
#: (vendor, product) of boards a paddle is built on, and of the USB bridges on their copies
KNOWN = {(usb.vendor, usb.product): usb.words for board in BOARDS.values() for usb in board.usb}


#: what somebody can do whose Python a browser runs
IN_A_BROWSER = (
    'Python in a browser cannot open serial ports. Use a simulated paddle: hl.connect("sim://hapkit") runs its firmware, and '
    'hl.SimulatedPaddle.from_profile("hapkit") needs none. For a real paddle, install hapticlab on a computer (pip '
    "install hapticlab), or open paddle.html of a site made by `hapticlab site`, a page that needs no Python"
)


@dataclass(frozen=True)
class Port:
    """A serial port of this computer; ``known`` names the kind of board, or is None for a stranger's device."""

    device: str
    description: str = ""
    vid: int | None = None
    pid: int | None = None
    serial_number: str | None = None
    known: str | None = None

    def __str__(self):
        return f"{self.device} ({self.known or self.description or 'unknown'})"


def available_ports():
    """Return the serial ports of this computer, in the order of their names; none where a browser runs this Python.

    Only a port whose ``known`` is not None may be opened without being asked for: another may drive a stranger's motor.

    Returns
    -------
    list of Port
    """
    if is_in_browser():
        return []
    try:
        from serial.tools import list_ports
    except ImportError:  # pyserial cannot list those of this system; they open by name
        return []
    return sorted((_described(p) for p in list_ports.comports()), key=_natural)


def _described(info):
    words = "" if info.description == "n/a" else info.description or ""
    return Port(info.device, words, info.vid, info.pid, info.serial_number, KNOWN.get((info.vid, info.pid)))


def _natural(port):
    """Order COM10 after COM9."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", port.device)]


def open_port(url, *, baudrate=BAUDRATE, timeout=0.05):
    """Open a serial port, for this program alone, and return pyserial's object.

    Parameters
    ----------
    url : str
        A port (``COM3``, ``/dev/ttyACM0``) or a URL: ``sim://hapkit``, ``socket://host:port``, any of pyserial's.
    baudrate : int
    timeout : float, s
        The longest a read waits.

    Raises
    ------
    PortError
        Always with what to do; its ``cause`` is one word.
    """
    import serial

    if not isinstance(url, str) or not url:
        raise PortError(
            f'{url!r} is not a port; needs its name or address as text: "COM3", "/dev/ttyACM0", "sim://hapkit"', "url"
        )
    if os.environ.get(PORTS) == "sim" and not url.lower().startswith("sim://"):
        raise PortError(
            f"{url}: {PORTS}=sim allows simulated paddles only, for example while a notebook is graded. Use sim://hapkit "
            "there, or unset it for a real paddle with a person at the handle",
            "refused",
        )
    if url.lower().endswith(SUFFIX) and "://" not in url:
        raise PortError(
            f'{url} is a file and not a port. If it holds a profile, open "sim://{url}", a simulated board with it', "url"
        )
    if is_in_browser() and not url.lower().startswith("sim://"):
        raise PortError(f"{url}: {IN_A_BROWSER}", "missing")
    if HANDLERS not in serial.protocol_handler_packages:
        serial.protocol_handler_packages.append(HANDLERS)
    try:
        port = serial.serial_for_url(url, baudrate=baudrate, timeout=timeout, write_timeout=1, exclusive=True)
    except HapticlabError:  # sim:// explains itself
        raise
    except (OSError, ValueError, TerminalError) as problem:
        raise PortError(*explain(url, baudrate, problem, available_ports())) from problem
    with suppress(AttributeError, NotImplementedError, ValueError, OSError):  # Linux, and drivers that have it
        port.set_low_latency_mode(True)
    return port


def read_available(port):
    """Return the bytes that have come, after waiting for the first as long as the port's timeout.

    One byte is asked for where none has come, so that a reader wakes with the first and never waits for a full buffer.

    Raises
    ------
    PortError
        If the device left.
    """
    with port_watched(port):
        waiting = port.in_waiting
        data = port.read(max(1, waiting))
        while waiting == 1 and len(data) < ENOUGH:  # socket:// says 1 however many wait
            waiting = port.in_waiting
            data += port.read(waiting) if waiting else b""
        return data


@contextmanager
def port_watched(port):
    """Turn what pyserial raises about an open port into a PortError."""
    try:
        yield
    except (OSError, TypeError, TerminalError) as problem:
        if not port.is_open:  # closed meanwhile, by another thread or by a with: pyserial then stumbles over None
            raise PortError(f"{port.port} is closed; connect again", "left") from problem
        if isinstance(problem, TypeError):
            raise
        if "timeout" in str(problem).lower():
            raise PortError(
                f"{port.port}: the device accepted no data for {port.write_timeout} s; plug it in again, then connect again",
                "silent",
            ) from problem
        raise PortError(
            f"{port.port}: the device disconnected during use ({problem}). Check its cable and supply, plug it in again, "
            "then connect again",
            "left",
        ) from problem
