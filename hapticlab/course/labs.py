"""The labs: where they are, the checks beside each, and copies of them, which lose nothing that was changed."""

from __future__ import annotations

import hashlib
import itertools
import json
import re
import runpy
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import CourseError
from .exercise import Lab

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..base.annotations import File

PACKAGE = Path(__file__).resolve().parents[1]
#: of a wheel, and of a checkout
PLACES = (PACKAGE / "labs", PACKAGE.parent / "labs")
CHECKS = "checks.py"
#: beside the copies: path to SHA-256 of what came with the package, which tells what somebody changed since
RECORD = ".hapticlab-labs.json"


@dataclass(frozen=True)
class LabFolder:
    """A lab's folder, NN_name, with its notebook and its public checks."""

    path: Path

    @property
    def name(self) -> str:
        """NN_name."""
        return self.path.name

    @property
    def number(self) -> str:
        """Its two digits, as text."""
        return self.name[:2]

    @property
    def notebook(self) -> Path:
        """The student's notebook."""
        return self.path / f"{self.name}.ipynb"

    def lab(self) -> Lab:
        """Return the Lab that its checks define."""
        lab = load_lab(self.path / CHECKS)
        if lab.number != self.number:
            raise CourseError(f"{self.path / CHECKS}: LAB has number {lab.number!r}; its folder begins with {self.number}")
        return lab


def load_lab(path: File) -> Lab:
    """Return the Lab of a file of checks."""
    try:
        lab = runpy.run_path(str(path)).get("LAB")
    except (Exception, SystemExit) as problem:
        raise CourseError(f"{path} failed: {type(problem).__name__}: {problem}") from None
    if not isinstance(lab, Lab):
        raise CourseError(f"{path} defines no LAB; it needs LAB = Lab(number=..., title=..., minutes=..., exercises=(...))")
    return lab


def labs_folder() -> Path:
    """Return the folder of the labs that came with the package."""
    for place in PLACES:
        if place.is_dir():
            return place
    raise CourseError(f"no labs in {' or '.join(map(str, PLACES))}; install hapticlab again")


def copy_labs(target: File, only: Sequence[str] = ()) -> dict[str, str]:
    """Copy the student's labs into a folder; what somebody changed there stays as it is.

    In a folder that has labs, those that were deleted stay away, unless ``only`` names them. A ``checks.py`` that is as it
    once came, and differs from the package's, is brought up to date: it judges, and holds nobody's work.

    Parameters
    ----------
    target : str or Path
        Made where it is missing.
    only : sequence of str
        Numbers of labs, ``("02", "03")``; by default all, or those that are there already.

    Returns
    -------
    dict of str to str
        Path in the folder to what happened: "new", "as it came", "renewed" (the old one is beside it), or "kept" where it
        differs from what came with the package, as a student's own work does.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     first, again = copy_labs(folder, only=["02"]), copy_labs(folder)
    >>> set(first.values()), set(again.values()), len(again)
    ({'new'}, {'as it came'}, 3)
    """
    source, target = labs_folder(), Path(target)
    if target.exists() and not target.is_dir():
        raise CourseError(f"{target} is a file; name a folder for the labs")
    if source.resolve() in (target.resolve(), *target.resolve().parents):
        inside = "" if target.resolve() == source.resolve() else "inside the folder "
        raise CourseError(f"{target} is {inside}where the labs come from; give a different folder for your own copy")
    left_out = {lab.name for lab in find_labs(source)} - _chosen(target, only)
    paths = [path for path in _files(source) if path.parts[0] not in left_out]
    try:
        return _copied_all(source, target, paths)
    except OSError as problem:
        raise CourseError(
            f"cannot write {problem.filename or target}: {problem.strerror or problem}; the files before it are copied. "
            "Give a folder of your own, such as: hapticlab labs my-labs"
        ) from None


