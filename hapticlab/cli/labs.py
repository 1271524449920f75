"""What the command line does with labs: a student's copy opened in JupyterLab, and an instructor's table of marks."""

import importlib.util
import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

from ..base.in_notebook import is_in_browser
from ..course.instructor import check_tree, mark_notebook, solved_notebook
from ..course.labs import copy_labs, find_labs, incomplete_labs
from ..course.notebook import read, write
from ..errors import CourseError, EngineMissingError
from .begin import lab_number


def labs(parser, options):
    """Copy the labs and open JupyterLab on them; for an instructor first the solved notebooks and their marks."""
    folder = _wanted(parser, options)
    if options.instructor:
        check_tree(options.instructor)
    elif options.seed is not None:
        parser.error("--seed is of the hidden cases; it needs --instructor PATH")
    copied = copy_labs(folder, options.lab)
    _tell(folder, copied)
    code = _mark_all(folder, Path(options.instructor), options) if options.instructor else 0
    here = [lab for lab in find_labs(folder) if copied.get(str(Path(lab.name, lab.notebook.name))) in ("new", "as it came")]
    if len(options.lab) == 1:  # asked for by its number: also where it is begun
        here = [lab for lab in find_labs(folder) if lab.number == options.lab[0]]
    command = _jupyter(folder, *here[:1])
    if is_in_browser():
        print("\nto open them: use the file browser of this page")
        return code
    if options.no_open:
        print(f"\nto open them: {words_of(command)}")
        return code
    return _open(command) or code


def _wanted(parser, options):
    """Return the folder, and put labs that were named by number alone, as "6" or "06", with those of --lab."""
    numbers = [lab_number(text) for text in options.wanted if text.isdecimal()]
    folders = [text for text in options.wanted if not text.isdecimal()]
    if wrong := [text for text in numbers if len(text) > 2]:
        parser.error(f"{wrong[0]} is not a lab; labs have two digits. For a folder of that name, give ./{wrong[0]}")
    if len(folders) > 1:
        words = "give one, and labs by their numbers: hapticlab labs 02 06 DIR"
        parser.error(f"{' and '.join(folders)} are several folders; {words}")
    options.lab = [*dict.fromkeys([*options.lab, *numbers])]
    return Path(folders[0] if folders else "hapticlab-labs")


def _tell(folder, copied):
    """Say what is there, and what was left alone."""
    found, came = find_labs(folder), find_labs()
    print(f"labs in {folder.resolve()}")
    for one in found:
        try:
            lab = one.lab()
            print(f"  {lab.number}  {lab.title:<60} {lab.minutes:>4} min")
        except CourseError as problem:
            print(f"  {one.number}  {problem}")
    for name in incomplete_labs(folder):
        print(f"  {name} is no lab: it needs {name}.ipynb and checks.py")
    _tell_files(folder, copied)
    away = [lab.number for lab in came if lab.name not in {path.name for path in folder.iterdir()}]
    if away:
        print(f"not in this folder; to have them: {words_of(['hapticlab', 'labs', str(folder), '--lab', *away])}")


def _tell_files(folder, copied):
    """Say which files were renewed, and which were left as they are."""
    renewed = [path for path, state in copied.items() if state == "renewed"]
    if renewed:
        print("renewed, for a newer hapticlab checks otherwise, and nobody had changed them; the old ones are beside as")
        print(f"checks.py.old:\n  {', '.join(renewed)}")
    kept = [path for path, state in copied.items() if state == "kept"]
    if kept:
        print(f"left as they are, for they differ from what came with hapticlab and may hold your work:\n  {', '.join(kept)}")
        print(f"to have these as they came, name another folder: {words_of(['hapticlab', 'labs', str(_beside(folder, 'new'))])}")


def _beside(folder, ending):
    """Return the path of a folder beside one."""
    folder = folder if folder.name not in ("", "..") else folder.resolve()
    return folder.with_name(f"{folder.name}-{ending}")


def _mark_all(folder, tree, options):
    """Write the solved notebooks and print what these and the notebooks as they came earn; 1 unless that is all and nothing.

    Marked are the labs that came with hapticlab: their code runs in this process, and a folder that somebody worked in may
    hold anything.
    """
    came, solved, seed = find_labs(), _beside(folder, "solved"), options.seed or 0
    asked = [lab for lab in came if not options.lab or lab.number in options.lab]
    print(f"\nmarked are the labs as they came with hapticlab, never the notebooks in {folder}; hidden cases of seed {seed}")
    print(f"solved notebooks go into {solved.resolve()}: keep that folder from students")
    print(f"\n{'lab':<30} {'points':>6} {'solution':>9} {'untouched':>10}")
    good = not incomplete_labs(folder)
    for lab in asked:
        try:
            good &= _mark(lab, tree / lab.name, solved, seed)
        except CourseError as problem:
            print(f"{lab.name:<30} {problem}")
            good = False
    for path in sorted(set(tree.glob("[0-9][0-9]_*")) - {tree / lab.name for lab in came}):
        print(f"{path.name:<30} answers, and no lab of that name came with hapticlab")
        good = False
    return 0 if good else 1


def _mark(folder, answers, solved, seed):
    """Write a lab's solved notebook and print its line; whether the solution earns all, the notebook as it came nothing."""
    if not answers.is_dir():
        print(f"{folder.name:<30} no answers in {answers.parent}")
        return False
    notebook, path = solved_notebook(folder, answers), solved / f"{folder.name}-solved.ipynb"
    solution, untouched = (mark_notebook(folder, given, answers, seed) for given in (notebook, read(folder.notebook)))
    solved.mkdir(parents=True, exist_ok=True)
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
    """Return the command that opens JupyterLab of this environment on a folder, at a lab of it."""
    command = [sys.executable, "-m", "jupyterlab", str(folder)]
    if first is not None:
        command.append(f"--LabApp.default_url=/lab/tree/{first.name}/{first.notebook.name}")
    return command


def words_of(command):
    """Return a command as it is typed into a shell."""
    return subprocess.list2cmdline(command) if os.name == "nt" else shlex.join(command)


def _open(command):
    """Run JupyterLab until it ends; Ctrl-C is its own to answer."""
    if importlib.util.find_spec("jupyterlab") is None:
        raise EngineMissingError(
            "the labs are copied, and JupyterLab, which opens them, is not installed beside hapticlab; do: "
            f'{words_of([sys.executable])} -m pip install "hapticlab[notebook]"; then the same command again'
        )
    print(f"\nJupyterLab opens in your browser. Two Ctrl-C here end it; it runs as: {words_of(command)}", flush=True)
    # the kernels of this environment before those of the same name that a user may have elsewhere
    process = subprocess.Popen(command, env={**os.environ, "JUPYTER_PREFER_ENV_PATH": "1"})
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        code = process.wait()
    finally:
        signal.signal(signal.SIGINT, before)
    if code:
        root = getattr(os, "geteuid", lambda: 1)() == 0
        nevertheless = f"; as root it runs only by: {words_of([*command, '--allow-root'])}" if root else ""
        print(f"hapticlab: JupyterLab ended with code {code}; what it said is above{nevertheless}", file=sys.stderr)
    return 1 if code else 0
