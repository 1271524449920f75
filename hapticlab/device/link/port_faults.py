"""Why a serial port does not open, in the words of whoever has to cure it."""

import errno
import glob
import os
import re
import shlex
import sys
from pathlib import Path

from ...compiler.engines.firmware_library import firmware_folder
from ...errors import PortError
from .messages import HOST_SILENCE_MS

#: of udev, in firmware/udev
RULES = "60-hapticlab.rules"


def explain(url, baudrate, problem, ports):
    """Return the sentence and its cause for a port that did not open; ``ports`` are those there are."""
    if "://" in url:
        return _explain_url(url, problem)
    code, text = _code_of(problem), str(problem)
    if code == errno.ENOENT:
        there = ", ".join(map(str, ports))
        return f"{url}: no such port; there {f'are: {there}' if there else 'is none. Plug in the board'}", "missing"
    if code in (errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK):
        return f"{url} is in use by {_holder(url)}; close it there, then connect again{_modem_manager()}", "busy"
    if code in (errno.EACCES, errno.EPERM):
        return f"{url}: permission denied; {permission_cure()}", "permission"
    if code in (errno.ENOTTY, errno.EISDIR, errno.EINVAL, errno.ENXIO, errno.ENODEV, errno.EIO):
        return f"{url} is not a serial port that answers ({text}); plug it in again, or name a different port", "missing"
    if isinstance(problem, ValueError) or "baud" in text:
        return f"{url} cannot be set to {baudrate} baud ({text}); use a port or a USB adapter that can", "settings"
    return f"{url} did not open ({text}); plug in the board again, then connect again", "failed"


def absence_words(seconds):
    """The sentence that says why a board did not hear this program for a while."""
    return f"The computer slept, or this program was stopped or too busy, for {seconds:.2g} s"


def slept(url, seconds):
    """Return the PortError of a port that went while this program did not run."""
    return PortError(
        f"{url}: HOST_SILENT: {absence_words(seconds).lower()}, and the port is gone. The board switched its motor off after "
        f"{HOST_SILENCE_MS} ms without the computer. Connect again; if there is no answer, plug the board in again",
        "slept",
    )


def _explain_url(url, problem):
    scheme = url.split("://", 1)[0]
    if isinstance(problem, ValueError) and "protocol" in str(problem):
        return (
            f"{url}: the scheme {scheme!r} is not known; give a port such as {'COM3' if os.name == 'nt' else '/dev/ttyACM0'}, "
            "or sim://hapkit, or socket://host:port",
            "url",
        )
    if isinstance(problem, ValueError) or any(w in str(problem) for w in ("debug|info", "not supported between")):
        return f"{url}: not the address of a port; write it like socket://host:port", "url"
    return f"{url}: no program answers there ({problem}); start it, or check the address", "refused"


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
    return f". In the first seconds after plugging in, this may be ModemManager; {RULES} keeps it away"


def rules_file():
    """Return the udev rules: they let the user at the screen open the boards, and keep ModemManager away from them."""
    return firmware_folder() / "udev" / RULES


def permission_cure():
    """The right to open serial ports, as one instruction for this system."""
    if not sys.platform.startswith("linux"):
        return "close every other program that uses it, and install the USB driver of the board's maker"
    group = next((g for g in ("dialout", "uucp") if _has_group(g)), "dialout")
    rules = shlex.quote(str(rules_file()))
    return (
        f"do, then plug it in again:\nsudo cp {rules} /etc/udev/rules.d/ "
        "&& sudo udevadm control --reload && sudo udevadm trigger\n"
        f"or, then log out and in:\nsudo usermod -aG {group} $USER"
    )


def _has_group(name):
    try:
        return any(line.startswith(f"{name}:") for line in Path("/etc/group").read_text("utf-8").splitlines())
    except OSError:
        return False
