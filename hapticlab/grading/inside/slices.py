"""Which statements of a notebook the answers need, so that most submissions are graded without running all of it."""

import ast

from .cells import run_cell, runnable


def needed(cells, names):
    """Return the statements at the top level of cells that the answers of these names need, in order.

    Parameters
    ----------
    cells : sequence of str
    names : sequence of str

    Returns
    -------
    list of (int, int, int)
        Place of the cell, from 0, and first and last line, from 1.

    Examples
    --------
    >>> needed(["import math\\nk = 2 * math.pi"], ["k"])
    [(0, 1, 1), (0, 2, 2)]
    """
    return [
        (place, min([node.lineno, *(d.lineno for d in getattr(node, "decorator_list", ()))]), node.end_lineno)
        for place, source in enumerate(cells)
        for node in _tree(source).body
    ]


def _tree(source):
    try:
        return compile(runnable(source), "", "exec", ast.PyCF_ONLY_AST | ast.PyCF_ALLOW_TOP_LEVEL_AWAIT, dont_inherit=True)
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return ast.Module([], [])


def run_pieces(cells, pieces, names):
    """Run pieces of cells; return the first problem, or an empty text.

    Where a piece fails, the rest of its cell is left out, as Jupyter does.
    """
    problems = []
    for place in dict.fromkeys(place for place, _, _ in pieces):
        lines, kept = runnable(cells[place]).split("\n"), set()
        for _, first, last in (piece for piece in pieces if piece[0] == place):
            kept.update(range(first - 1, last))
        source = "\n".join(line if row in kept else "" for row, line in enumerate(lines))
        problems.append(run_cell(source, names, place + 1))
    return next(filter(None, problems), "")
