"""`hapticlab doctor --self-test`: run all checks, write the file that is to be sent, and say where it is."""

import getpass
import json
import os
import platform
import re
import sys
import tempfile
from contextlib import suppress
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path

from .. import __version__
from ..base.in_notebook import require_processes
from .all_checks import walk
from .outcome import ATTENTION, FAULT
from .table import CHECKS

ABOUT = (
    "What `hapticlab doctor --self-test` found on this computer. Send this file to the person who asked for it, or attach it to "
    "a report of a problem. It names the system, the packages and what each check found. The names of the user and of the "
    "computer were replaced by USER and COMPUTER, and the user's folder by HOME."
)


#: letters of a name that is replaced anywhere; a shorter one may be part of what is told, and is replaced in paths only
LEAST = 4


def self_test(parser, options):
    """Run all checks, write the file, and say where it is; 1 if anything is a fault."""
    require_processes("The self-test")
    file = Path(options.out).resolve()
    try:
        with file.open("a", encoding="utf-8"):  # a file that cannot be written is told before two minutes are spent
            pass
    except OSError as problem:
        raise OSError(problem.errno, f"{problem.strerror}; choose another file with --out", str(file)) from None
    print(f"{len(CHECKS)} checks; they take up to two minutes\n", flush=True)
    found = walk(CHECKS, tell=lambda outcome: print(without_names(str(outcome)), flush=True))
    file.write_text(written(found), "utf-8")
    faults, notes = (sum(outcome.state == state for outcome in found) for state in (FAULT, ATTENTION))
    print(f"\n{len(found) - faults - notes} checks ok, {notes} need attention, {faults} found a fault.")
    print(f"The result is in {file}\nPlease send this one file to the person who asked for it; you can read it in any editor.")
    return int(faults > 0)


def written(found):
    """Return the text of the file: JSON that a person can read."""
    facts = {
        "about": ABOUT,
        "hapticlab": __version__,
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "system": {
            "platform": platform.platform(),
            "machine": platform.machine(),
            "python": f"{platform.python_implementation()} {platform.python_version()}, {sys.maxsize.bit_length() + 1} bit",
            "processors": os.cpu_count(),
            "virtual environment": sys.prefix != sys.base_prefix,
            "encodings": f"files {sys.getfilesystemencoding()}, console {sys.stdout.encoding}, UTF-8 mode {sys.flags.utf8_mode}",
        },
        "checks": [asdict(outcome) | {"found": outcome.found.splitlines()} for outcome in found],
    }
    return without_names(json.dumps(facts, indent=1, ensure_ascii=False)) + "\n"


def without_names(text):
    """Return a text in which the user's folder, and the names of the user and of the computer, are replaced.

    Folders are found with either slash, doubled as JSON has them, in capitals or small letters, and in the short form of
    Windows, ``ADALOV~1``.

    Examples
    --------
    >>> without_names(f"File {Path.home()}/labs/wall.py").replace("\\\\", "/")
    'File HOME/labs/wall.py'
    """
    folders = {str(Path.home()): "HOME", os.path.realpath(tempfile.gettempdir()): "TEMP", tempfile.gettempdir(): "TEMP"}
    for folder, name in sorted(folders.items(), key=lambda pair: -len(pair[0])):
        slashes = r"(?:\\\\|\\|/)"
        spelt = slashes.join(re.escape(part) for part in re.split(r"[\\/]", folder.rstrip("\\/")))
        text = re.sub(rf"{spelt}(?!\w)", name, text, flags=re.IGNORECASE) if folder.strip("\\/") else text
    for name, instead in ((_user(), "USER"), (platform.node(), "COMPUTER"), (platform.node().split(".")[0], "COMPUTER")):
        if name:
            before = r"(?<!\w)" if len(name) >= LEAST else r"(?<=[\\/])"
            short = re.escape(re.sub(r"[ .]", "", name)[:6])
            text = re.sub(rf"{before}(?:{re.escape(name)}|{short}~\d)(?!\w)", instead, text, flags=re.IGNORECASE)
    return text


def _user():
    with suppress(OSError, KeyError, ImportError):  # a system may have no name for who is logged in
        return getpass.getuser()
    return ""
