"""What a motion must be for its series: slow enough for its step, smooth in every mode, and of a size that runs."""

import itertools
import math
from collections import defaultdict

import numpy as np

from ...errors import LongStepError, ProgramError, ProgramLimitError
from ..algebra.tangents import tangents
from ..ir.operations import OPERATIONS
from ..ir.options import MOST_SUBSTEPS, proposed
from ..ir.program import LEAVES
from ..ir.trace import reachable

#: orders of the series: for linear motions what the truncation asks for, else what also serves products and functions
ORDERS = {"f64": (6, 16), "f32": (4, 9)}
#: of the builder of a tick, those that nothing needs included
MOST_INSTRUCTIONS = 200_000
#: modes looked at: all combinations of up to this many cases, then one case changed at a time
_MOST_COMBINED = 6
#: live parameters of which all combinations of the ends of their ranges are looked at
_MOST_ENDS = 4


def numbers(instructions, given):
    """A function that evaluates positions of an instruction list; leaves come from ``given``: dict (op, index) -> float."""
    known = {}

    def number(p):
        with np.errstate(all="ignore"):
            for k in reachable(instructions, [p], known):
                known[k] = _value(instructions[k], known, given)
        return known[p]

    return number


def _value(i, known, given):
    if i.op == "const":
        return np.bool_(i.value) if i.type == "bool" else np.float64(i.value)
    if i.op in LEAVES:
        return np.float64(given.get((i.op, i.index), math.nan))
    return OPERATIONS[i.op].compute(*(known[a] for a in i.args))


def leaf_of(value):
    """What a leaf is: (op, index)."""
    i = value.builder.instructions[value.id]
    return i.op, i.index


def cases_of(motion, modes, states, given):
    """Leaf -> number or array, at each of some points: what the leaves of a motion are in its modes at its states.

    Parameters
    ----------
    motion : Motion
    modes : sequence of dict leaf -> value, one a point
    states : sequence of (q, w, s), one a point
    given : dict (op, index) -> number
        What parameters, inputs and states are; nan those that are not given.
    """
    leaves = [leaf_of(v) for v in (*motion.q, *motion.w, *motion.s)]
    columns = zip(*([*q, *w, *s] for q, w, s in states), strict=True)
    found = (
        defaultdict(lambda: math.nan, given) | {leaf_of(motion.tau): 0.0} | dict(zip(leaves, map(np.array, columns), strict=True))
    )
    return found | {leaf_of(leaf): np.array([mode[leaf] for mode in modes]) for leaf in (modes[0] if modes else ())}


def jacobian(motion, cases, points):
    """The matrix of the motion's rates at each of some points, shape (points, 2 n + m, 2 n + m)."""
    leaves, n = [leaf_of(v) for v in (*motion.q, *motion.w, *motion.s)], len(motion.q)
    rates = [rate.id for rate in (*motion.a, *motion.ds)]
    J = np.zeros((points, len(leaves), len(leaves)))
    J[:, :n, n : 2 * n] = np.eye(n)
    J[:, n:] = np.moveaxis(tangents(motion.builder.instructions, rates, cases, leaves, points)[1], 2, 0)
    return J


def onto_surfaces(motion, cases, points):
    """The cases, those that cannot be in their modes moved onto the surfaces that they would have to lie beyond."""
    places = [leaf_of(v) for v in motion.q]
    for g in motion.guards:
        if g.kind == "side" and places:
            values, slopes = tangents(motion.builder.instructions, [g.measure.id], cases, places, points)
            value, along = values[0], slopes[0]
            with np.errstate(all="ignore"):  # at the tip of a root there is no slope to follow
                step = value * along / (along * along).sum(axis=0)
            beyond = ((value < 0) != cases[leaf_of(g.leaf)]) & along.any(axis=0) & np.isfinite(along).all(axis=0)
            cases = cases | {q: np.where(beyond, cases[q] - moved, cases[q]) for q, moved in zip(places, step, strict=True)}
    return cases


def modes_of(motion):
    """Yield every combination of cases as dict leaf -> value; one at a time where there are too many. Nothing is held."""
    guards = [(g.leaf, 0.0) if g.kind == "floor" else (g.leaf, None) for g in motion.guards]
    sides = [(r.side, None) for r in motion.reactions if r.side is not None]
    fixed = {leaf: value for leaf, value in guards if value is not None}
    choices = [leaf for leaf, value in (*guards, *sides) if value is None]
    combined = itertools.product((False, True), repeat=min(len(choices), _MOST_COMBINED))
    for values in combined:
        padded = [*values, *[False] * (len(choices) - len(values))]
        yield _free(motion, fixed | {leaf: np.bool_(v) for leaf, v in zip(choices, padded, strict=True)})
    for late in choices[_MOST_COMBINED:]:
        yield _free(motion, fixed | {leaf: np.bool_(leaf is late) for leaf in choices})


