"""Which statements of a notebook the answers need, so that most submissions are graded without running all of it.

A slice must never make a wrong answer right; that it makes a right one wrong costs a run of the whole notebook. So what
may change a needed value belongs to it, what may keep a cell from getting as far as a needed statement does, and where a
statement of a slice fails, the slice gives no answer at all.
"""

import ast
from dataclasses import dataclass, replace
from functools import lru_cache

from .cells import run_cell, runnable
from .statement_effects import STATE, Reads, reads_of
from .unchanging_names import BUILTINS, is_solid, makes_called

#: of more the whole notebook runs at once: telling them apart would take longer
MOST = 1000
AWAIT = ast.PyCF_ALLOW_TOP_LEVEL_AWAIT


@dataclass
class _Statement:
    """Statements that share lines are one; its names carry how often they were bound anew before, ("k", 0), ("k", 1)."""

    cell: int
    first: int
    last: int
    nodes: list
    text: str = ""
    reads: frozenset = frozenset()
    binds: frozenset = frozenset()
    touches: frozenset = frozenset()
    alters: frozenset = frozenset()
    later: frozenset = frozenset()
    sets: frozenset = frozenset()
    always: bool = False
    harmless: bool = False


def needed(cells, names):
    """Return the statements at the top level of cells that the answers of these names need, in order.

    Parameters
    ----------
    cells : sequence of str
    names : sequence of str

    Returns
    -------
    list of (int, int, int), or None
        Place of the cell, from 0, and first and last line, from 1. None where the code does not tell which.

    Examples
    --------
    >>> needed(["import math\\nimport numpy", "r = 3", "print(r)", "area = math.pi * r**2", "r = 4"], ["area"])
    [(0, 1, 1), (1, 1, 1), (3, 1, 1)]
    """
    statements = [one for place, source in enumerate(cells) for one in _statements(place, source)]
    if len(statements) > MOST:
        return None
    found = [_reads_in(one.text) for one in statements]
    if any(one.opaque for one in found):
        return None
    others = {name for one in found for name in one.binds - set(one.imports)}
    imports = {name: what for one in found for name, what in one.imports.items() if name not in others}
    found = [replace(one, now=one.now | _states(one, imports)) for one in found]
    last = _number(statements, found)
    for one in statements:
        one.always |= any(name in imports for name, _ in one.alters)  # who sets a part of a module sets it for everybody
    belongs = _closure(statements, {(name, last.get(name, 0)) for name in names}, _changing(statements, imports))
    return [(one.cell, one.first, one.last) for place, one in enumerate(statements) if place in belongs]


def _states(one, imports):
    """Names that stand for the states a statement reaches by what was imported."""
    words = (word for name in one.now | one.later for word in imports.get(name, "").split("."))
    return {STATE[word] for word in words if word in STATE}


def _statements(place, source):
    """Return the statements of a cell; of one that is no Python, none."""
    source = runnable(source)
    try:
        tree = _parsed(source)
        compile(tree, "", "exec", AWAIT, dont_inherit=True)
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return []
    found, lines = [], source.split("\n")
    for node in tree.body:
        first = min([node.lineno, *(one.lineno for one in getattr(node, "decorator_list", ()))])
        if found and first <= found[-1].last:
            found[-1].last = node.end_lineno
            found[-1].nodes.append(node)
        else:
            found.append(_Statement(place, first, node.end_lineno, [node]))
    for one in found:
        one.text = "\n".join(lines[one.first - 1 : one.last])
    return found


def _parsed(source):
    return compile(source, "", "exec", ast.PyCF_ONLY_AST | AWAIT, dont_inherit=True)


@lru_cache(maxsize=4 * MOST)
def _reads_in(text):
    """Effects of statements on the same lines; those of the lab's own notebook are known before a session."""
    return _merged([reads_of(node) for node in _parsed(text).body])


def _merged(several):
    """Effects of statements on the same lines, together."""
    if len(several) == 1:
        return several[0]
    merged = Reads(star=any(one.star for one in several), opaque=any(one.opaque for one in several))
    for name in (
        "now",
        "later",
        "binds",
        "alters",
        "sets",
        "imports",
    ):  # nothing is bound anew for sure, nothing is only shown
        for one in several:
            getattr(merged, name).update(getattr(one, name))
    return merged


