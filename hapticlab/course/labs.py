"""The labs: where they are, the checks beside each, and copies of them, which overwrite nothing."""

import runpy
from dataclasses import dataclass
from pathlib import Path

from ..errors import CourseError
from .exercise import Lab

PACKAGE = Path(__file__).resolve().parents[1]
#: of a wheel, and of a checkout
PLACES = (PACKAGE / "labs", PACKAGE.parent / "labs")
CHECKS = "checks.py"


@dataclass(frozen=True)
class LabFolder:
    """A lab's folder, NN_name, with its notebook and its public checks."""

    path: Path

    @property
    def name(self):
        """NN_name."""
        return self.path.name

    @property
    def number(self):
        """Its two digits, as text."""
        return self.name[:2]

    @property
    def notebook(self):
        """The student's notebook."""
        return self.path / f"{self.name}.ipynb"

    def lab(self):
        """Return the Lab that its checks define."""
        return load_lab(self.path / CHECKS)


def load_lab(path):
    """Return the Lab of a file of checks."""
    try:
        lab = runpy.run_path(str(path)).get("LAB")
    except Exception as problem:
        raise CourseError(f"{path} failed: {type(problem).__name__}: {problem}") from None
    if not isinstance(lab, Lab):
        raise CourseError(f"{path} defines no LAB; it needs LAB = Lab(number=..., title=..., minutes=..., exercises=(...))")
    return lab


def labs_folder():
    """Return the folder of the labs that came with the package."""
    for place in PLACES:
        if place.is_dir():
            return place
    raise CourseError(f"no labs in {' or '.join(map(str, PLACES))}; install hapticlab anew")


def copy_labs(target):
    """Copy the student's labs into a folder; a file that is there already stays as it is.

    Parameters
    ----------
    target : str or Path
        Made where it is missing.

    Returns
    -------
    dict of str to str
        Path in the folder to what happened: "new", "as it came", or "kept" where it differs from what came with the
        package, as a student's own work does.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     first, again = copy_labs(folder), copy_labs(folder)
    >>> set(first.values()), set(again.values())
    ({'new'}, {'as it came'})
    """
    source, target = labs_folder(), Path(target)
    if target.exists() and not target.is_dir():
        raise CourseError(f"{target} is a file; name a folder for the labs")
    if source.resolve() in (target.resolve(), *target.resolve().parents):
        inside = "" if target.resolve() == source.resolve() else "inside the folder "
        raise CourseError(f"{target} is {inside}where the labs come from; name another, for your own copy")
    return {str(path): _copied(source / path, target / path) for path in _files(source)}


def _files(source):
    """Return the files of the labs, by their paths in the folder; none that Python or Jupyter made."""
    paths = (path.relative_to(source) for path in sorted(source.rglob("*")) if path.is_file())
    return [path for path in paths if not any(part.startswith((".", "__")) for part in path.parts)]


def _copied(source, target):
    """Copy a file to where there is none; what is there is never opened for writing."""
    target.parent.mkdir(parents=True, exist_ok=True)
    content = source.read_bytes()
    try:
        with target.open("xb") as file:
            file.write(content)
        return "new"
    except FileExistsError:
        return "as it came" if target.is_file() and target.read_bytes() == content else "kept"


def find_labs(folder=None):
    """Return the labs in a folder, by default those that came with the package, in their order."""
    folder = labs_folder() if folder is None else Path(folder)
    found = [LabFolder(path) for path in sorted(folder.glob("[0-9][0-9]_*"))]
    return [lab for lab in found if lab.notebook.is_file() and (lab.path / CHECKS).is_file()]


def find_lab(number, beside=None):
    """Return the lab of a number: the one whose checks lie in the folder ``beside``, else the one that came with the package.

    Examples
    --------
    >>> find_lab("99")
    Traceback (most recent call last):
        ...
    hapticlab.errors.CourseError: there is no lab 99; there are ...
    """
    if beside is not None and (Path(beside) / CHECKS).is_file() and Path(beside).resolve().name.startswith(f"{number}_"):
        return load_lab(Path(beside) / CHECKS)
    found = find_labs()
    for folder in found:
        if folder.number == number:
            return folder.lab()
    raise CourseError(f"there is no lab {number}; there are {', '.join(f.name for f in found) or 'none'}")
