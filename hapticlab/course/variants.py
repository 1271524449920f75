"""For authors of exercises: points for an expression, and what typical slips give of a right answer.

It works where the right answer is known: while a lab is written, and in the grader's own process for hidden cases. What
a lab hands out holds numbers and sentences alone.
"""

from itertools import islice

import numpy as np
import sympy as sp

from ..scene.notation.symbols import n
from ..scene.scene import Scene
from .evaluate import evaluate
from .expression import spelling, symbols

ROUND = {sp.Gt: sp.Lt, sp.Ge: sp.Le, sp.Lt: sp.Gt, sp.Le: sp.Ge}
#: changes tried of one answer: a scene takes tens of milliseconds for each
MOST_CHANGES = 60


def points(random, ranges, count=4, boundary=()):
    """Draw points for an expression: some at random, some that differ in one symbol alone, some at a boundary.

    Parameters
    ----------
    random : numpy.random.Generator
    ranges : dict of str to (low, high)
        Of each symbol, as :mod:`hapticlab.course.expression` spells it. Two answers count as the same where they agree in
        these ranges: ``sqrt(k**2)`` is ``k`` where k is drawn above 0.
    count : int
        Points at random.
    boundary : (str, str), optional
        Two symbols that meet there, such as ``("x(n)", "x_o")``: the first is put just below, on and just above the second.
        The point from which one symbol alone differs has the first above the second, where a wall acts.

    Returns
    -------
    dict of str to list of float

    Examples
    --------
    >>> at = points(np.random.default_rng(1), {"x(n)": (0, 0.02), "x_o": (0, 0.01)}, count=2, boundary=("x(n)", "x_o"))
    >>> len(at["x(n)"]), at["x(n)"][-2] == at["x_o"][-2]
    (7, True)
    """

    def drawn():
        return {name: float(random.uniform(*given)) for name, given in ranges.items()}

    found = [drawn() for _ in range(count)]
    if boundary:
        moved, fixed = boundary
        found[0][moved] = float(random.uniform(found[0][fixed], ranges[moved][1]))
    found += [{**found[0], name: drawn()[name]} for name in ranges]
    if boundary:
        point = drawn()
        near = 1e-3 * (ranges[moved][1] - ranges[moved][0])
        found += [{**point, moved: point[fixed] + step} for step in (-near, 0.0, near)]
    return {name: [point[name] for point in found] for name in ranges}


def slips(exercise, solution, given):
    """Wrong answers by typical slips, from a right answer that is an expression, an equation or a scene.

    Signs of terms are turned, terms and parameters left out, conditions turned round or left out, degrees put for radians,
    samples taken one late; in a scene in the force, in the equations of motion, or in both.

    Returns
    -------
    tuple of (wrong, sentence)
        As a case takes them; slips that give what is right, nothing at all, or the same as another are left out.
    """
    right = evaluate(exercise.kind, solution, given).value
    known, found = [right], []
    for sentence, changed in islice(_changed(solution), MOST_CHANGES):
        wrong = evaluate(exercise.kind, changed, given).value
        if wrong is None or any(_same(wrong, one) for one in known) or not np.any(_numbers(wrong)):
            continue
        known.append(wrong)
        found.append((wrong, sentence))
    return tuple(found)


def _numbers(value):
    return np.concatenate([np.ravel(part) for part in value.values()]) if isinstance(value, dict) else np.ravel(value)


def _same(one, other):
    return np.allclose(_numbers(one), _numbers(other), rtol=1e-6, atol=1e-12, equal_nan=True)


def _changed(solution):
    """Yield (sentence, solution with that slip)."""
    if isinstance(solution, Scene):
        equations = [one for one in solution.eom if isinstance(one, sp.Eq)]
        for sentence, change in _changes([solution.force, *equations]):
            force, eom = solution.force.xreplace(change), [_put(one, change) for one in solution.eom]
            yield sentence, _scene(solution, force, eom)
            if equations:
                yield f"{sentence} (in the force)", _scene(solution, force, solution.eom)
                yield f"{sentence} (in the equation of motion)", _scene(solution, solution.force, eom)
    elif isinstance(solution, list | tuple):
        for sentence, change in _changes(solution):
            yield sentence, [_put(one, change) for one in solution]
    elif isinstance(solution, sp.Basic):
        for sentence, change in _changes([solution]):
            yield sentence, _put(solution, change)


def _put(part, change):
    return part.xreplace(change) if isinstance(part, sp.Basic) else part


def _scene(scene, force, eom):
    """Return a function that makes the scene: what its units refuse is refused where it is evaluated, and left out."""
    return lambda: Scene(force=force, eom=eom, watch=scene.watch, values=scene.values)


def _changes(expressions):
    """Yield (sentence, what to replace by what) of slips in expressions."""
    nodes = list(dict.fromkeys(node for one in expressions for node in sp.preorder_traversal(one)))
    for node in sorted({symbol for one in expressions for symbol in symbols(one)}, key=spelling):
        name = spelling(node)
        if isinstance(node, sp.Symbol):
            yield f"You forgot {name}: your answer is the result with {name} = 0.", {node: sp.S.Zero}
        elif n in node.free_symbols:
            late = node.xreplace({n: n - 1})
            yield f"You wrote {spelling(late)} instead of {name}.", {node: late}
    for node in nodes:
        if isinstance(node, sp.Add):
            yield from _of_sum(node)
        elif type(node) in ROUND:
            yield "The condition is reversed.", {node: ROUND[type(node)](*node.args)}
            yield "The condition is missing: it acts everywhere.", {node: sp.true}
        elif isinstance(node, sp.sin | sp.cos | sp.tan):
            (angle,) = node.args
            yield "An angle in radians was treated as degrees.", {node: node.func(angle * sp.pi / 180)}
            yield "An angle is in degrees, but it must be in radians.", {node: node.func(angle * 180 / sp.pi)}
            if not isinstance(node, sp.tan):
                yield "sin and cos are swapped.", {node: (sp.cos if isinstance(node, sp.sin) else sp.sin)(angle)}


def _of_sum(total):
    for term in total.args:
        held = ", ".join(sorted({spelling(symbol) for symbol in symbols(term)}))
        if held:
            yield f"The sign of the term with {held} is wrong.", {total: total - 2 * term}
            yield f"The term with {held} is missing.", {total: total - term}