def _number(statements, found):
    """Give names their numbers, from which it follows which binding a statement reads; return the last ones.

    A function reads when it is called, which may be after any later binding. What a name was may be touched under the same
    name later: the binding between may fail.
    """
    last = {}
    for one in found:
        for name in one.rebinds:
            last[name] = last.get(name, 0) + 1
    count = dict.fromkeys(last, 0)
    for statement, one in zip(statements, found, strict=True):
        later = {(name, n) for name in one.later for n in range(count.get(name, 0), last.get(name, 0) + 1)}
        statement.reads = frozenset({(name, count.get(name, 0)) for name in one.now} | later)
        acted = ((name, n) for name, n in statement.reads if name not in one.shown)
        statement.touches = frozenset((name, older) for name, n in acted for older in range(n + 1))
        statement.alters = frozenset(read for read in statement.reads if read[0] in one.alters)
        for name in one.rebinds:
            count[name] += 1
        statement.sets = frozenset(bound for bound in later if bound[0] in one.sets)
        statement.binds = frozenset((name, count.get(name, 0)) for name in one.binds) | statement.sets
        statement.later, statement.always, statement.harmless = frozenset(later), one.star, one.harmless
    return last


def _changing(statements, imports):
    """Return the names whose values may change without being bound anew."""
    binders = {}
    for statement in statements:
        for bound in statement.binds:
            binders.setdefault(bound, []).append(statement)
    solid = set(binders).difference(*(statement.sets for statement in statements))
    makers = {bound: [node for one in several for node in one.nodes] for bound, several in binders.items()}
    called = {bound for bound, nodes in makers.items() if all(makes_called(node, imports) for node in nodes)}
    while True:
        lost = {
            bound
            for bound in solid
            for statement in binders[bound]
            if not _is_solid(statement, {read for read in statement.reads if read in binders}, solid, called, imports)
        }
        if not lost:
            return set(binders) - solid
        solid -= lost


def _is_solid(statement, reads, solid, called, imports):
    """Return whether what a statement binds can only be bound anew; a function that uses what changes can change that."""
    if statement.later & (reads - solid | statement.alters):
        return False
    names = _all_in(solid, reads) | {f"{name}()" for name in _all_in(solid & called, reads)}
    if not BUILTINS.isdisjoint(name for name, _ in reads):  # the notebook has one of its own
        return False
    return all(is_solid(node, names, imports) for node in statement.nodes)


def _all_in(kept, reads):
    """Return the names that are kept with each number under which they are read."""
    return {name for name, _ in reads & kept} - {name for name, _ in reads - kept}


def _closure(statements, wanted, changing):
    """Return the places of the statements that belong to what is wanted at the end.

    A name is wanted until a place. What runs only because a later statement of its cell needs it wants its names until it
    runs; what happens to them afterwards does not belong.
    """
    end, grown = len(statements), True
    values, objects = dict.fromkeys(wanted | {("<settings>", 0)}, end), {}  # name -> place until which it is wanted
    belongs, furthest = {}, {}
    while grown:
        grown = False
        for place, one in reversed(list(enumerate(statements))):
            changed = one.alters | {name for name in one.touches if _changes([name], changing)}
            until = end if one.always else max(_latest(values, one.binds | changed), _latest(objects, changed))
            runs = place < furthest.get(one.cell, 0) and not one.harmless
            if max(until, place) <= belongs.get(place, -1) or not (until > place or runs):
                continue
            belongs[place], grown = max(until, place), True
            furthest[one.cell] = max(place, furthest.get(one.cell, 0))
            _want(values, one.reads, belongs[place])
            if until > place and _changes(one.reads | one.binds, changing):
                # what changes may be reached under each name that it binds: all that changes it there belongs as well
                _want(objects, one.binds, until)
    return belongs


def _latest(wanted, names):
    return max((wanted.get(name, 0) for name in names), default=0)


def _want(wanted, names, until):
    wanted.update((name, max(until, wanted.get(name, 0))) for name in names)


def _changes(names, changing):
    """Return whether one of these names may change, or stands for a state that has no name."""
    return any(name in changing or name[0].startswith("<") for name in names)


def run_pieces(cells, pieces, names):
    """Run pieces of cells; where one fails, the names are emptied, for what is left may be what nobody wrote.

    Parameters
    ----------
    cells : sequence of str
    pieces : sequence of (int, int, int)
        As :func:`needed` gives them.
    names : dict

    Returns
    -------
    str
        The first problem; empty where all ran.

    Examples
    --------
    >>> names = {}
    >>> run_pieces(["k = 2\\nprint(k)\\nb = 3 * k"], [(0, 1, 1), (0, 3, 3)], names), names["b"]
    ('', 6)
    """
    for place in dict.fromkeys(place for place, _, _ in pieces):
        kept = {row for cell, first, last in pieces if cell == place for row in range(first - 1, last)}
        lines = runnable(cells[place]).split("\n")
        problem = run_cell("\n".join(line if row in kept else "" for row, line in enumerate(lines)), names, place + 1)
        if problem:
            names.clear()
            return problem
    return ""
