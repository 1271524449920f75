"""Places that a grading keeps apart: what was handed in, what judges it, where marks go, what Python imports from."""

import os
from pathlib import Path

from ..course.labs import labs_folder
from ..course.marks import SOLUTION
from ..errors import CourseError
from .handed_in.naming import TREE, WORK


def check_places(submissions, *, judging=None, written=None, imported=()):
    """Refuse a grading in which one place lies in another that must not hold it.

    Parameters
    ----------
    submissions : sequence of str or Path
    judging : dict of str to path or None, optional
        Option to the folder whose code runs in the grader: ``--lab``, ``--instructor``.
    written : dict of str to path or None, optional
        Option to what the grader writes: ``-o``, ``--pages``.
    imported : sequence of str
        Python's import path.

    Raises
    ------
    CourseError

    Examples
    --------
    >>> check_places(["class"], judging={"--instructor": "class/eve"})
    Traceback (most recent call last):
        ...
    hapticlab.errors.CourseError: --instructor class/eve is in the submissions class, ...
    """
    judging, written = ({option: path for option, path in (several or {}).items() if path} for several in (judging, written))
    for root in map(_root, submissions):
        for option, path in judging.items():
            if is_inside(path, root):
                words = f"{option} {path} is in the submissions {root}, whose code must not grade"
                raise CourseError(f"{words}. Give a folder of your own, and the folder that contains only the submissions")
            if is_inside(root, path) and (option == "--lab" or _holds_answers(root, path)):
                raise CourseError(
                    f"{root} is in {option} {path}, which students did not hand in; give the folder of the submissions"
                )
        if is_inside(root, labs_folder()):
            raise CourseError(f"{root} is a lab of hapticlab itself; give the folder of the submissions")
        for option, path in written.items():
            if is_inside(path, root):
                words = f"{option} {path} is in the submissions {root}, where it would be treated as a submission"
                raise CourseError(f"{words}, or replace one. Give a path outside")
        for path in imported:
            if is_inside(path or ".", root):
                raise CourseError(
                    f"Python imports modules from {path or os.getcwd()}, which is in the submissions {root}, so the file of "
                    "a student could run instead of a module. Change to a folder outside, or start with: python -P -m "
                    "hapticlab grade"
                )


def check_written(output, pages=None, others=()):
    """Refuse results that would take the place of something else; make the folder they go into.

    Parameters
    ----------
    output, pages : path or None
        A file, and a folder.
    others : sequence of path
        What is only read.

    Raises
    ------
    CourseError
    """
    if output and output.is_dir():
        raise CourseError(f"-o {output} is a folder; give a file for the results, such as -o {output / 'grades.csv'}")
    if output and (output.suffix.lower() in WORK or any(_same(output, other) for other in others)):
        raise CourseError(f"-o {output} would overwrite a file that is read; give a different file for the results")
    if pages and pages.exists() and not pages.is_dir():
        raise CourseError(f"--pages {pages} is a file; give a folder for the pages")
    if output:
        output.parent.mkdir(parents=True, exist_ok=True)


def is_inside(path, folder):
    """Return whether a path is a folder or lies in it, also where a system takes capitals for small letters.

    Examples
    --------
    >>> is_inside("class/ada/x.py", "class"), is_inside("class", "class"), is_inside("classes", "class")
    (True, True, False)
    """
    real = Path(os.path.realpath(path))
    return any(_same(one, folder) for one in (real, *real.parents))


def _same(path, other):
    try:
        return os.path.samefile(path, other)
    except OSError:  # one of them is not there
        return os.path.realpath(path) == os.path.realpath(other)


def _root(path):
    """Return where submissions lie: in a course of nbgrader, in a folder of it."""
    tree = Path(path, TREE)
    return tree if tree.is_dir() else Path(path)


def _holds_answers(path, answers):
    inside = Path(os.path.realpath(path)).relative_to(os.path.realpath(answers))
    return not inside.parts or Path(answers, inside.parts[0], SOLUTION).is_file()
