"""Which exercises of a lab were right when last checked: kept in a file beside the notebook, and no part of any mark."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from pathlib import Path

#: its name begins with a point, so that it is not handed in
FILE = ".hapticlab-progress.json"
#: of folders that cannot be written: what this session knows
_UNWRITTEN: dict[Path, dict[str, list[str]]] = {}


def remember(folder: Path, lab: str, exercise: str, right: bool) -> list[str]:
    """Write down how an exercise was at its last check, and return those of its lab that are right.

    Nothing is raised where the folder cannot be written, or the file not read: the session remembers, or begins again.

    Parameters
    ----------
    folder : Path
        Of the notebook.
    lab, exercise : str
        Number and name.
    right : bool

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = remember(Path(folder), "02", "held_work", True), remember(Path(folder), "02", "two_walls", True)
    ...     remember(Path(folder), "02", "held_work", False)
    ['two_walls']
    """
    path = folder / FILE
    known = _UNWRITTEN.get(path) or _read(path)
    names = set(known.get(lab, ())) - {exercise} | ({exercise} if right else set())
    known[lab] = sorted(names)
    _write(path, known)
    return known[lab]


def _read(path):
    """Return number of a lab to names, of what the file holds of them; anybody may have written it."""
    try:
        held = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    held = held if isinstance(held, dict) else {}
    return {lab: [name for name in names if isinstance(name, str)] for lab, names in held.items() if isinstance(names, list)}


def _write(path, known):
    """Put a whole file in the place of the old one, so that no other notebook reads half of it."""
    fresh = path.with_name(f"{path.name}.{os.getpid()}")
    try:
        fresh.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n", "utf-8")
        fresh.replace(path)
        _UNWRITTEN.pop(path, None)
    except OSError:
        _UNWRITTEN[path] = known
        with suppress(OSError):
            fresh.unlink(missing_ok=True)
