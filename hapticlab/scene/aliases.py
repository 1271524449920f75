"""Coordinates that an equation defines outright, such as Eq(y, r*z): put in place of their names, in the order they need.

A coordinate alone on the left of an equation without rates is not a state: it is another name of what stands on the
right. It costs nothing then, and a chain of such equations may be written in any order.
"""

import sympy as sp

from ..errors import SceneError
from .notation.symbols import t, v, x


def definitions(equations, coordinates):
    """(Coordinate -> its definition, the other equations), each definition free of defined coordinates.

    Parameters
    ----------
    equations : sequence of sympy.Eq
    coordinates : sequence of q(t)

    Raises
    ------
    SceneError
        Coordinates are defined by each other, one is defined twice, or its start would be lost.

    Examples
    --------
    >>> import hapticlab as hl
    >>> y, z = hl.coordinate("y", unit="m"), hl.coordinate("z", unit="m")
    >>> definitions([sp.Eq(y, 2 * z), sp.Eq(z.diff(hl.t), -z)], (y, z))[0]
    {y(t): 2*z(t)}
    """
    written, rest = {}, []
    for e in equations:
        if e.lhs not in coordinates or e.atoms(sp.Derivative) or e.rhs.has(e.lhs):
            rest.append(e)
            continue
        if e.lhs in written:
            raise SceneError(f"two equations define {e.lhs}: {written[e.lhs]} and {e.rhs}; keep one")
        written[e.lhs] = e.rhs
    _check_starts(written, coordinates)
    solved = {}
    for q in written:
        _solve(q, written, solved, [])
    return solved, rest


def substituted(expr, known):
    """An expression with every defined coordinate, and its rates, put in."""
    if not known or not expr.has(*known):
        return expr
    put = dict(known)
    for d in expr.atoms(sp.Derivative):
        if d.expr in known:
            put[d] = known[d.expr].diff(t, d.derivative_count)
            handle = [a for a in put[d].atoms(sp.Derivative) if isinstance(a.expr, (x, v))]
            if handle:
                raise SceneError(
                    f"{d} is the rate of {known[d.expr]}, which contains the acceleration of the handle, and no sample "
                    "gives that. Give the mass a coordinate of its own behind a coupler"
                )
    return expr.xreplace(put)


def _solve(q, written, solved, on_the_way):
    if q in on_the_way:
        loop = " -> ".join(str(a) for a in [*on_the_way[on_the_way.index(q) :], q])
        raise SceneError(
            f"{loop}: these are defined by each other. Put an equation of motion or a spring between them to break the loop"
        )
    if q not in solved:
        for other in sorted(written[q].atoms(sp.Function) & set(written), key=str):
            _solve(other, written, solved, [*on_the_way, q])
        solved[q] = substituted(written[q], solved)


def _check_starts(written, coordinates):
    for q in coordinates:
        kind = type(q)
        starts = [kind.initial, kind.rate]
        if q in written and starts != [0, 0]:
            raise SceneError(f"{kind.__name__} is defined by {q} = {written[q]}, which also gives its start. Leave out initial=")
        used = next((a for a in written for start in starts if start.has(a)), None)
        if used is not None:
            raise SceneError(f"{kind.__name__} starts at {kind.initial}; write {written[used]} for {used} there")
