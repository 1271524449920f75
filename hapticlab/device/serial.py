"""Serial ports, opened in one place: which there are, and what is wrong when one does not open.

The only module that opens pyserial, of which it asks what its successors have too: ``serial_for_url``, ``read``,
``write``, ``in_waiting``, ``close`` and ``comports``.
"""

import errno
import glob
import os
import re
import shlex
import sys
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from ..compiler.vm import firmware_folder
from ..errors import HapticlabError, PortError

try:
    from termios import error as TerminalError  # pyserial lets it through, and it is no OSError
except ImportError:  # Windows
    TerminalError = OSError

#: pyserial looks for protocol_<scheme> in these packages
HANDLERS = "hapticlab.device.urls"
#: (vendor, product) of boards a paddle is built on, and of the USB bridges on their copies. Sources: boards.txt of
#: ArduinoCore-avr (uno), the device tables of Linux's ch341.c, cp210x.c and ftdi_sio_ids.h.
BOARDS = {
    (0x2341, 0x0043): "Arduino Uno R3",
    (0x2341, 0x0001): "Arduino Uno",
    (0x2341, 0x0243): "Genuino Uno",
    (0x2A03, 0x0043): "Arduino Uno (arduino.org)",
    (0x2341, 0x006A): "Arduino Uno Mini",
    (0x1A86, 0x7523): "CH340 (copies of the Uno and Nano)",
    (0x1A86, 0x5523): "CH341 (copies of the Uno and Nano)",
    (0x0403, 0x6001): "FT232R (Hapkit board, Nano)",
    (0x0403, 0x6015): "FT231X (copies of the Uno)",
    (0x10C4, 0xEA60): "CP210x (copies of the Uno)",
}


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
    """Return the serial ports of this computer, in the order of their names.

    Only a port whose ``known`` is not None may be opened without being asked for: another may drive a stranger's motor.

    Returns
    -------
    list of Port
    """
    from serial.tools import list_ports

    return sorted((_described(p) for p in list_ports.comports()), key=_natural)


def _described(info):
    words = "" if info.description == "n/a" else info.description or ""
    return Port(info.device, words, info.vid, info.pid, info.serial_number, BOARDS.get((info.vid, info.pid)))


