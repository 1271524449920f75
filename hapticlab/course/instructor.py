"""An instructor's folder of answers: the solved notebook of a lab, and what a notebook earns."""

from __future__ import annotations

import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import CourseError
from .marks import SOLUTION, hidden_cases, instructor_names, marks
from .notebook import code_of, read, run, solved

if TYPE_CHECKING:
    from ..base.annotations import File
    from .labs import LabFolder
    from .marks import Mark
    from .notebook import Problem


@dataclass(frozen=True)
class Marked:
    """What a notebook earned, what its cells raised and printed, and the names that it holds at its end."""

    marks: tuple[Mark, ...]
    problems: list[Problem]
    names: dict[str, Any]
    printed: str

    @property
    def earned(self) -> float:
        """Points of all exercises together."""
        return sum(mark.earned for mark in self.marks)


def check_tree(tree: File) -> None:
    """Refuse a folder without any answers; its folders are named as the labs are, NN_name."""
    if not any(Path(tree).glob(f"[0-9][0-9]_*/{SOLUTION}")):
        raise CourseError(
            f"{tree} contains no NN_name/{SOLUTION}; give the folder of an instructor's answers, tests/instructor of a checkout"
        )


def solved_notebook(folder: LabFolder, answers: Path) -> dict[str, Any]:
    """Return a lab's notebook with the solution written in.

    Parameters
    ----------
    folder : LabFolder
    answers : Path
        With solution.py.
    """
    instructor_names(answers / SOLUTION)  # it is there, and it runs
    solution = (answers / SOLUTION).read_text("utf-8")
    return solved(read(folder.notebook), solution, [exercise.name for exercise in folder.lab().exercises])


def mark_notebook(folder: LabFolder, notebook: dict[str, Any], answers: Path, seed: int = 0) -> Marked:
    """Run a notebook of a lab in a copy of its folder, in this process, and mark what it holds at its end.

    Only for notebooks that are trusted: their code runs with the rights of whoever marks.

    Parameters
    ----------
    folder : LabFolder
    notebook : dict
    answers : Path
        With solution.py and hidden.py.
    seed : int
        Of the hidden cases.

    Returns
    -------
    Marked
    """
    with tempfile.TemporaryDirectory() as scratch:
        place = shutil.copytree(folder.path, Path(scratch) / folder.name)
        names, problems, printed = run(code_of(notebook), place)
    lab = folder.lab()
    return Marked(marks(lab, names, hidden_cases(lab, answers, seed)), problems, names, printed)