def _chosen(target, only):
    """Return the names of the labs to copy."""
    named = {lab.number: lab.name for lab in find_labs()}
    strange = [number for number in only if number not in named]
    if strange:
        raise CourseError(f"there is no lab {strange[0]}; there are {', '.join(named) or 'none'}")
    if only:
        return {named[number] for number in only}
    there = {path.name for path in target.glob("[0-9][0-9]_*")}
    return {*named.values()} & there if there else {*named.values()}


def _files(source):
    """Return the files of the labs, by their paths in the folder; none that Python or Jupyter made."""
    paths = (path.relative_to(source) for path in sorted(source.rglob("*")) if path.is_file())
    return [path for path in paths if not any(part.startswith((".", "__")) for part in path.parts)]


def _copied_all(source, target, paths):
    """Copy files, and write down what came."""
    target.mkdir(parents=True, exist_ok=True)
    came, states = _record(target), {}
    for path in paths:
        name = path.as_posix()
        states[str(path)] = _copied(source / path, target / path, came.get(name))
        if states[str(path)] != "kept":
            came[name] = _hash((source / path).read_bytes())
    text = json.dumps(came, indent=1, sort_keys=True) + "\n"
    if not (target / RECORD).is_file() or (target / RECORD).read_text("utf-8") != text:
        (target / RECORD).write_text(text, "utf-8")
    return states


def _record(target):
    """The record of the files that came, empty where it cannot be read."""
    try:
        return dict(json.loads((target / RECORD).read_text("utf-8")))
    except (OSError, ValueError, TypeError):
        return {}


def _hash(content):
    return hashlib.sha256(content).hexdigest()


def _copied(source, target, came):
    """Copy a file to where there is none; of what is there, checks that are as they came make way and are kept beside."""
    target.parent.mkdir(parents=True, exist_ok=True)
    content, state = source.read_bytes(), "new"
    if source.name == CHECKS and target.is_file() and _hash(target.read_bytes()) == came != _hash(content):
        target.rename(_free(target.with_name(f"{CHECKS}.old")))
        state = "renewed"
    try:
        with target.open("xb") as file:
            file.write(content)
        return state
    except FileExistsError:
        return "as it came" if target.is_file() and target.read_bytes() == content else "kept"


def _free(path):
    """Return the path, or one like it where that is taken."""
    several = itertools.chain([path], (path.with_name(f"{path.name}{number}") for number in itertools.count(2)))
    return next(one for one in several if not one.exists())


def incomplete_labs(folder: File) -> list[str]:
    """Return the names of folders that look like a lab's, NN_name, and lack its notebook or its checks."""
    whole = {lab.name for lab in find_labs(folder)}
    return [path.name for path in sorted(Path(folder).glob("[0-9][0-9]_*")) if path.is_dir() and path.name not in whole]


def find_labs(folder: File | None = None) -> list[LabFolder]:
    """Return the labs in a folder, by default those that came with the package, in their order."""
    folder = labs_folder() if folder is None else Path(folder)
    found = [LabFolder(path) for path in sorted(folder.glob("[0-9][0-9]_*"))]
    return [lab for lab in found if lab.notebook.is_file() and (lab.path / CHECKS).is_file()]


def find_lab(number: str, beside: File | None = None) -> Lab:
    """Return the lab of a number: the one whose checks lie in the folder ``beside``, else the one that came with the package.

    Examples
    --------
    >>> find_lab("99")
    Traceback (most recent call last):
        ...
    hapticlab.errors.CourseError: there is no lab 99; there are ...
    """
    checks = None if beside is None else Path(beside) / CHECKS
    if checks is not None and checks.is_file() and re.search(r"^LAB\b", checks.read_text("utf-8", "replace"), re.M):
        lab = load_lab(checks)
        if lab.number == number:  # whatever its folder is called
            return lab
    found = find_labs()
    for folder in found:
        if folder.number == number:
            return folder.lab()
    raise CourseError(f"there is no lab {number}; there are {', '.join(f.name for f in found) or 'none'}")