def _natural(port):
    """Order COM10 after COM9."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", port.device)]


def open_port(url, *, baudrate=500000, timeout=0.05):
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

    if HANDLERS not in serial.protocol_handler_packages:
        serial.protocol_handler_packages.append(HANDLERS)
    try:
        port = serial.serial_for_url(url, baudrate=baudrate, timeout=timeout, write_timeout=1, exclusive=True)
    except HapticlabError:  # sim:// explains itself
        raise
    except (OSError, ValueError, TerminalError) as problem:
        raise PortError(*_explain(url, baudrate, problem)) from problem
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
        return port.read(max(1, port.in_waiting))


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
                f"{port.port}: the device takes no data for {port.write_timeout} s; plug it in again, then connect again",
                "silent",
            ) from problem
        raise PortError(
            f"{port.port}: the device left during use ({problem}). Its firmware stops the motor by itself; "
            "check the cable and the supply, plug it in again, then connect again",
            "left",
        ) from problem


def _explain(url, baudrate, problem):
    """Return the sentence and the cause for a port that did not open."""
    if "://" in url:
        return _explain_url(url, problem)
    code, text = _code_of(problem), str(problem)
    if code == errno.ENOENT:
        there = ", ".join(str(p) for p in available_ports())
        return f"{url}: no such port; there {f'are: {there}' if there else 'is none. Plug the board in'}", "missing"
    if code in (errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK):
        return f"{url} is taken by {_holder(url)}; close it there, then connect again{_modem_manager()}", "busy"
    if code in (errno.EACCES, errno.EPERM):
        return f"{url}: permission denied; {permission_cure()}", "permission"
    if code in (errno.ENOTTY, errno.EISDIR, errno.EINVAL, errno.ENXIO, errno.ENODEV, errno.EIO):
        return f"{url} is no serial port that answers ({text}); plug it in again, or name another port", "missing"
    if isinstance(problem, ValueError) or "baud" in text:
        return f"{url} cannot be set to {baudrate} baud ({text}); use a port that can, or another USB adapter", "settings"
    return f"{url} did not open ({text}); plug the board in again, then connect again", "failed"


def _explain_url(url, problem):
    scheme = url.split("://", 1)[0]
    if isinstance(problem, ValueError) and "protocol" in str(problem):
        return (
            f"{url}: no port speaks {scheme!r}; give a port such as {'COM3' if os.name == 'nt' else '/dev/ttyACM0'}, "
            "or sim://hapkit, or socket://host:port",
            "url",
        )
    if isinstance(problem, ValueError) or any(w in str(problem) for w in ("debug|info", "not supported between")):
        return f"{url}: not a port's address ({problem}); write it as in socket://host:port", "url"
    return f"{url}: nothing answers there ({problem}); start what should, or check the address", "refused"


def _code_of(problem):
    """Return the POSIX number of a failure.

    pyserial's Windows messages hold the error only as text, in the system's language; its numbers are in every one:
    ``PermissionError(13, 'Access is denied.', None, 5)``.
    """
    windows = re.search(r"Error\(\d+, .*, None, (\d+)\)", str(problem))
    if windows:
        # ERROR_FILE_NOT_FOUND, PATH_NOT_FOUND, ACCESS_DENIED (Windows: somebody has the port), INVALID_HANDLE (closed
        # by its driver), BAD_COMMAND, GEN_FAILURE, SHARING_VIOLATION, INVALID_PARAMETER, SEM_TIMEOUT, INVALID_NAME,
        # DEVICE_NOT_CONNECTED
        return {
            2: errno.ENOENT, 3: errno.ENOENT, 5: errno.EBUSY, 6: errno.EIO, 22: errno.EIO, 31: errno.EIO,
            32: errno.EBUSY, 121: errno.EIO, 123: errno.ENOENT, 1167: errno.EIO,
        }.get(int(windows[1]))  # fmt: skip
    number = re.search(r"\((\d+), '", str(problem))  # termios.error and pyserial's "Could not configure port: (25, ..."
    return getattr(problem, "errno", None) or (int(number[1]) if number else None)


def _holder(device):
    """Return who has a device open, as far as Linux lets this user see."""
    held = []
    for link in glob.iglob("/proc/[0-9]*/fd/*"):
        try:
            if os.path.samefile(link, device):
                number = int(link.split("/")[2])
                name = Path(f"/proc/{number}/comm").read_text("utf-8").strip()
                held.append("this very program" if number == os.getpid() else f"{name} (process {number})")
        except OSError:  # ended meanwhile, or another user's
            continue
    return " and ".join(dict.fromkeys(held)) or "another program (another notebook, the Arduino IDE's serial monitor)"


def _modem_manager():
    if not sys.platform.startswith("linux"):
        return ""
    return f". In the first seconds after plugging in it may be ModemManager, which {rules_file().name} keeps away"


def rules_file():
    """Return the udev rules: they let the user at the screen open the boards, and keep ModemManager away from them."""
    return firmware_folder() / "udev" / "60-hapticlab.rules"


def permission_cure():
    """Return what lets this user open serial ports, as one instruction for this system."""
    if not sys.platform.startswith("linux"):
        return "close every other program that uses it, and install the USB driver of the board's maker"
    group = next((g for g in ("dialout", "uucp") if _has_group(g)), "dialout")
    return (
        f"do: sudo cp {shlex.quote(str(rules_file()))} /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger, then "
        f"plug it in again; or: sudo usermod -aG {group} $USER, then log out and in"
    )


def _has_group(name):
    try:
        return any(line.startswith(f"{name}:") for line in Path("/etc/group").read_text("utf-8").splitlines())
    except OSError:
        return False
