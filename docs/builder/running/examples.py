"""The examples of the pages: every block of Python runs, and what it prints, draws or shows comes to stand below it.

The blocks of a page share their names and run one after the other in a temporary folder. A block is fenced ``python``; one
that must not run is fenced ``py`` and looks the same.
"""

import ast
import contextlib
import io
import re
import tempfile
import warnings
from dataclasses import dataclass, field

import matplotlib as mpl
from cycler import cycler
from matplotlib.figure import Figure

import hapticlab as hl
from hapticlab.base.drawing import HOUSE, STYLES

from . import views

BLOCK = re.compile(r"^```python\n(.*?)^```$\n?", re.M | re.S)
#: where a block of Python begins, however it is fenced
FENCE = re.compile(r"^[ \t]*(?:`{3,}|~{3,})[ \t]*python\b", re.M)
#: lines that differ in grey print too
LINES = cycler(**{key: [style[key] for style in STYLES] for key in ("color", "linestyle")})


class ExampleError(Exception):
    """An example of a page failed."""


@dataclass
class Example:
    """One block of a page that ran: where it ended, what it printed, the figures that it made, the live views that it opened."""

    code: str
    end: int
    printed: str
    figures: list[Figure]
    views: list[dict]


@dataclass
class Page:
    """A page whose examples ran: its text, its examples in order, and the names that they leave."""

    text: str
    examples: list[Example] = field(default_factory=list)
    names: dict[str, object] = field(default_factory=dict)

    @property
    def printed(self):
        """All that the examples printed."""
        return "".join(example.printed for example in self.examples)


def run(text, name):
    """Run the examples of a page.

    Parameters
    ----------
    text : str
        The page.
    name : str
        Its file, for messages.

    Raises
    ------
    ExampleError
        For the first example that raises or warns, with its line, and for one that would not run because of its fence.

    Examples
    --------
    >>> page = run("```python\\na = 2\\n```\\nand\\n```python\\nprint(a + 1)\\n```\\n", "sum.md")
    >>> page.printed, page.names["a"], len(page.examples)
    ('3\\n', 2, 2)
    >>> run("# Title\\n\\n```python\\n1 / 0\\n```\\n", "division.md")
    Traceback (most recent call last):
    builder.running.examples.ExampleError: division.md, line 4: ZeroDivisionError: division by zero
    """
    page, starts = Page(text), {found.start() for found in BLOCK.finditer(text)}
    if missed := [found for found in FENCE.finditer(text) if found.start() not in starts]:
        line = text.count("\n", 0, missed[0].start()) + 1
        raise ExampleError(
            f"{name}, line {line}: only ```python at the beginning of a line, and closed by ```, runs; fence it so"
        )
    settings = mpl.rc_context(HOUSE | {"axes.prop_cycle": LINES, "backend": "agg"})
    with settings, tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), warnings.catch_warnings():
        warnings.simplefilter("error")
        for kind in (DeprecationWarning, PendingDeprecationWarning):  # of other packages among themselves
            warnings.simplefilter("ignore", kind)
        for found in BLOCK.finditer(text):
            page.examples.append(_run_block(found, name, page))
    return page


def _run_block(found, name, page):
    known = {id(value) for value in page.names.values()}
    first_line = page.text.count("\n", 0, found.start(1))
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(io.StringIO()), _noted() as (shown, opened):
            last = _execute(ast.parse("\n" * first_line + found[1], name), name, page.names)
    except (Exception, SystemExit) as problem:
        line = _line(problem, name) or first_line + 1
        raise ExampleError(f"{name}, line {line}: {type(problem).__name__}: {problem}") from problem
    made = [value for value in (*shown, *page.names.values(), last) if isinstance(value, Figure) and id(value) not in known]
    return Example(found[1], found.end(), printed.getvalue(), list(dict.fromkeys(made)), opened)


def _execute(tree, name, names):
    """Execute a block as a notebook does; return the value of its last line where that is an expression."""
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, name, "exec"), names)
    return eval(compile(ast.Expression(last.value), name, "eval"), names) if last else None


def _line(problem, name):
    """Return the last line of the page that led to a problem."""
    if isinstance(problem, SyntaxError):
        return problem.lineno
    lines, trace = [], problem.__traceback__
    while trace:
        if trace.tb_frame.f_code.co_filename == name:
            lines.append(trace.tb_lineno)
        trace = trace.tb_next
    return lines[-1] if lines else None


@contextlib.contextmanager
def _noted():
    """Note what ``hl.show`` and ``hl.live`` are asked to show, since a page shows it in its own way."""
    shown, show = [], hl.show

    def noted_show(figure, *, alt):
        figure.alt = alt
        shown.append(figure)

    hl.show = noted_show
    try:
        with views.noted() as opened:
            yield shown, opened
    finally:
        hl.show = show
