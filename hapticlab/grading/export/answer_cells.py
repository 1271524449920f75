"""A lab's notebook as an instructor hands it to another system: which cell answers what, and the solution of each."""

from dataclasses import dataclass

from ...course.instructor import solved_notebook
from ...course.notebook import places, read
from ...errors import CourseError


@dataclass(frozen=True)
class AnswerCells:
    """A lab's notebook with its solutions beside it.

    Attributes
    ----------
    notebook : dict
        As students get it.
    lab : Lab
    solutions : dict of str to str
        Id of each cell that a student fills in, to its source when it is solved.
    answers, checks : dict of str to tuple of Exercise
        Id of a cell to the exercises that it answers or checks.
    """

    notebook: dict
    lab: object
    solutions: dict
    answers: dict
    checks: dict

    def names(self, cell):
        """Return the names of the exercises that a cell answers or checks."""
        return [one.name for one in (*self.answers.get(cell, ()), *self.checks.get(cell, ()))]


def answer_cells(folder, answers):
    """Return the cells of a lab that are answered and checked.

    Parameters
    ----------
    folder : LabFolder
    answers : Path
        With solution.py.

    Raises
    ------
    CourseError
        Where an exercise has no cell for its answer or none that checks it, or no solution.
    """
    notebook, lab = read(folder.notebook), folder.lab()
    found = places(notebook, lab)
    lost = [place.exercise for place in found if place.answer is None or place.check is None]
    if lost:
        raise CourseError(
            f"{folder.notebook.name}: {', '.join(lost)} has no cell of its own; each exercise needs a cell that answers it and "
            f'a cell that checks it with hl.check("{lab.number}.{lost[0]}", {lost[0]})'
        )
    solutions = _solutions(notebook, solved_notebook(folder, answers))
    unsolved = [place.exercise for place in found if place.answer not in solutions]
    if unsolved:
        raise CourseError(f"{answers} has no answer to {', '.join(unsolved)}; solution.py needs each exercise by its name")
    return AnswerCells(notebook, lab, solutions, _by_cell(lab, found, "answer"), _by_cell(lab, found, "check"))


def source_of(cell):
    """Return the text of a cell."""
    source = cell["source"]
    return source if isinstance(source, str) else "".join(source)


def _solutions(notebook, solved):
    """Return the cells that a solution changed; its imports go with the first of them."""
    came = {cell["id"]: source_of(cell) for cell in notebook["cells"]}
    new = [source_of(cell) for cell in solved["cells"] if cell["id"] not in came]
    changed = {c["id"]: source_of(c) for c in solved["cells"] if came.get(c["id"], source_of(c)) != source_of(c)}
    first = next(iter(changed), None)
    return {key: "\n\n".join([*new, source]) if key == first else source for key, source in changed.items()}


def _by_cell(lab, found, which):
    cells = {}
    for place in found:
        cells.setdefault(getattr(place, which), []).append(lab.exercise(place.exercise))
    return {key: tuple(several) for key, several in cells.items()}
