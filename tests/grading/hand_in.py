"""What students of a course hand in: a notebook as they got it, with answers of the lab's solution or other ones."""

import os
import subprocess
import sys
from pathlib import Path
from subprocess import PIPE

from hapticlab.course.instructor import solved_notebook
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import places

ROOT = Path(__file__).parents[2]
INSTRUCTOR = ROOT / "tests" / "instructor"
LABS = {lab.number: lab for lab in find_labs(ROOT / "labs")}
#: of the two labs that are handed out for real: what a student got wrong, None where nothing was answered
WRONG = {
    "01": {"thousand": 'thousand = "b"', "mass_on_coupler": None},
    "02": {"period_leak": "def period_leak(k, D):\n    return k * D**2", "damping_that_pays": "damping_that_pays = 0.5"},
}


def text(cell):
    """Return the source of a cell."""
    return "".join(cell["source"])


def handed_in(released, lab, wrong=None):
    """Return a notebook with every answer of the solution but those named in ``wrong``, exercise to source or None."""
    solved = solved_notebook(lab, INSTRUCTOR / lab.name)
    written = {cell["id"]: cell for cell in solved["cells"]}
    cells = {place.exercise: place.answer for place in places(released, lab.lab())}
    others = {cells[name]: source for name, source in (wrong or {}).items()}
    filled = []
    for cell in released["cells"]:
        key, came = cell["id"], text(cell)
        answer = others[key] if key in others else text(written.get(key, cell))
        filled.append({**cell, "source": answer or came})
    imports = [cell for cell in solved["cells"] if cell["id"] == "solution-imports"]
    return {**released, "cells": [*imports, *filled]}


def earned(lab, wrong=None):
    """Return what such a notebook earns: the points of every exercise that is not named."""
    return sum(one.points for one in lab.lab().exercises if one.name not in (wrong or {}))


def run(*command, cwd):
    """Run a command that finds this hapticlab, and return what it printed; it must succeed."""
    with start(*command, cwd=cwd) as process:
        said = process.communicate()
    assert process.returncode == 0, f"{' '.join(map(str, command))}\n{said[0][-3000:]}\n{said[1][-3000:]}"
    return said[0]


def start(*command, cwd):
    """Start a command that finds this hapticlab, its tools and its kernel."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    found = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
    env = {**os.environ, "PATH": path, "PYTHONPATH": found, "JUPYTER_PREFER_ENV_PATH": "1"}
    return subprocess.Popen(command, cwd=cwd, env=env, text=True, stdin=PIPE, stdout=PIPE, stderr=PIPE)
