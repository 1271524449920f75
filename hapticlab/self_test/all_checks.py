"""The walk through all checks: each in a Python of its own, with a limit of time."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

from .outcome import ATTENTION, FAULT, Outcome

#: s for all checks together
ALL = 115.0
#: characters of what a check that ended early had printed
SHOWN = 2000


def walk(checks, tell=print, limit=ALL):
    """Run checks one after another, and return an Outcome for each.

    Parameters
    ----------
    checks : sequence of Check
    tell : callable
        Called with every Outcome as it is known.
    limit : float
        For all together [s]; checks that this leaves no time for are not run, and say so.
    """
    end, found = time.monotonic() + limit, []
    for check in checks:
        left = end - time.monotonic()
        outcome = alone(check, min(check.seconds, left)) if left > 1 else _late(check, limit)
        tell(outcome)
        found.append(outcome)
    return found


def _late(check, limit):
    return Outcome(
        check.name,
        check.shows,
        ATTENTION,
        f"not run, because the earlier checks used the {limit:g} s that all checks have together",
    )


def alone(check, seconds):
    """Run one check in a process and a folder of its own; whatever it does, return an Outcome."""
    begun = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="hapticlab-", ignore_cleanup_errors=True) as place:
        folder, answer, said = Path(place, "folder"), Path(place, "answer.json"), Path(place, "said.txt")
        folder.mkdir()
        call = [sys.executable, "-P", "-m", "hapticlab.self_test", check.function, str(answer)]
        with said.open("wb") as output:  # into a file, as a pipe stays open as long as any process that was left behind
            process = subprocess.Popen(
                call, cwd=folder, stdin=subprocess.DEVNULL, stdout=output, stderr=output, start_new_session=True
            )
            ended = _wait(process, seconds)
        state, found = _read(answer, said, ended, seconds)
    return Outcome(check.name, check.shows, state, found, round(time.monotonic() - begun, 2))


def _wait(process, seconds):
    """Return the exit code, or None of a process that had to be ended; nothing that it started is left."""
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        return None
    finally:
        if os.name == "nt":
            if process.returncode is None:
                subprocess.run(["taskkill", "/F", "/T", "/PID", str(process.pid)], capture_output=True, check=False)
        else:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _read(answer, said, ended, seconds):
    """Return state and finding of a process that ended by itself with this code, or None was ended after so many seconds."""
    if ended is None:
        how = f"it did not end within {seconds:.0f} s"
    elif answer.is_file():
        told = json.loads(answer.read_text("utf-8"))
        return told["state"], told["found"]
    else:
        how = f"its process ended with code {ended} before it gave an answer"
    return FAULT, f"{how}; it had printed: {said.read_bytes().decode('utf-8', 'replace')[-SHOWN:].strip() or 'nothing'}"
