"""What a motion must be for its series: slow enough for its step, smooth in every mode, and of a size that runs."""

import itertools
import math

import numpy as np

from ...errors import LongStepError, ProgramError, ProgramLimitError
from ..ir.operations import OPERATIONS
from ..ir.options import MOST_SUBSTEPS, proposed
from ..ir.program import LEAVES
from ..ir.structural_zeros import ZERO
from ..ir.trace import reachable
from .taylor_series import Series

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


def _varied(motion, modes, at, number):
    """The series of values and their gradients by (q, w, s), as coefficients 0 and 1."""
    leaves, values = [*motion.q, *motion.w, *motion.s], [*at[0], *at[1], *at[2]]
    rows = {leaf.id: [np.float64(value), unit] for leaf, value, unit in zip(leaves, values, np.eye(len(leaves)), strict=True)}
    # float zeros of numpy: what divides by them is inf, as on every engine
    rows[motion.tau.id] = [ZERO, ZERO]
    rows |= {leaf.id: [value, ZERO] for leaf, value in modes.items()}
    return Series(motion.builder.instructions, rows, number)


def jacobian(motion, modes, at, number):
    """The matrix of the motion's rates at a state (q, w, s), shape (2 n + m, 2 n + m), in given modes."""
    series, n = _varied(motion, modes, at, number), len(motion.q)
    J = np.zeros((2 * n + len(motion.s),) * 2)
    J[:n, n : 2 * n] = np.eye(n)
    with np.errstate(all="ignore"):
        for row, rate in zip(range(n, len(J)), [*motion.a, *motion.ds], strict=True):
            J[row] = series.of(rate, 1)[1]
    return J


def onto_surfaces(motion, modes, at, number):
    """A state like the one given that can be in these modes: on the surfaces it would have to lie beyond."""
    q, w, s = np.array(at[0], float), at[1], at[2]
    for g in motion.guards:
        if g.kind == "side":
            value, gradient = _varied(motion, modes, (q, w, s), number).of(g.measure, 1)
            along = np.broadcast_to(gradient, (2 * len(q) + len(s),))[: len(q)]
            if (value < 0) != modes[g.leaf] and along.any() and np.isfinite(along).all():
                q = q - value * along / (along @ along)
    return list(q), w, s


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


def frequency(motion, states, number, linear=True):
    """The largest |eigenvalue| [rad/s] of the motion over its modes and some states; nan where it is not known.

    Where it is not linear, a mode that a state cannot be in is looked at where it begins; of the states after the first,
    those where it has no finite rates do not count.
    """
    largest = 0.0
    for place, at in enumerate(states):
        for modes in modes_of(motion):
            with np.errstate(all="ignore"):
                state = at if linear else onto_surfaces(motion, modes, at, number)
            J = jacobian(motion, modes, state, number)
            if not np.isfinite(J).all():
                if place:
                    continue
                return math.nan
            largest = max(largest, max(abs(np.linalg.eigvals(J)), default=0.0))
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
        where = f"at {shown}, to which it may be set while it runs, " if live else ""
        cure = f", declare a narrower range, or leave {', '.join(live)} out of live=" if live else ""
        more = proposed(omega * T, "a shorter T or, for what is linear, method='exact'")
        raise LongStepError(
            f"{name}: {where}its fastest part turns with omega = {omega:.4g} rad/s, by omega T/substeps = "
            f"{omega * T / substeps:.3g} rad in a step of {T / substeps:g} s; method='taylor' needs at most 1: take {more}{cure}",
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
                f"{name}: a broken power or logarithm of what is zero on a surface, such as d**(3/2) at touch or "
                "sqrt(Abs(y)), has no Taylor series there; method='taylor' takes whole exponents: exponent=1 or 2, or use "
                "method='rk4' with ten substeps a contact"
            )
