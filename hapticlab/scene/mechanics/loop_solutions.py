"""Embed holonomic constraints in closed form: which coordinates drive, and each other one as an expression of those.

A loop that is solved so cannot drift apart: its constraint holds to rounding, whatever the integrator does. The loops
are solved one dyad after another (:mod:`hapticlab.scene.mechanics.loop_dyads`), with the drivers that close them over
their whole range.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef

from ...errors import SceneError
from ..notation.symbols import t, v, x
from .loop_closure import Open, check_range, declared_range, in_unit, is_coordinate, name, shown, values, wraps
from .loop_dyads import Equations
from .loop_terms import NotClosed, number

#: initial values that are written with seven digits agree with the constraint
AGREEING = 1e-6
#: drivers tried before a loop is left to other methods
ATTEMPTS = 12


@dataclass(frozen=True)
class Embedding:
    """Holonomic constraints, solved.

    Attributes
    ----------
    drivers : tuple of coordinates
        What remains free.
    groups : tuple of (constraints, steps)
        One constraint that solves one coordinate, or two that solve two, in terms of the drivers and of the groups
        before.
    wraps : frozenset of coordinates
        Angles that jump by a turn somewhere on the range: their cosine and sine may be used, the angle itself not.
    """

    drivers: tuple
    groups: tuple
    wraps: frozenset = frozenset()

    @property
    def steps(self):
        """The dependent coordinates in order, each a :class:`~hapticlab.scene.mechanics.loop_dyads.Step`."""
        return tuple(step for _, steps in self.groups for step in steps)

    @property
    def driven_by(self):
        """What the dependent coordinates follow, in words: drivers, the handle, time; empty where they stay."""
        values = sp.Tuple(*(step.value for step in self.steps))
        timed = values.xreplace({f: sp.Dummy() for f in values.atoms(AppliedUndef, x, v)}).has(t)
        others = {"the handle": values.has(x, v), "time": timed}
        found = [*(name(q) for q in self.drivers if values.has(q)), *(what for what, has in others.items() if has)]
        return ", ".join(found)

    def __str__(self):
        lines = [f"driven by {self.driven_by}"] if self.driven_by else []
        return "\n".join([*lines, *(f"{name(s.coordinate)} = {s.value}" for s in self.steps)])


def is_holonomic(constraint):
    """Whether a constraint holds positions and time alone."""
    return not constraint.has(sp.Derivative, v)


def embed(constraints, coordinates, start):
    """The :class:`Embedding` of holonomic constraints.

    Parameters
    ----------
    constraints : sequence of expressions
        Each is zero.
    coordinates : sequence of coordinates
        A declared range is the range that is checked; an angle without one is checked over a turn.
    start : dict
        Every coordinate, parameter, x(t) and t -> its value at the start [SI].

    Raises
    ------
    NotClosed
        No choice of drivers gives a closed form that is known here and holds over the range.
    SceneError
        The start is off a constraint; or the loops cannot close over a range that was declared.

    Examples
    --------
    >>> import hapticlab as hl, sympy as sp
    >>> L = hl.parameters("L", units="m")
    >>> phi, z = hl.coordinate("phi", unit="rad"), hl.coordinate("z", unit="m")
    >>> print(embed([z - L * sp.sin(phi)], [phi, z], {L: 0.1, phi: 0.0, z: 0.0}))
    driven by phi
    z = L*sin(phi(t))
    """
    drivers, groups, wrapping = [], [], set()
    for group, held in _groups(constraints, coordinates):
        found = _embed_group(group, held, start) if group else Embedding(held, ())
        drivers += found.drivers
        groups += found.groups
        wrapping |= found.wraps
    return Embedding(tuple(q for q in coordinates if q in drivers), tuple(groups), frozenset(wrapping))


def _groups(constraints, coordinates):
    """Yield (constraints, coordinates) that have nothing to do with each other."""
    groups = [([], (q,)) for q in coordinates]
    for constraint in constraints:
        joined = [g for g in groups if constraint.has(*g[1])]
        if not joined:
            raise SceneError(f"{constraint} = 0 contains no coordinate, so it constrains nothing; leave it out")
        groups = [g for g in groups if g not in joined]
        groups.append((sum((g[0] for g in joined), [constraint]), sum((g[1] for g in joined), ())))
    order = list(constraints)
    return [(sorted(group, key=order.index), held) for group, held in groups]


def _embed_group(constraints, coordinates, start):
    free = len(coordinates) - len(constraints)
    if free < 0:
        raise NotClosed("there are more constraints than coordinates")
    equations, reasons = Equations(start, _generic(start)), []
    choices = list(itertools.combinations(coordinates, free))
    ranged = [drivers for drivers in choices if drivers and all(map(_has_range, drivers))]
    # several drivers without ranges hardly ever go everywhere: three tries show it
    others = [drivers for drivers in choices if drivers not in ranged][: ATTEMPTS if free < 2 else 3]
    for drivers in (ranged + others)[:ATTEMPTS]:
        # a declared range is a demand: another driver that never gets there is no answer to it
        if len(reasons) == len(ranged) > 0 and all(isinstance(reason, Open) for reason in reasons):
            break
        try:
            sources = _staged(equations, constraints, [q for q in coordinates if q not in drivers])
            check_range(drivers, sources, start)
        except NotClosed as reason:
            reasons.append(reason)
            continue
        _check_start(constraints, sources, start)
        return Embedding(drivers, tuple(sources), wraps(drivers, sources, start))
    if ranged and all(isinstance(reason, Open) for reason in reasons[: len(ranged)]):
        raise SceneError(f"{reasons[0]}. Declare the range it moves in, or change its lengths")
    told = list(dict.fromkeys(map(str, reasons)))[: 3 if free < 2 else 1]
    raise NotClosed("; ".join(told) or "no driver was found")


def _has_range(q):
    return not any(map(math.isinf, declared_range(q)))


def _staged(equations, constraints, unknown):
    """[(Constraints, steps)]: one unknown of one constraint at a time, else two of two."""
    left, open_, found = list(constraints), list(unknown), []
    while left:
        held = {c: [q for q in open_ if c.has(q)] for c in left}
        group, solved = _next(equations, left, held)
        found.append((group, solved))
        left = [c for c in left if c not in group]
        open_ = [q for q in open_ if q not in {step.coordinate for step in solved}]
    return found


def _next(equations, left, held):
    reason = NotClosed("the equations cannot be solved one or two at a time")
    for c in left:
        if not held[c]:
            raise NotClosed(f"{c} = 0 remains when all other equations are solved")
        if len(held[c]) == 1:
            try:
                return (c,), (equations.alone(c, held[c][0]),)
            except NotClosed as why:
                reason = why
    for c, d in itertools.combinations(left, 2):
        both = list(dict.fromkeys(held[c] + held[d]))
        if len(both) == 2:
            try:
                return (c, d), equations.pair(c, d, *both)
            except NotClosed as why:
                reason = why
    raise reason


def _check_start(constraints, sources, start):
    """Refuse a start off the constraints, with the values to take."""
    off = [c for c in constraints if not _agrees(c, start)]
    if not off:
        return
    at = dict(start)
    steps = [step for _, solved in sources for step in solved]
    for step in steps:
        at[step.coordinate] = float(number(step.value, at))
    moving = [q for q in start if is_coordinate(q) and any(c.has(q) for c in off)]
    residuals = ", ".join(f"{float(number(c, start)):.3g}" for c in off)
    wanted = ", ".join(
        in_unit(step.coordinate, at[step.coordinate])
        for step in steps
        if abs(at[step.coordinate] - start[step.coordinate]) > AGREEING
    )
    raise SceneError(
        f"the start {values(moving, start)} does not satisfy the constraint {shown(off)}: its left side is {residuals}. "
        f"Start with {wanted}"
    )


def _agrees(constraint, start):
    terms = [abs(float(number(part, start))) for part in sp.Add.make_args(constraint)]
    return abs(float(number(constraint, start))) <= AGREEING * sum(terms)


def _generic(start):
    """Arbitrary values, for tests of identities."""
    generator = np.random.default_rng(5)
    return {s: float(value * generator.uniform(0.9, 1.1) + generator.uniform(0.01, 0.1)) for s, value in start.items()}
