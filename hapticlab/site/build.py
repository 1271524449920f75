"""A site of the labs, from an empty folder to one that any web server can publish."""

from __future__ import annotations

import hashlib
import json
import shutil
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from .. import __version__
from ..course.labs import find_labs
from ..errors import CourseError
from . import licences, lite, needs, pyodide_archive, wheels
from .front_page import front_page
from .pages import PAGES, write_pages

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..base.annotations import File

#: in a site's folder: the files that were written there, which a next build may replace, and their digests, by which the first
#: page finds what a browser has to load again
RECORD = "hapticlab-site.json"


@dataclass(frozen=True)
class Site:
    """What was built."""

    folder: Path
    files: int
    size: int
    seconds: float


def build_site(
    folder: File, *, pyodide: File | None = None, wheel: File | None = None, say: Callable[[str], object] = print
) -> Site:
    """Build a site of the labs that needs nothing but a browser.

    Parameters
    ----------
    folder : str or Path
        Made where it is missing. A site of an earlier build there is replaced.
    pyodide : str or Path, optional
        Folder or packed archive of a distribution of Pyodide, from which the site takes Python, so that no request leaves
        its address. By default browsers load Python from Pyodide's own address.
    wheel : str or Path, optional
        Wheel of hapticlab, by default made of this one.
    say : callable
        Is told each step, its size and its time.

    Raises
    ------
    CourseError
        If the folder holds anything else or cannot be written, or something is missing that the labs need.
    EngineMissingError
        If JupyterLite is not installed.
    """
    folder, began = Path(folder), time.monotonic()
    lite.check_builders()
    before = written_before(folder)
    with tempfile.TemporaryDirectory() as aside:
        source, made = Path(aside, "source"), Path(aside, "site")
        (source / "pypi").mkdir(parents=True)
        sizes = _gather(source, Path(aside, "unpacked"), pyodide, wheel, say)
        lite.build(source, made)
        say(f"JupyterLite with {len(find_labs())} labs, {_megabytes(made)}")
        (made / "index.html").write_text(front_page(find_labs(), **sizes), "utf-8")
        write_pages(made)
        say(f"{len(PAGES)} pages that need no Python")
        if lacking := licences.write(made):
            say(f"without a licence text: {', '.join(lacking)}. Look for their terms before you publish the site")
        (made / ".nojekyll").touch()  # GitHub's pages would leave files out
        found = {path.relative_to(made).as_posix(): _digest(path) for path in sorted(made.rglob("*")) if path.is_file()}
        size = _size(made)
        _replace(folder, made, before, {"hapticlab": __version__, "files": found})
    return Site(folder, len(found) + 1, size, time.monotonic() - began)


def written_before(folder):
    """Return the files that an earlier build wrote into a folder; none where it is empty or missing.

    Raises
    ------
    CourseError
        If it holds anything else that is not hidden, or is inside the folder of the labs.
    """
    if folder.exists() and not folder.is_dir():
        raise CourseError(f"{folder} is a file; name a folder for the site")
    labs = find_labs()[0].path.resolve().parent
    if folder.resolve().is_relative_to(labs):
        raise CourseError(
            f"{folder} is inside {labs}, so that the next build would copy the site into itself; name another folder"
        )
    try:
        names = json.loads((folder / RECORD).read_text("utf-8"))["files"]
        return {name for name in names if not name.startswith("/") and ".." not in name.split("/")} | {RECORD}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        pass
    strange = sorted(path.name for path in folder.iterdir() if not path.name.startswith(".")) if folder.is_dir() else []
    if strange:
        raise CourseError(f"{folder} holds {strange[0]} and is not a site of an earlier build; name an empty or a new folder")
    return set()


def _gather(source, unpacked, pyodide, wheel, say):
    """Put packages, and Pyodide if it is given, where JupyterLite's builder finds them; return their sizes."""
    archive = pyodide_archive.opened(pyodide, unpacked) if pyodide is not None else None
    theirs, ours = needs.needed(set(archive.packages)) if archive else needs.needed()
    local = source / "static" / "pyodide"
    if archive:
        archive.copy(["micropip", *theirs], local)
        say(f"Pyodide of {pyodide}, {_megabytes(local)}")
    made = [
        wheels.hapticlab_wheel(source / "pypi", wheel) if name == "hapticlab" else wheels.installed_wheel(name, source / "pypi")
        for name in ours
    ]
    say(f"hapticlab and {len(made) - 1} packages that it needs, {_megabytes(source / 'pypi')}")
    lite.prepare(source, theirs, made)
    return {"local": _size(local) if archive else None, "wheels": _size(source / "pypi")}


def _replace(folder, made, before, record):
    """Copy a site into its folder; of an earlier one only what the new one lacks goes, and other files stay."""
    old = before - {RECORD, *record["files"]}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        # all names first, without digests: what is cut off on the way is a site that the same command replaces
        _write(folder, record | {"files": dict.fromkeys([*record["files"], *old])})
        shutil.copytree(made, folder, dirs_exist_ok=True)
        for name in old:
            (folder / name).unlink(missing_ok=True)
        _write(folder, record)
    except OSError as problem:
        why = problem.args[0][0][2] if isinstance(problem, shutil.Error) else problem  # which has a line for every file
        raise CourseError(f"the site could not be written to {folder}: {why}; then do the same command again") from None


def _write(folder, record):
    (folder / RECORD).write_text(json.dumps(record, indent=1) + "\n", "utf-8")


def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def _size(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def _megabytes(folder):
    return f"{_size(folder) / 1e6:.1f} MB"
