"""Labs with numbers that are each student's own, so that a value copied from a neighbour is a wrong one.

``hidden.py`` of an instructor's folder has ``def numbers(random): return {"K_OWN": 430.0}``. Notebook and solution have a line
``K_OWN = 500.0`` each; a student's notebook, and what is expected of that student, have the drawn number in its place.
"""

import re
from pathlib import Path

from ..errors import CourseError
from .constants import constants, with_constants
from .instructor import check_tree
from .labs import CHECKS, find_labs
from .marks import own_exercises, own_numbers
from .notebook import code_of, read, text_of, write_new

#: what no folder can be called on some system: a slash or a sign with a meaning, an end that is cut off, a device's name
NO_FOLDER = re.compile(r'.*[\\/:*?"<>|].*|[\s.].*|.*[\s.]|(con|prn|aux|nul|com\d|lpt\d)(\..*)?|', re.I | re.S)
#: at the end of a student's checks.py: the public case of such an exercise is of the numbers that came with the lab
NOTED = """

# the numbers of this notebook are its student's own: these exercises are judged when handed in
from dataclasses import replace  # noqa: E402

LAB = replace(LAB, exercises=tuple(replace(e, cases=()) if e.name in {names!r} else e for e in LAB.exercises))
"""


def personal_notebook(folder, answers, seed, student):
    """Return the notebook of a lab with a student's own numbers; the same seed and student give the same.

    Parameters
    ----------
    folder : LabFolder
    answers : str or Path
        The lab's folder in an instructor's tree, with hidden.py.
    seed : int
        Of the course.
    student : str
        By the name that submissions are graded under.

    Returns
    -------
    dict
        The notebook as it came, where the lab has no own numbers.

    Raises
    ------
    CourseError
        Where the notebook has no line for one of the numbers.
    """
    notebook, numbers = read(folder.notebook), own_numbers(folder.lab(), answers, seed, student)
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    sources = with_constants(["".join(cell["source"]) for cell in code], numbers, folder.notebook)
    changed = {cell["id"]: source for cell, source in zip(code, sources, strict=True) if source != "".join(cell["source"])}
    cells = [{**cell, "source": changed[cell["id"]]} if cell["id"] in changed else cell for cell in notebook["cells"]]
    return {**notebook, "cells": cells}


def personal_checks(folder, answers):
    """Return the text of a lab's checks.py for students with own numbers: what depends on these is noted and not judged.

    Parameters
    ----------
    folder : LabFolder
    answers : str or Path
    """
    text, names = (folder.path / CHECKS).read_text("utf-8"), own_exercises(folder.lab(), answers)
    return text.rstrip("\n") + NOTED.format(names=names) if names else text


def personal_labs(students, folder, tree, seed=0, only=(), labs=None):
    """Write a folder for each student, with the labs and that student's own numbers in them.

    Graded are such labs by ``hapticlab grade --personal`` with the same seed.

    Parameters
    ----------
    students : iterable of str
        Names that submissions will be graded under; each is a folder's name.
    folder : str or Path
        Made where it is missing. What is there and differs stays as it is.
    tree : str or Path
        An instructor's answers, NN_name/hidden.py.
    seed : int
        Of the course; whoever knows it, and hidden.py, knows everybody's numbers.
    only : sequence of str
        Numbers of labs, by default all that the tree has answers of.
    labs : sequence of LabFolder, optional
        By default those that came with the package.

    Returns
    -------
    dict of str to str
        Path in the folder to "new", "as it came" or "kept".

    Raises
    ------
    CourseError
        Where a student's name can be no folder, a lab is unknown, or has no answers.
    """
    check_tree(tree)
    chosen, target = _chosen(find_labs() if labs is None else labs, Path(tree), only), Path(folder)
    states, names = {}, [folder_name(student) for student in dict.fromkeys(students)]
    alike = {name.casefold(): name for name in names}
    if len(alike) != len(names):
        raise CourseError(
            f"two of the {len(names)} students have names that differ only in capitals; each needs a folder name of their own"
        )
    for student in names:
        for lab in chosen:
            for path, content in _files(lab, Path(tree) / lab.name, seed, student).items():
                states[str(Path(student, lab.name, path))] = write_new(target / student / lab.name / path, content)
    return states


