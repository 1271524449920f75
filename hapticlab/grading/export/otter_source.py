"""A lab as an assignment of otter-grader: the notebook that `otter assign` reads, and what it makes of that."""

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path

from ...course.notebook import write
from ...errors import CourseError, EngineMissingError
from .answer_cells import answer_cells, source_of

#: what a test does: the check's own words stand in the error, and nothing of a right answer's is compared
TEST = """\
import contextlib as _contextlib, io as _io
with _contextlib.redirect_stdout(_io.StringIO()):
    _found = hl.check("{lab}.{name}", {name})

_found.require()"""
CONFIG = """\
# ASSIGNMENT CONFIG
name: {name}
requirements: [{requirements}]
files: [{files}]
export_cell:
    pdf: false
strip_solutions_from_all_cells: true
generate:
    show_stdout: true
"""


def otter_notebook(folder, answers, files=(), requirements="hapticlab"):
    """Return a lab's notebook as `otter assign` reads it.

    Parameters
    ----------
    folder : LabFolder
    answers : Path
        With solution.py.
    files : sequence of str
        Beside the notebook, such as checks.py.
    requirements : str
        What pip installs where submissions are graded.
    """
    found = answer_cells(folder, answers)
    cells = [_raw("otter-config", CONFIG.format(name=folder.name, files=", ".join(files), requirements=requirements))]
    for cell in found.notebook["cells"]:
        cells += _cells(cell, found)
    return {**found.notebook, "cells": cells}


def otter_assign(folder, answers, target, requirements="hapticlab"):
    """Have `otter assign` write a lab's folders ``autograder``, with the zip, and ``student`` into a folder.

    Parameters
    ----------
    folder : LabFolder
    answers : Path
        With solution.py.
    target : Path
        Made where it is missing.

    Returns
    -------
    Path
        The autograder's zip.
    """
    if importlib.util.find_spec("otter") is None:
        raise EngineMissingError("this zip file needs otter, which is not installed with hapticlab; do: pip install otter-grader")
    files = {path.name: path for path in folder.path.iterdir() if path.is_file() and path != folder.notebook}
    with tempfile.TemporaryDirectory() as scratch:
        master = Path(scratch, folder.notebook.name)
        write(master, otter_notebook(folder, answers, sorted(files), requirements))
        for name, path in files.items():
            Path(scratch, name).write_bytes(path.read_bytes())
        command = [sys.executable, "-m", "otter", "assign", "--no-pdfs", str(master), str(target.resolve())]
        done = subprocess.run(command, cwd=scratch, capture_output=True, text=True)
    made = sorted(target.glob("autograder/*.zip"))
    if done.returncode or not made:
        raise CourseError(f"otter assign failed on {folder.name}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}".rstrip())
    return made[-1]


def _cells(cell, found):
    """Return the cells that stand for one: a question opens with its answer, and its test is the lab's own check."""
    key = cell["id"]
    judged = [one for one in found.answers.get(key, ()) if one.judged]
    if key not in found.solutions:
        return [cell]
    region = ["# BEGIN SOLUTION NO PROMPT", found.solutions[key], "# END SOLUTION"]
    solved = {**cell, "source": "\n".join([source_of(cell), *region])}
    if not judged:
        return [solved]
    name, points = judged[0].name, sum(one.points for one in judged)
    before = [f"# BEGIN QUESTION\nname: {name}\npoints: {points:g}", "# BEGIN SOLUTION"]
    after = ["# END SOLUTION", "# BEGIN TESTS"]
    tests = [{**cell, "id": f"{one.name}-test", "source": TEST.format(lab=found.lab.number, name=one.name)} for one in judged]
    ends = ["# END TESTS", "# END QUESTION"]
    return [
        *(_raw(f"{name}-{number}", text) for number, text in enumerate(before)),
        solved,
        *(_raw(f"{name}-{number}", text) for number, text in enumerate(after, start=2)),
        *tests,
        *(_raw(f"{name}-{number}", text) for number, text in enumerate(ends, start=4)),
    ]


def _raw(name, source):
    return {"cell_type": "raw", "id": name, "metadata": {}, "source": source}
