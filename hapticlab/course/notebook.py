"""A notebook as plain text: its code cells, run one after another, and the solutions written into it.

Answers are found by the name they have in the code, never by what a cell's metadata says: students split, copy and
delete cells.
"""

import ast
import io
import json
import re
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import CourseError
from .constants import constants


@dataclass(frozen=True)
class Problem:
    """What a cell raised."""

    cell: int
    words: str


def read(path):
    """Return the notebook at a path, as a dict."""
    try:
        notebook = json.loads(Path(path).read_text("utf-8"))
        notebook["cells"]
    except (ValueError, KeyError, TypeError):
        raise CourseError(f"{path} is not a notebook; it needs the JSON that Jupyter writes") from None
    return notebook


def write(path, notebook):
    """Write a notebook to where there is none; return whether it is there as given. A file that differs is left alone."""
    return write_new(path, text_of(notebook).encode()) != "kept"


def text_of(notebook):
    """Return the text of a notebook's file."""
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


def write_new(path, content):
    """Write a file to where there is none, its folder as well; what is there stays.

    Parameters
    ----------
    path : str or Path
    content : bytes

    Returns
    -------
    str
        "new"; "as it came" where it was there already; or "kept", where what is there differs.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with path.open("xb") as file:
            file.write(content)
        return "new"
    except FileExistsError:
        return "as it came" if path.is_file() and path.read_bytes() == content else "kept"


def code_of(notebook):
    """Return the source of each code cell."""
    return [_source(cell) for cell in notebook["cells"] if cell["cell_type"] == "code"]


def run(sources, folder):
    """Run cells in this process, in a folder; one that fails stops none after it.

    Returns
    -------
    names : dict
        What the notebook holds at its end.
    problems : list of Problem
    printed : str
        By all cells together, cards as text.
    """
    names, problems, printed = {"__name__": "__main__"}, [], io.StringIO()
    with chdir(folder), redirect_stdout(printed), redirect_stderr(io.StringIO()):
        for number, source in enumerate(sources, start=1):
            try:
                exec(compile(source, f"cell {number}", "exec"), names)
            except (Exception, SystemExit) as problem:
                problems.append(Problem(number, f"{type(problem).__name__}: {problem}"))
    return names, problems, printed.getvalue()


def solved(notebook, solution, exercises):
    """Return the notebook with the answers of a solution written in.

    Replaced are, at the top level of a cell, definitions ``def name`` and assignments ``name = ...`` of what the
    solution has under the same name: of an exercise, or of what the notebook leaves open by ``None``, ``""`` or
    ``raise NotImplementedError``. What else the solution has goes with the answer that follows it, and its imports go
    into a cell of their own before the first. A constant ``NAME = number`` that the notebook has too is left out.

    Parameters
    ----------
    notebook : dict
    solution : str
        Plain Python.
    exercises : sequence of str
        Their names.

    Raises
    ------
    CourseError
        Where the notebook has no place for an exercise that the solution answers.

    Examples
    --------
    >>> cell = {"cell_type": "code", "id": "a", "metadata": {}, "outputs": [], "source": "k = None  # [N/m]"}
    >>> written = solved({"cells": [cell]}, "import math\\nk = 150.0", ["k"])
    >>> [cell["source"] for cell in written["cells"]]
    ['import math', 'k = 150.0']
    """
    changed = [_answered(cell, _parts(solution), exercises) for cell in notebook["cells"]]
    written = {name for _, names in changed for name in names}
    lost = [part.name for part in _parts(solution) if part.name in exercises and part.name not in written]
    if lost:
        raise CourseError(f"the notebook has no place for {', '.join(lost)}: no line begins with its def, or with its name =")
    there = {constant for source in code_of(notebook) for constant in constants(source).values()}
    imports, answers = _answers(solution, written, there)
    changed = [_answered(cell, answers, exercises) for cell in notebook["cells"]]
    cells = [cell for cell, _ in changed]
    if imports:
        cells.insert(next(place for place, (_, names) in enumerate(changed) if names), _code_cell("solution-imports", imports))
    return {**notebook, "cells": cells}


@dataclass(frozen=True)
class Place:
    """Where a notebook answers an exercise and checks it: the ids of both cells, None where there is none."""

    exercise: str
    answer: str | None
    check: str | None


def places(notebook, lab):
    """The cell that answers each exercise of a lab and the one that checks it, found by their code.

    Parameters
    ----------
    notebook : dict
    lab : Lab

    Returns
    -------
    tuple of Place
        One for each exercise, in their order.

    Examples
    --------
    >>> from hapticlab.course.exercise import Exercise, Lab
    >>> sources = {"a": "k = None  # [N/m]", "b": "hl.check('02.k', k)"}
    >>> cells = [{"cell_type": "code", "id": name, "source": source} for name, source in sources.items()]
    >>> places({"cells": cells}, Lab("02", "Springs", 10, [Exercise("k", "value", 1)]))
    (Place(exercise='k', answer='a', check='b'),)
    """
    cells = {cell["id"]: _source(cell) for cell in notebook["cells"] if cell["cell_type"] == "code"}
    answers = {part.name: key for key, source in reversed(cells.items()) for part in _parts(source)}
    checks = {name: key for key, source in reversed(cells.items()) for name in re.findall(r"\bcheck\(\s*['\"](\S+)['\"]", source)}
    return tuple(Place(one.name, answers.get(one.name), checks.get(f"{lab.number}.{one.name}")) for one in lab.exercises)


@dataclass(frozen=True)
class _Part:
    """A definition or an assignment at the top level of a source: its lines, and whether it is left open."""

    name: str
    first: int
    last: int
    text: str
    is_open: bool


def _parts(source):
    """Return the named parts of a source; of one that is no Python, none."""
    try:
        tree, lines = ast.parse(source), source.splitlines()
    except SyntaxError:
        return []
    found = []
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            first = min([node.lineno, *(d.lineno for d in node.decorator_list)])
            name, is_open = node.name, _raises_not_implemented(node)
        elif isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            first, name = node.lineno, node.targets[0].id
            is_open = isinstance(node.value, ast.Constant) and _is_empty(node.value.value)
        else:
            continue
        found.append(_Part(name, first, node.end_lineno, "\n".join(lines[first - 1 : node.end_lineno]), is_open))
    return found


def _is_empty(value):
    return value is None or value is ... or (isinstance(value, str) and not value.strip())


def _raises_not_implemented(node):
    raised = [n.exc for n in ast.walk(node) if isinstance(n, ast.Raise) and n.exc is not None]
    return any(isinstance(n, ast.Name) and n.id == "NotImplementedError" for exc in raised for n in ast.walk(exc))


def _answered(cell, answers, exercises):
    """Return a cell with the answers written in, and their names."""
    if cell["cell_type"] != "code":
        return cell, []
    source, texts = _source(cell), {part.name: part.text for part in answers}
    lines = source.splitlines()
    places = [part for part in _parts(source) if part.name in texts and (part.is_open or part.name in exercises)]
    for part in reversed(places):
        lines[part.first - 1 : part.last] = texts[part.name].splitlines()
    return {**cell, "source": "\n".join(lines)} if places else cell, [part.name for part in places]


def _answers(solution, written, there):
    """Return the imports of a solution, and its answers with what stands before each, without the constants that are there."""
    lines, end, imports, waiting, answers = solution.splitlines(), 0, [], [], []
    parts = {part.last: part for part in _parts(solution) if part.name in written}
    for node in ast.parse(solution).body:
        text = "\n".join(lines[end : node.end_lineno]).strip("\n")
        end = node.end_lineno
        if there.intersection(constants(text).values()):
            continue
        if isinstance(node, ast.Import | ast.ImportFrom):
            imports.append(text)
        elif end in parts:
            answers.append(replace(parts[end], text="\n".join([*waiting, text])))
            waiting = []
        elif not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):  # a docstring is for its reader
            waiting.append(text)
    if waiting and answers:
        answers[-1] = replace(answers[-1], text="\n".join([answers[-1].text, *waiting]))
    return "\n".join(imports), answers


def _code_cell(name, source):
    return {"cell_type": "code", "execution_count": None, "id": name, "metadata": {}, "outputs": [], "source": source}


def _source(cell):
    source = cell["source"]
    return source if isinstance(source, str) else "".join(source)
