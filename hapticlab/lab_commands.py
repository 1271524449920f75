"""What the command line does with labs: a student's copy opened in JupyterLab, and an instructor's table of marks."""

import importlib.util
import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

from .course.instructor import check_tree, mark_notebook, solved_notebook
from .course.labs import copy_labs, find_labs
from .course.notebook import read, write
from .errors import CourseError, EngineMissingError


def labs(parser, options):
    """Copy the labs and open JupyterLab on them; for an instructor first the solved notebooks and their marks."""
    folder, found = Path(options.folder), find_labs()
    if options.instructor:
        check_tree(options.instructor)
    copied = copy_labs(folder)
    _tell(folder, found, copied)
    code = _mark_all(find_labs(folder), Path(options.instructor)) if options.instructor else 0
    if options.no_open:
        print(f"\nto open them: {_words(_jupyter(folder))}")
        return code
    fresh = [lab for lab in found if copied.get(f"{lab.name}/{lab.notebook.name}") == "new"]
    return _open(_jupyter(folder, *fresh[:1])) or code


def _tell(folder, found, copied):
    """Say what is there, and what was left alone."""
    print(f"labs in {folder.resolve()}")
    for lab in (f.lab() for f in found):
        print(f"  {lab.number}  {lab.title:<60} {lab.minutes:>4} min")
    kept = [path for path, state in copied.items() if state == "kept"]
    if kept:
        print(f"left as they are, for they differ from what came with hapticlab and may hold your work:\n  {', '.join(kept)}")
        print(f"to have these as they came, name another folder: hapticlab labs {folder.resolve().name}-new")


def _mark_all(found, tree):
    """Write the solved notebooks and print what these and the notebooks as they are earn; 1 unless that is all and nothing."""
    print(f"\n{'lab':<30} {'points':>6} {'solution':>9} {'untouched':>10}")
    good = True
    for folder in found:
        try:
            good &= _mark(folder, tree / folder.name)
        except CourseError as problem:
            print(f"{folder.name:<30} {problem}")
            good = False
    return 0 if good else 1


def _mark(folder, answers):
    """Write a lab's solved notebook and print its line; whether the solution earns all, the notebook as it is nothing."""
    if not answers.is_dir():
        print(f"{folder.name:<30} no answers in {answers.parent}")
        return True
    notebook, path = solved_notebook(folder, answers), folder.path / f"{folder.name}-solved.ipynb"
    solution, untouched = (mark_notebook(folder, given, answers) for given in (notebook, read(folder.notebook)))
    state = "written" if write(path, notebook) else "left as it is: it differs from the solution"
    points = folder.lab().points
    print(f"{folder.name:<30} {points:>6g} {solution.earned:>9g} {untouched.earned:>10g}  {path.name} {state}", flush=True)
    for name, marked in (("solution", solution), ("untouched", untouched)):
        for problem in marked.problems:
            print(f"  {name}, cell {problem.cell}: {problem.words}")
    for mark in solution.marks:
        if mark.earned != mark.points:
            print(f"  solution, {mark.exercise}: {mark.right} of {mark.cases} cases; {mark.words}")
    return solution.earned == points and untouched.earned == 0 and not solution.problems and not untouched.problems


def _jupyter(folder, first=None):
    """Return the command that opens JupyterLab of this environment on a folder, the first time on its first lab."""
    command = [sys.executable, "-m", "jupyterlab", str(folder)]
    if first is not None:
        command.append(f"--LabApp.default_url=/lab/tree/{first.name}/{first.notebook.name}")
    return command


def _words(command):
    """Return a command as it is typed into a shell."""
    return subprocess.list2cmdline(command) if os.name == "nt" else shlex.join(command)


def _open(command):
    """Run JupyterLab until it ends; Ctrl-C is its own to answer."""
    if importlib.util.find_spec("jupyterlab") is None:
        raise EngineMissingError(
            "the labs are copied, and JupyterLab, which opens them, is not installed beside hapticlab; do: "
            f'{_words([sys.executable])} -m pip install "hapticlab[notebook]"; then the same command again'
        )
    print(f"\nJupyterLab opens in your browser. Two Ctrl-C here end it; it runs as: {_words(command)}", flush=True)
    # the kernels of this environment before those of the same name that a user may have elsewhere
    process = subprocess.Popen(command, env={**os.environ, "JUPYTER_PREFER_ENV_PATH": "1"})
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        code = process.wait()
    finally:
        signal.signal(signal.SIGINT, before)
    if code:
        root = getattr(os, "geteuid", lambda: 1)() == 0
        nevertheless = f"; as root it runs only by: {_words([*command, '--allow-root'])}" if root else ""
        print(f"hapticlab: JupyterLab ended with code {code}; what it said is above{nevertheless}", file=sys.stderr)
    return 1 if code else 0
