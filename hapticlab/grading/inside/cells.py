"""A cell of a notebook as Jupyter runs it: magics, ``await`` at the top level, and what it raises in one line."""

import __future__

import ast
import asyncio
import builtins
import functools
import inspect
import linecache
import re
import sys
import types
from contextlib import suppress

from .source_lines import ASSIGNED_MAGIC, MAGIC, logical_lines

CELL_MAGIC = re.compile(r"(?:[ \t]*(?:#[^\n]*)?\n)*%%(\w+)[^\n]*")
#: cell magics whose cell is Python that runs
KEPT = {"time", "timeit", "capture", "prun", "memit"}
TIMED = re.compile(r"((?:[\w., \t]+=)?[ \t]*)%time[ \t]+(?=\S)")
PROMPT = re.compile(r"^(?:>>>|\.\.\.)(?: |$)", re.MULTILINE)
MOST_CHARACTERS = 300


class Quiet:
    """Stands for ``display`` and for Jupyter's shell: whatever is asked of it does nothing."""

    def __getattr__(self, name):
        """Return itself, for any method."""
        return self

    def __call__(self, *_, **__):
        """Return itself."""
        return self

    def __contains__(self, _):
        """Return False: no setting is set."""
        return False


def fresh_names():
    """Return the empty namespace of a notebook, which is that of a new module ``__main__``.

    Examples
    --------
    >>> before = sys.modules["__main__"]
    >>> names = fresh_names()
    >>> run_cell("display(k := 2)", names, 1), names["k"], sys.modules["__main__"].k
    ('', 2, 2)
    >>> sys.modules["__main__"] = before
    """
    sys.modules["__main__"] = module = types.ModuleType("__main__")
    quiet = Quiet()
    vars(module).update(__builtins__=builtins, display=quiet, get_ipython=lambda: quiet)
    return vars(module)


def runnable(source):
    r"""Return the Python of a cell, as many lines as it has: without magics and lines for the shell.

    Examples
    --------
    >>> runnable("%matplotlib inline\nk = (7\n %4)\nif k:\n    !pip install sympy\nhl.wall?")
    'pass\nk = (7\n %4)\nif k:\n    pass\npass'
    >>> runnable("%%capture\nk = 2"), runnable("%%bash\nls")
    ('\nk = 2', '')
    """
    source = source.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    if _is_python(source):
        return source
    magic = CELL_MAGIC.match(source)
    if magic:
        before = "\n" * magic.group().count("\n")
        return before + runnable(source[magic.end() :]) if magic.group(1) in KEPT else ""
    first = re.match(r"(?:[ \t]*\n)*([ \t]*)(>>> )?", source)
    if first.group(2):
        source = PROMPT.sub("", source)
    if first.group(1):  # Jupyter runs a cell that is indented as a whole
        source = re.sub(f"^{first.group(1)}", "", source, flags=re.MULTILINE)
    return "".join(map(_without_magic, logical_lines(source)))


def _is_python(source):
    try:
        compile(source, "", "exec", ast.PyCF_ONLY_AST | ast.PyCF_ALLOW_TOP_LEVEL_AWAIT, dont_inherit=True)
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return False
    return True


def _without_magic(line):
    """Return a logical line, or in the place of a magic one that does nothing, as many lines long."""
    timed = TIMED.match(line)
    if timed:
        return timed.group(1) + line[timed.end() :]
    indent, after = line[: len(line) - len(line.lstrip(" \t"))], "\n" * line.count("\n")
    if MAGIC.fullmatch(line):
        return f"{indent}pass{after}"
    if ASSIGNED_MAGIC.fullmatch(line):
        return f"{line.partition('=')[0]}= None{after}"
    return line


def run_cell(source, names, number):
    """Run a cell in a namespace; it never raises.

    Figures of pyplot are closed after it, as in Jupyter. A statement of a script, which comes after as many blank lines as
    it has lines before it, closes none.

    Parameters
    ----------
    source : str
    names : dict
        Of the notebook, see :func:`fresh_names`.
    number : int
        Of the cell, counted from 1.

    Returns
    -------
    str
        What it raised, with the line of the cell; empty where it ran.

    Examples
    --------
    >>> names = {"__name__": "__main__"}
    >>> run_cell("k = 150\\nforce = k*y", names, 3), names["k"]
    ("NameError in line 2: name 'y' is not defined", 150)
    """
    file, in_script = f"<cell {number}>", source.startswith("\n")
    try:
        source = runnable(source)
        linecache.cache[file] = len(source), None, source.splitlines(keepends=True), file  # for inspect.getsource
        code = compile(source, file, "exec", _flags(names), dont_inherit=True)
    except BaseException as problem:
        line = problem.lineno if isinstance(problem, SyntaxError) else None
        return _said(problem, f" in line {line}" if isinstance(line, int) else "")
    stopped = _run(code, names, number)
    if not in_script:
        _close_figures()
    return stopped


def _run(code, names, number):
    try:
        if code.co_flags & inspect.CO_COROUTINE:
            _loop().run_until_complete(eval(code, names))
        else:
            exec(code, names)
    except BaseException as problem:  # sys.exit() and whatever else a student's code may raise
        try:
            return _said(problem, _where(problem, number))
        except BaseException:  # even reading it may raise
            return "an error that cannot be read"
    return ""


def _close_figures():
    """Close the figures of pyplot: the next cell draws into one of its own."""
    with suppress(BaseException):
        pyplot = sys.modules.get("matplotlib.pyplot")
        if pyplot:
            pyplot.close("all")


def _flags(names):
    """Compiler flags: an import from the future holds for all cells after it."""
    future = __future__.annotations
    return ast.PyCF_ALLOW_TOP_LEVEL_AWAIT | (future.compiler_flag if names.get("annotations") is future else 0)


@functools.cache
def _loop():
    return asyncio.new_event_loop()


def _where(problem, number):
    """Return the last line of the student's own that an error passed."""
    where, trace = "", problem.__traceback__
    while trace:
        file = trace.tb_frame.f_code.co_filename
        if re.fullmatch(r"<cell \d+>", file):
            where = f" in line {trace.tb_lineno}" + ("" if file == f"<cell {number}>" else f" of {file[1:-1]}")
        trace = trace.tb_next
    return where


def _said(problem, where):
    """Return an error in one line."""
    kind = type.__dict__["__name__"].__get__(type(problem))
    try:
        words = problem.msg if isinstance(problem, SyntaxError) else str.__str__(str(problem))
        words = " ".join(words[: 4 * MOST_CHARACTERS].split())[:MOST_CHARACTERS]
    except BaseException:  # their own __str__ may raise anything
        words = "no readable message"
    return f"{kind}{where}: {words}" if words else f"{kind}{where}"
