"""What a class was asked: a lab, the answers to it, and the cases of each student."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from .. import __version__
from ..course.exercise import Lab
from ..course.instructor import check_tree
from ..course.labs import CHECKS, LabFolder, find_labs
from ..course.marks import SOLUTION, counted_cases, hidden_cases, instructor_names
from ..course.notebook import code_of, read
from ..course.variants import slips
from ..errors import CourseError

if TYPE_CHECKING:
    from ..base.annotations import File
    from ..course.exercise import Case


@dataclass(frozen=True)
class Assignment:
    """A lab as it is graded.

    Parameters
    ----------
    lab : Lab
    folder : LabFolder
    answers : Path or None
        The lab's folder in an instructor's tree; None grades by the public cases alone.
    seed : int
        Of the hidden cases.
    personal : bool
        Whether each student was handed a notebook with numbers of their own.
    """

    lab: Lab
    folder: LabFolder
    answers: Path | None = None
    seed: int = 0
    personal: bool = False

    def cases(self, student: str) -> dict[str, tuple[tuple[Case, bool], ...]]:
        """Return the cases of a student: exercise to ``((case, public), ...)``, public ones first.

        See :func:`hapticlab.course.marks.counted_cases`.
        """
        hidden = {}
        if self.answers is not None:
            hidden = hidden_cases(self.lab, self.answers, self.seed, student, self.personal)
        return {one.name: counted_cases(one, hidden) for one in self.lab.exercises if one.judged}

    def files(self) -> dict[str, bytes]:
        """Files beside the notebook while it runs, name to bytes: the lab's data, never what judges it."""
        paths = files_of(self.folder.path)
        return {name: path.read_bytes() for name, path in paths.items() if path.suffix != ".ipynb" and path.name != CHECKS}

    def slips(self, exercise, given):
        """Answers that typical slips give in a case, as far as they can be worked out from the solution."""
        if self.answers is None or self.personal or exercise.kind not in ("expression", "scene"):
            return ()
        public = [case.given for case in exercise.cases]
        key = (exercise.name, public.index(given)) if given in public else None
        if key not in self._public_slips:
            found = slips(exercise, instructor_names(self.answers / SOLUTION)[exercise.name], given)
            if key is None:
                return found
            self._public_slips[key] = found
        return self._public_slips[key]

    @cached_property
    def _public_slips(self):
        """Slips of public cases, which are those of a whole class."""
        return {}

    @cached_property
    def untouched(self) -> tuple[str, ...]:
        """The code cells of the lab's own notebook."""
        return tuple(code_of(read(self.folder.notebook)))

    @cached_property
    def digest(self) -> str:
        """SHA-256 of all that a mark depends on beside the submission: lab, answers, seed, hapticlab's version."""
        found = hashlib.sha256(f"{__version__} {self.seed} {self.personal} {self.folder.name}".encode())
        for folder in (self.folder.path, *([self.answers] if self.answers else [])):
            for name, path in files_of(folder).items():
                content = path.read_bytes()
                found.update(f"{name} {len(content)} ".encode() + content)
        return found.hexdigest()


def find_assignment(lab: File, instructor: File | None = None, seed: int = 0, personal: bool = False) -> Assignment:
    """Return the assignment of a lab.

    Parameters
    ----------
    lab : str or Path
        Number of a lab that came with hapticlab, or the folder of another.
    instructor : str or Path, optional
        Folder of an instructor's answers, which holds NN_name/solution.py and NN_name/hidden.py.
    seed : int
        Of the hidden cases.
    personal : bool
        Whether each student was handed a notebook with numbers of their own.

    Returns
    -------
    Assignment

    Examples
    --------
    >>> find_assignment("02").lab.points
    10
    >>> find_assignment("77")
    Traceback (most recent call last):
        ...
    hapticlab.errors.CourseError: there is no lab 77; there are ... for a lab of your own give its folder
    """
    folder = _folder(lab)
    if instructor is None:
        if personal:
            raise CourseError("personal numbers come from the instructor's hidden.py; give the folder of answers as well")
        return Assignment(folder.lab(), folder, None, seed)
    check_tree(instructor)
    answers = Path(instructor).resolve() / folder.name
    if not answers.is_dir():
        raise CourseError(f"{instructor} contains no {folder.name} with its solution.py and hidden.py")
    assignment = Assignment(folder.lab(), folder, answers, seed, personal)
    assignment.cases("")  # what is wrong with the answers is said before any submission is read
    return assignment


def _folder(lab):
    """Return the folder of a lab, by its number or its path."""
    found = {one.number: one for one in find_labs()}
    if str(lab) in found:
        return found[str(lab)]
    path = Path(lab).resolve()
    own = LabFolder(path)
    if own.notebook.is_file() and (path / CHECKS).is_file():
        return own
    if path.is_dir():
        raise CourseError(f"{lab} is not a lab; its folder needs {path.name}.ipynb and {CHECKS}")
    raise CourseError(f"there is no lab {lab}; there are {', '.join(found) or 'none'}; for a lab of your own give its folder")


def files_of(folder: File) -> dict[str, Path]:
    """Return the files of a folder by their names in it, in order; none that Python or Jupyter made."""
    paths = ((path.relative_to(folder), path) for path in sorted(Path(folder).rglob("*")) if path.is_file())
    return {inside.as_posix(): path for inside, path in paths if not any(part[0] in "._" for part in inside.parts)}