def _free(motion, modes):
    """Add the reactions of a free motion: a mixture is one of its cases, every other reaction nothing."""
    for r in motion.reactions:
        mixed = r.side is not None and r.lean is not r.leaf
        modes[r.leaf] = np.float64(modes[r.side] if mixed else 0.0)
    return modes


def frequency(motion, states, given, linear=True):
    """The largest |eigenvalue| [rad/s] of the motion over its modes and some states; nan where it is not known.

    Where it is not linear, a mode that a state cannot be in is looked at where it begins; of the states after the first,
    those where it has no finite rates do not count. ``given`` as :func:`cases_of` takes it.
    """
    modes, largest = list(modes_of(motion)), 0.0
    for place, at in enumerate(states):
        cases = cases_of(motion, modes, [at] * len(modes), given)
        J = jacobian(motion, cases if linear else onto_surfaces(motion, cases, len(modes)), len(modes))
        known = np.isfinite(J).all(axis=(1, 2))
        if not (place or known.all()):
            return math.nan
        largest = max(largest, np.abs(np.linalg.eigvals(J[known])).max(initial=0.0))
    return float(largest)


def within(ranges, start, count=8):
    """Yield states (q, w, s) like the start, positions anywhere within their declared ranges where these are finite."""
    q, w, s = start
    bounded = [k for k, limits in enumerate(ranges) if np.isfinite(limits).all()]
    generator = np.random.default_rng(13)
    for _ in range(count if bounded else 0):
        at = list(q)
        for k in bounded:
            at[k] = generator.uniform(*ranges[k])
        yield at, w, s


def live_in(motion, parameters):
    """The live parameters that the rates of a motion depend on, of all ``parameters`` of its scene."""
    instructions = motion.builder.instructions
    reached = reachable(instructions, [rate.id for rate in (*motion.a, *motion.ds)])
    return [parameters[k] for k in sorted({instructions[p].index for p in reached if instructions[p].op == "param"})]


def extremes(parameters):
    """Yield name -> value at the ends of those declared ranges that are finite: all together, of many each alone.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, b = hl.parameters("k b", units="N/m N*s/m", ranges={"k": (50, 200)})
    >>> list(extremes([k, b]))
    [{'k': 50.0}, {'k': 200.0}]
    """
    ends = {p.name: (p.low, p.high) for p in parameters if math.isfinite(p.low) and math.isfinite(p.high)}
    if ends and len(ends) <= _MOST_ENDS:
        yield from (dict(zip(ends, values, strict=True)) for values in itertools.product(*ends.values()))
    elif ends:
        yield from ({name: low for name, (low, _) in ends.items()}, {name: high for name, (_, high) in ends.items()})
        yield from ({name: end} for name, both in ends.items() for end in both)


def check_step(omega, T, substeps, name, live=()):
    """Refuse a step in which the fastest part of the motion turns by more than a radian.

    ``live`` has the values of live parameters, name -> value, at which it is looked at; else they are those bound.
    """
    if omega * T / substeps > 1.0:
        shown = ", ".join(f"{parameter} = {live[parameter]:g}" for parameter in live)
        where = f"at {shown}, a value that is allowed while it runs, " if live else ""
        cure = f", declare a narrower range, or leave {', '.join(live)} out of live=" if live else ""
        more = proposed(omega * T, "a shorter T or, for what is linear, method='exact'")
        raise LongStepError(
            f"{name}: {where}its fastest part turns with omega = {omega:.4g} rad/s, by omega T/substeps = "
            f"{omega * T / substeps:.3g} rad in a step of {T / substeps:g} s; method='taylor' needs at most 1. Use {more}{cure}",
            math.ceil(omega * T) if omega * T <= MOST_SUBSTEPS else None,
        )


def around(start, ranges, bound):
    """Yield states (q, w, s) at which a motion that is not linear may be faster than at its start: at rest, and at zero.

    A friction tanh(w/v_s) is steep where the rate passes zero. Positions are set to zero only where ``bound``, a
    constraint, does not tie them and their declared ranges hold it.
    """
    q, w, s = start
    centre = [value if bound or low > 0 or high < 0 else 0.0 for value, (low, high) in zip(q, ranges, strict=True)]
    rest = [0.0] * len(w)
    yield from ((*at, s) for at in ((q, rest), (centre, w), (centre, rest)) if at != (q, w))


