"""The student's own statement: the last one, of a cell or a file, that led to an error or calls now."""

from __future__ import annotations

import ast
import builtins
import linecache
import os
import re
import sys
import textwrap
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from types import CodeType, FrameType, ModuleType, TracebackType
from typing import Any

PACKAGE = Path(__file__).parents[1]
#: where Python and installed packages lie; a student's code may lie below the former, in an environment's folder
STANDARD, INSTALLED = Path(os.__file__).parent, ("site-packages", "dist-packages")
#: code that Python and others make
MADE = ("<frozen", "<lambdify", "<string", "<__array_function__")
MOST_LINES = 12


@dataclass(frozen=True)
class OwnLine:
    """A place in a student's code.

    Attributes
    ----------
    frame : frame
        With the names that the statement can see.
    span : (int, int)
        Offsets of the first and the last character of what was running, in the source.
    line : int
        That was running.
    """

    frame: FrameType
    span: tuple[int, int]
    line: int

    @property
    def file(self) -> str:
        """As Python names it."""
        return self.frame.f_code.co_filename

    @cached_property
    def source(self) -> list[str]:
        """Every line of the cell or file."""
        return linecache.getlines(self.file, self.frame.f_globals)

    @cached_property
    def statement(self) -> ast.stmt | None:
        """The innermost statement that holds the line; None where there is no source to read."""
        around = [s for s in ast.walk(parsed("".join(self.source))) if isinstance(s, ast.stmt) and self.line in _lines(s)]
        return min(around, key=lambda s: len(_lines(s)), default=None)

    @property
    def text(self) -> str:
        """The statement as it is written; of one with a body, its head."""
        lines = _lines(self.statement) if self.statement else range(self.line, self.line + 1)
        shown = "".join(self.source[lines.start - 1 : lines.stop - 1][:MOST_LINES])
        return textwrap.dedent(shown).rstrip() + ("\n..." if len(lines) > MOST_LINES else "")

    @property
    def where(self) -> str:
        """Such as "cell 3, line 2" or "wall.py, line 2"."""
        return f"{self.place}, line {self.line}"

    @property
    def place(self) -> str:
        """The cell or file."""
        shell = builtins.get_ipython() if hasattr(builtins, "get_ipython") else None
        named = getattr(getattr(shell, "compile", None), "format_code_name", lambda _: None)(self.file)
        return " ".join(named) if named else Path(self.file).name

    def nodes(self) -> list[ast.AST]:
        """What was running and what it is a part of, the innermost first."""
        held = [one for one in self.walk() if hasattr(one, "lineno")]
        first, last = self.span
        around = [one for one in held if self._offset(one)[0] <= first and last <= self._offset(one)[1]]
        return sorted(around, key=lambda one: self._offset(one)[1] - self._offset(one)[0])

    def walk(self) -> list[ast.AST]:
        """Every part of the statement; of one with a body, of its head."""
        body = getattr(self.statement, "body", [])
        left_out = {id(part) for one in body if isinstance(one, ast.stmt) for part in ast.walk(one)}
        return [one for one in ast.walk(self.statement) if id(one) not in left_out] if self.statement else []

    def value(self, node: ast.AST) -> Any:
        """What a name, or names joined by dots, stands for in the student's code; None where nothing is known."""
        if isinstance(node, ast.Attribute):
            owner = self.value(node.value)
            return getattr(owner, node.attr, None) if ours(owner) else None  # another library's attribute may be a computation
        if not isinstance(node, ast.Name):
            return None
        names = self.frame.f_locals, self.frame.f_globals
        return next((known[node.id] for known in names if node.id in known), None)

    def involves_us(self) -> bool:
        """Whether the statement uses anything that hapticlab made."""
        return any(ours(self.value(one)) for one in self.walk() if isinstance(one, ast.Name))

    def same_place(self, one: ast.AST, other: ast.AST) -> bool:
        """Whether two parts are the same text."""
        return self._offset(one) == self._offset(other)

    def _offset(self, node):
        return _at(node.lineno, node.col_offset), _at(node.end_lineno, node.end_col_offset)


def of_error(trace: TracebackType | None) -> OwnLine | None:
    """The last own line that an error passed on its way; None where there is none."""
    found = None
    while trace:
        if _is_own(trace.tb_frame.f_code):
            found = trace
        trace = trace.tb_next
    return _own(found.tb_frame, found.tb_lasti, found.tb_lineno) if found else None


def of_call() -> OwnLine | None:
    """The own line that calls now."""
    frame: FrameType | None = sys._getframe(1)
    while frame and not _is_own(frame.f_code):
        frame = frame.f_back
    return _own(frame, frame.f_lasti, frame.f_lineno) if frame else None


def ours(value: Any, deep: int = 3) -> bool:
    """Whether hapticlab made a value, or a part of it.

    Examples
    --------
    >>> import sympy as sp
    >>> import hapticlab as hl
    >>> ours(2 * hl.x(hl.n)), ours([hl.parameters("k", units="N/m")]), ours(sp.Symbol("k"))
    (True, True, False)
    """
    named = value if isinstance(value, ModuleType | type) or callable(value) else type(value)
    home = named.__name__ if isinstance(named, ModuleType) else str(getattr(named, "__module__", ""))
    if home.partition(".")[0] == "hapticlab":
        return True
    if hasattr(value, "free_symbols") and not isinstance(value, type):  # an expression, of any depth
        return isinstance(getattr(type(value), "unit", None), str) or any(ours(part) for part in value.args)
    parts: list[Any] = []
    if isinstance(value, list | tuple | set):
        parts = list(value)
    elif isinstance(value, dict):
        parts = list(value.values())
    elif type(value).__name__ == "ndarray" and value.dtype == object:
        parts = list(value.flat)
    return deep > 0 and any(ours(part, deep - 1) for part in parts[:20])


def code_of(node: ast.AST) -> str:
    """A part as a student writes it, k*(x(n) - x_o)."""
    return re.sub(r" (\*|//?|\*\*) ", r"\1", ast.unparse(node))


@lru_cache(maxsize=64)
def parsed(source: str) -> ast.Module:
    """The tree of a source; an empty one where it is no Python."""
    try:
        return ast.parse(source)
    except (SyntaxError, ValueError, RecursionError):
        return ast.Module([], [])


def _own(frame, running, line):
    first, end, column, end_column = list(frame.f_code.co_positions())[running // 2]
    start = _at(first or line, column or 0)
    return OwnLine(frame, (start, _at(end or line, end_column) if end_column else start), line)


def _at(line, column):
    """Return one number for a place in a source, in the order of reading."""
    return line * 1_000_000 + column


def _lines(statement):
    """Return the lines of a statement; of one with a body, those of its head."""
    body = [one for one in getattr(statement, "body", []) if isinstance(one, ast.stmt)]
    end = max(statement.lineno + 1, body[0].lineno) if body else statement.end_lineno + 1
    return range(statement.lineno, end)


def _is_own(code: CodeType) -> bool:
    file = Path(code.co_filename)
    if code.co_filename.startswith(MADE) or set(INSTALLED) & set(file.parts):
        return False
    package = file.is_relative_to(PACKAGE) and not file.is_relative_to(PACKAGE / "examples")
    return not package and not file.is_relative_to(STANDARD)