def foreign_numbers(cells, folder, answers, seed, student, personal=True):
    """Tell in a sentence which numbers in a submission are not those that it is graded by.

    Then the student was handed another's notebook, one of another seed, or is graded under another name, and right work
    earns nothing. The cells are looked through as text.

    Parameters
    ----------
    cells : iterable of str
        As they were handed in.
    folder : LabFolder
    answers : str or Path or None
        The lab's folder in an instructor's tree; None where there are no answers, and nothing to tell.
    seed : int
        Of the course.
    student : str
        By the name that the submission is graded under.
    personal : bool
        Whether each student was handed numbers of their own; else these are those of the lab.

    Returns
    -------
    str
        Empty where each number stands there as it should, or stands nowhere.

    Examples
    --------
    >>> from hapticlab.course.labs import LabFolder
    >>> foreign_numbers(["K_OWN = 430.0"], LabFolder(Path("labs/02_virtual_wall")), None, 0, "ada")
    ''
    """
    if answers is None:
        return ""
    own = own_numbers(folder.lab(), answers, seed, student)
    lines = [pair for cell in code_of(read(folder.notebook)) for pair in constants(cell).values()]
    came = {name: float(value) for name, value in lines if name in own}
    needed, who = (own, f"seed {seed} gave {student!r}") if personal else (came, "the lab has")
    written = {name: _written(name, cells) for name in needed}
    foreign = [name for name, values in written.items() if values and needed[name] not in values]
    if not foreign:
        return ""
    name = foreign[0]
    found = f"{name} = {written[name][0]:.15g} in the notebook, and {who} {needed[name]:.15g}"
    if not personal:
        return f"{found}. If it was handed out with personal numbers, grade it with --personal and the same --seed"
    if written[name][0] == came.get(name):
        return f"{found}: it is the notebook that came with the lab, not the one handed out to this student"
    return f"{found}: it was handed out with a different seed, or to a different name"


def _written(name, cells):
    """Return the numbers that cells give to a name, in lines such as ``K_OWN = 430.0  # N/m``."""
    line = re.compile(rf"^{re.escape(name)}[ \t]*=[ \t]*([-+\w.]{{1,40}})[ \t]*(?:[#;\r].*)?$", re.M | re.A)
    values = []
    for text in (text for cell in cells for text in line.findall(cell)):
        try:
            values.append(float(text))
        except ValueError:  # a formula, or another name
            continue
    return values


def _chosen(labs, tree, only):
    """Return the labs that are asked for, all with answers."""
    found = {lab.number: lab for lab in labs if (tree / lab.name).is_dir()}
    strange = [number for number in only if number not in found]
    if strange:
        raise CourseError(f"{tree} has no answers of a lab {strange[0]}; it has those of {', '.join(found) or 'none'}")
    return [lab for number, lab in found.items() if not only or number in only]


def folder_name(student):
    """Return a student's name where it can be a folder's."""
    if NO_FOLDER.fullmatch(student) or not student.isprintable():
        raise CourseError(
            f"student {student!r} cannot be the name of a folder. Use a login or a number, without slashes, without signs "
            "such as : * ? and without a dot or a space at either end"
        )
    return student


def _files(folder, answers, seed, student):
    """Return the files of a lab as a student gets them, name to bytes."""
    paths = [path for path in sorted(folder.path.iterdir()) if path.is_file() and path.name[0] not in "._"]
    files = {path.name: path.read_bytes() for path in paths}
    files[folder.notebook.name] = text_of(personal_notebook(folder, answers, seed, student)).encode()
    files[CHECKS] = personal_checks(folder, answers).encode()
    return files
