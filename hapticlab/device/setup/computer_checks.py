"""The doctor's first steps: this computer, before any port is opened."""

import os
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ...base.in_notebook import is_in_browser
from ..link.port_faults import RULES, permission_cure
from .doctor_checks import Check

#: where udev reads rules from
UDEV = ("/etc/udev/rules.d", "/run/udev/rules.d", "/usr/local/lib/udev/rules.d", "/usr/lib/udev/rules.d", "/lib/udev/rules.d")
#: groups that may open serial ports, by distribution
GROUPS = ("dialout", "uucp")


def notebook():
    """Whether the labs and the live view have what they need here."""
    in_browser, missing, found = is_in_browser(), [], []
    needed = ("ipywidgets", "anywidget") if in_browser else ("jupyterlab", "ipywidgets", "anywidget")
    for name in needed:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            missing.append(name)
    if missing:
        words = f"{', '.join(missing)} not installed; needed for the labs, hl.live and hl.stability.explore"
        pip = "in a cell: %pip" if in_browser else f"do: {Path(sys.executable).name} -m pip"
        return Check("notebook", "attention", words, f"{pip} install {' '.join(missing)}")
    return Check("notebook", "ok", ", ".join(found))


def rights(url=None, platform=sys.platform):
    """Whether this user may open serial ports, and what else this system is known to put in the way.

    Parameters
    ----------
    url : str, optional
        The port that was named.
    platform : str
        As ``sys.platform``.
    """
    if platform == "emscripten":
        return Check("rights", "ok", "Python in a browser needs none; it opens simulated paddles alone")
    if platform.startswith("linux"):
        return _linux_rights()
    if platform == "darwin":
        if (url or "").startswith("/dev/tty."):
            return Check("rights", "fault", f"{url} waits for a modem", f"name {url.replace('/tty.', '/cu.')} instead")
        return Check("rights", "ok", "macOS needs none; of the two names of a port, use the one with cu.")
    return Check(
        "rights",
        "ok",
        "Windows needs none, but only one program at a time can open a port (close other notebooks and the serial monitor)",
    )


def _linux_rights():
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        return Check("rights", "ok", "root may open every port")
    if any((Path(folder) / RULES).is_file() for folder in UDEV):
        return Check("rights", "ok", f"{RULES} allows the user at this screen to open the boards, and keeps ModemManager away")
    held, listed = _groups()
    if held:
        return Check("rights", "ok", f"this user is in {held}; {RULES} would also keep ModemManager away")
    if listed:
        cure = "log out and in again, or restart, because a new group takes effect at login"
        return Check(
            "rights", "attention", f"this user was added to {listed}, but the group takes effect at the next login", cure
        )
    return Check("rights", "attention", f"neither {RULES} nor a group lets this user open serial ports", permission_cure())


def _groups():
    """Return the group for serial ports that this login has, and the one the user was added to; None for none."""
    import grp
    import pwd

    user, mine = pwd.getpwuid(os.getuid()).pw_name, {os.getegid(), *os.getgroups()}
    held = listed = None
    for group in grp.getgrall():
        if group.gr_name in GROUPS:
            held = group.gr_name if group.gr_gid in mine else held
            listed = group.gr_name if user in group.gr_mem else listed
    return held, listed
