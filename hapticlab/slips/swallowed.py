"""What Python has computed before hapticlab sees it, found in the student's own lines: ``1//2`` is 0, ``a == b`` is False."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import lru_cache

from .own_line import OwnLine, code_of, parsed


def swallowed(own: OwnLine, said: str) -> str:
    """The sentence on what is lost in a statement, or where its names were defined; empty where nothing is.

    Parameters
    ----------
    own : OwnLine
    said : str
        The error. A comparison is only told where it speaks of True or False, and a floor where it speaks of one.
    """
    for node in _read(own):
        match node:
            case ast.BinOp(left=ast.Constant(int(a)), op=ast.FloorDiv(), right=ast.Constant(int(b))) if b and a % b:
                return f"Your code has {a}//{b}, which rounds down to {a // b}. Write {a}/{b}."
            case ast.BinOp(left=a, op=ast.FloorDiv(), right=b) if "floor" in said:
                return f"`//` rounds down to a whole number. Write {code_of(a)}/{code_of(b)}."
            case ast.BinOp(left=a, op=ast.BitXor(), right=b) if "condition is not a number" in said:
                return f"`^` is not a power in Python. Write {code_of(a)}**{code_of(b)}."
            case ast.Compare(left=a, ops=[ast.Eq() | ast.NotEq() as op], comparators=[b]) if "True" in said or "False" in said:
                sign, cure = ("==", "sp.Eq") if isinstance(op, ast.Eq) else ("!=", "sp.Ne")
                text = f"{code_of(a)} {sign} {code_of(b)}"
                return f"Your code has {text}, which Python decides at once. Write {cure}({code_of(a)}, {code_of(b)})."
    return ""


def _read(own: OwnLine) -> Iterator[ast.AST]:
    """Yield every part of the statement, and of what defines its names, in the same notebook or file."""
    cells = own.frame.f_globals.get("In")  # what IPython has run so far
    sources = [cell for cell in cells if isinstance(cell, str)] if isinstance(cells, list) else []
    known = _definitions((*sources, "".join(own.source)))
    waiting, seen = [own.walk()], set()
    while waiting:
        for node in waiting.pop(0):
            yield node
            if isinstance(node, ast.Name) and node.id not in seen:
                seen.add(node.id)
                waiting += [list(ast.walk(one)) for one in known.get(node.id, [])]


@lru_cache(maxsize=4)  # a scene after the other is made in the same cells, and to walk them takes longer than to make one
def _definitions(sources: tuple[str, ...]) -> dict[str, list[ast.AST]]:
    """Return the last statement that defines each name, in all cells."""
    found: dict[str, list[ast.AST]] = {}
    for node in (one for source in sources for one in ast.walk(parsed(source))):
        if isinstance(node, ast.FunctionDef):
            found[node.name] = [node]
        for target in getattr(node, "targets", [getattr(node, "target", None)]):
            names = [one.id for one in ast.walk(target) if isinstance(one, ast.Name)] if isinstance(target, ast.AST) else []
            if hasattr(node, "value"):
                found |= {name: [node.value] for name in names}
    return found