def order_for(omega_h, real, linear):
    """The order at which the series of a motion is cut: its rest is below the rounding of the type.

    A linear motion leaves (omega h)^(N+1)/(N+1)!; it is taken for twice its frequency, so that a live parameter may
    grow fourfold. Others converge as a geometric series does, and get the largest order.

    Examples
    --------
    >>> order_for(0.1, "f64", linear=True), order_for(0.1, "f32", linear=True), order_for(0.1, "f64", linear=False)
    (11, 6, 16)
    """
    low, high = ORDERS[real]
    if not linear or omega_h != omega_h:
        return high
    rest, rounding = min(2.0 * omega_h, 1.0), {"f64": 2.0**-53, "f32": 2.0**-24}[real]
    order = 1
    term = rest * rest / 2.0
    while term > rounding and order < high + 4:
        order += 1
        term *= rest / (order + 1)
    return max(low, order)


def is_linear(motion, measures=()):
    """Whether the motion of every mode is linear in its state, driven by polynomials of time at most; measures too."""
    instructions = motion.builder.instructions
    reached = reachable(instructions, [value.id for value in (*motion.a, *motion.ds, *measures)])
    mixed = _mixed(motion, reached)
    moving = {leaf.id for leaf in (*motion.q, *motion.w, *motion.s, *(r.leaf for r in motion.reactions))}
    timely = {motion.tau.id}
    for p in reached:
        if p in mixed:
            moving.add(p)
            continue
        i = instructions[p]
        which = [a in moving or a in timely for a in i.args]
        if not any(which):
            continue
        moves = not moving.isdisjoint(i.args)
        (moving if moves else timely).add(p)
        product = sum(which) == 1 or not moves
        rules = {"neg": True, "add": True, "sub": True, "mul": product, "div": not which[-1], "select": not which[0]}
        if not rules.get(i.op, False):
            return False
    return True


def _mixed(motion, reached):
    """The products, of a mixture of cases and the jump between them, that stand for the mixture's unknown.

    Free, a mixture is 0 or 1, and its product no more than the jump is. Held, the product is what keeps a coordinate at
    rest, as linear as an unknown friction is: where the mixture enters nowhere else, and nothing of the jump moves then.
    """
    instructions, found = motion.builder.instructions, set()
    leaves = {leaf.id for leaf in (*motion.q, *motion.w, *motion.s, motion.tau, *(r.leaf for r in motion.reactions))}
    for k, number in motion.stops.items():
        leaf, users = motion.reactions[number].leaf.id, []
        if number >= motion.given and k < len(motion.w):
            users = [p for p in reached if leaf in instructions[p].args]
        if len(users) == 1 and instructions[users[0]].op == "mul":
            jump = [a for a in instructions[users[0]].args if a != leaf]
            if leaves & {*reachable(instructions, jump)} <= {motion.q[k].id, motion.w[k].id} and jump:
                found.add(users[0])
    return found


def check_size(motion, builder, name, method="taylor"):
    """Refuse a motion with more surfaces than a program can follow."""
    if len(builder.instructions) > MOST_INSTRUCTIONS:
        surfaces = len(motion.guards) + len(motion.reactions)
        fewer = "fewer of them, a lower order or fewer events" if method == "taylor" else "fewer of them or a shorter T"
        raise ProgramLimitError(
            f"{name}: method={method!r} follows {surfaces} surfaces (cases, Max, Min, contacts) through every piece of a step, "
            f"which is more than {MOST_INSTRUCTIONS} instructions; needs {fewer}, method=Taylor(order=6, events=1), or "
            "method='rk4' with substeps"
        )


def check_smooth(motion, name):
    """Refuse a root or logarithm that starts from zero on a surface: it has no Taylor series there."""
    instructions = motion.builder.instructions
    edges = {frozenset((g.first.id, g.second.id)) for g in motion.guards if g.kind == "side"}
    zero = motion.builder.const(0.0, motion.builder.real).id

    def vanishes(p):
        """Whether a value is zero on a surface: a factor of it is, or one of its cases."""
        i = instructions[p]
        if p == zero or frozenset((p, zero)) in edges:
            return True
        if i.op == "sub":
            return frozenset(i.args) in edges
        parts = {"neg": i.args, "mul": i.args, "div": i.args[:1], "select": i.args[1:], "sqrt": i.args}
        return any(map(vanishes, {*parts.get(i.op, ())}))

    for p in reachable(instructions, [rate.id for rate in (*motion.a, *motion.ds)]):
        if instructions[p].op in ("sqrt", "log") and vanishes(instructions[p].args[0]):
            raise ProgramError(
                f"{name}: a fractional power or a logarithm of a quantity that is zero on a surface, such as d**(3/2) at "
                "touch or sqrt(Abs(y)), has no Taylor series there. method='taylor' needs whole exponents: use exponent=1 "
                "or 2, or method='rk4' with ten substeps per contact"
            )
