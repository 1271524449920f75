"""Checks of the computer itself: Python, packages, clocks, consoles and serial ports."""

import os
import re
import subprocess
import sys
import time
from importlib.metadata import PackageNotFoundError, requires, version
from statistics import median

from ..device.link.serial_ports import available_ports
from .outcome import Attention, need

#: s: what a clock must resolve for a link to be timed
COARSE = 1e-4
#: characters that most consoles of Windows cannot write
ODD = "Wände-µ-壁"
CONSOLES = ("cp1252", "ascii")
SCENE = "import hapticlab as hl\nscene, duration = hl.wall()(k=150, x_o=0.01), 0.05\n"


def packages(folder):
    """Return the versions of Python and of what hapticlab needs or can use; one that it needs must be there."""
    needed, optional, missing = [], [], []
    for line in requires("hapticlab") or []:
        name, extra = re.match(r"[\w.-]+", line)[0], "extra ==" in line
        try:
            (optional if extra else needed).append(f"{name} {version(name)}")
        except PackageNotFoundError:
            if not extra and ";" not in line:
                missing.append(name)
    need(not missing, f"hapticlab needs {', '.join(missing)}, which is not installed")
    besides = sorted({*optional} - {*needed})
    return f"Python {sys.version}\nneeded: {', '.join(sorted({*needed}))}\nin addition: {', '.join(besides) or 'none'}"


def clocks(folder):
    """Resolution of the clock, and how late a sleep of 1 ms ends."""
    steps, late = [], []
    for _ in range(200):
        begun = now = time.perf_counter()
        while now == begun:
            now = time.perf_counter()
        steps.append(now - begun)
    for _ in range(30):
        begun = time.perf_counter()
        time.sleep(1e-3)
        late.append(time.perf_counter() - begun)
    found = f"the clock steps by {min(steps) * 1e6:.2g} us; a sleep of 1 ms takes {median(late) * 1e3:.2f} ms (median)"
    if min(steps) > COARSE:
        raise Attention(f"{found}; measured times of the link will be coarse")
    return found


def consoles(folder):
    """Run a scene file on consoles that cannot write its name; the command must go on."""
    odd = folder / f"{ODD}.py"
    odd.write_text(SCENE, "utf-8")
    for encoding in CONSOLES:
        environment = os.environ | {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}
        call = [sys.executable, "-P", "-m", "hapticlab", "run", str(odd), "--out", str(folder / encoding)]
        done = subprocess.run(call, capture_output=True, env=environment, cwd=folder, stdin=subprocess.DEVNULL)
        said = (done.stdout + done.stderr).decode(encoding, "replace")
        need(done.returncode == 0, f"on a console of {encoding} `hapticlab run` ended with {done.returncode}: {said}")
    files, console = sys.getfilesystemencoding(), getattr(sys.stdout, "encoding", None)
    return f"{' and '.join(CONSOLES)} work. Here names of files are {files}, and redirected output is {console}"


def ports(folder):
    """Number of serial ports, and the known boards among them; never the names of other ports."""
    found = available_ports()
    known = ", ".join(port.known for port in found if port.known) or "no known board"
    return f"{len(found)} listed: {known}"
