"""What live parameters may be set to: where the step matrix stays stable, in every mode, one alone and several together.

Each has a limit with the others as they are bound. Of several, each takes a part of the way to its own limit, on a
logarithmic scale; the parts may add up to 1. What steps resonate with is a sum of products of powers, such as
(k + K)/m, and the places where such a sum stays below a bound are convex on that scale, so that what lies between
stable places is stable. Places between the limits are looked at all the same, and where one is unstable all shrink.
"""

import itertools
import math
from dataclasses import replace

import numpy as np

from .flow import Motion
from .guards import Leaves, freeze
from .step_matrix import growing, longest_step, radius, rising, step_matrix
from .stiffness import around, is_linear, live_in, modes_of, numbers, onto_surfaces
from .tangents import tangents
from .trace import Value

#: looked at: modes, states of a motion, places between the limits
MOST_MODES, MOST_STATES, PLACES = 64, 40, 32
#: an end without a declared limit is looked at up to so many times the value bound
FAR = 1e6
#: places between the value bound and an end, and how often the two next to the limit are looked between
POINTS, ROUNDS = 7, 5
#: parts of the way to the limits at which places between them are looked at
CLOSER = (1.0, 0.99, 0.97, 0.93, 0.85, 0.7, 0.5, 0.25)
#: what doubles more slowly [s] may run: Heun's method on an undamped spring is unstable, and any hand damps more
SLOW = 10.0
#: how the note of a program begins that is unstable as bound
UNSTABLE = "unstable as bound: "
#: limits that a note names are within so many times the value bound
NEAR = 1e2
#: steps looked at for the margin, times the largest |eigenvalue|, and how the limit is closed in
STEPS, CLOSING = np.geomspace(1e-2, 1e2, 30), (17, 17)


class StableValues:
    """The step of a program as a function of its live parameters.

    Parameters
    ----------
    lowering : Lowering
        Of a scene whose parameters all have values, its tick traced.
    """

    def __init__(self, lowering):
        dynamics, tracing = lowering.dynamics, lowering.tracing
        self.instructions, self.h, self.method = tracing.tick.instructions, dynamics.h, dynamics.method
        self.motion = motion = _at_the_sample(tracing.tick, *dynamics.at_the_sample)
        self.given = tracing.at_start(lowering.scene.values)
        self.number = {p.name: k for k, p in enumerate(tracing.parameters)}
        self.live = [p.name for p in live_in(motion, tracing.parameters)]
        self.moving = [_leaf(v) for v in (*motion.q, *motion.w, *motion.s)]
        number = numbers(self.instructions, self.given)
        self.mass = _masses(dynamics.masses, number) if self.method.implicit_damping and dynamics.masses else None
        start = tuple([number(lowering.state(s).id) for s in group] for group in _groups(dynamics))
        self.linear = is_linear(motion)
        ranges = [(type(q).low, type(q).high) for q in dynamics.second]
        states = [start, *([] if self.linear else around(start, ranges, bool(dynamics.enforced)))]
        cases = []
        for modes in itertools.islice(modes_of(motion), MOST_MODES):
            for at in states:
                with np.errstate(all="ignore"):  # at the tip of a root there is no slope to follow
                    at = at if self.linear else onto_surfaces(motion, modes, at, number)
                leaves = dict(zip(self.moving, [*at[0], *at[1], *at[2]], strict=True))
                cases.append(leaves | {_leaf(leaf): value for leaf, value in modes.items()})
        self.cases = {leaf: np.array([case[leaf] for case in cases]) for leaf in cases[0]}
        kept = self._telling(len(cases))
        self.cases = {leaf: values[kept] for leaf, values in self.cases.items()}
        self.count = len(kept)

    def _telling(self, count):
        """Return the numbers of the first case and of the stiffest that differ: a few where there are many states."""
        self.count, different = count, {}
        for k, (J,) in enumerate(self.jacobians()):
            different.setdefault(J.tobytes(), (np.linalg.norm(J), k))
        first, *others = different.values()
        few = 7 if len(self.moving) <= 8 else 2
        stiffest = sorted(others, key=lambda pair: (not np.isfinite(pair[0]), pair[0]), reverse=True)[:few]
        return [first[1], *(k for _, k in stiffest)]

    def jacobians(self, lanes=1, **values):
        """Return J of every case, shape (cases, lanes, S, S), with parameters of shape (lanes,)."""
        n, S, points = len(self.motion.q), len(self.moving), self.count * lanes
        wanted = [rate.id for rate in (*self.motion.a, *self.motion.ds)]
        given = self.given | {leaf: np.repeat(column, lanes) for leaf, column in self.cases.items()}
        given |= {("param", self.number[name]): np.tile(value, self.count) for name, value in values.items()}
        _, slopes = tangents(self.instructions, wanted, given, self.moving, points)
        J = np.zeros((points, S, S))
        J[:, :n, n : 2 * n] = np.eye(n)
        J[:, n:] = np.moveaxis(slopes, 2, 0)
        return J.reshape(self.count, lanes, S, S)

    def unstable(self, lanes=1, **values):
        """Return for each lane whether in some case steps make grow what doubles within SLOW, or there is no finite slope."""
        found = np.zeros(lanes, bool)
        for J in self.jacobians(lanes, **values):
            known = np.isfinite(J).all(axis=(1, 2))
            J = np.where(known[:, None, None], J, 0.0)
            with np.errstate(all="ignore"):
                R = step_matrix(self.method, J, len(self.motion.q), self.h, self.mass)
            count = growing(R, math.expm1(self.h * math.log(2.0) / SLOW))
            some = np.flatnonzero(count)
            found |= ~known
            found[some] |= count[some] > rising(J[some])
        return found

    def margin(self):
        """Return h_max/h at the values bound, the least over the cases where it is known; inf without a limit."""
        n, least = len(self.motion.q), np.inf
        places = (STEPS, CLOSING) if len(self.moving) <= 16 else (STEPS[::2], (9,))
        for (J,) in self.jacobians():
            if np.isfinite(J).all():
                with np.errstate(all="ignore"):
                    longest = longest_step(lambda h, J=J: step_matrix(self.method, J, n, h, self.mass), J, *places)
                least = min(least, longest / self.h)
        return least

    def doubles(self):
        """Return the time [s] in which what only the steps make grow doubles, in the case where it is fastest."""
        most = 1.0
        for (J,) in self.jacobians():
            if np.isfinite(J).all():
                with np.errstate(all="ignore"):
                    R = step_matrix(self.method, J, len(self.motion.q), self.h, self.mass)
                most = max(most, radius(R, besides=int(rising(J))))
        return self.h * math.log(2.0) / math.log(most) if most > 1.0 else math.inf


def _masses(M, number):
    """Return the mass matrix at the start, rows turned over that were written with a minus sign."""
    M = np.array([[number(m.id) for m in row] for row in M], float)
    return np.where(np.diag(M) < 0, -1.0, 1.0)[:, None] * M


def _at_the_sample(builder, state, rates):
    """Return the motion at the sample, where the first stage of a method is, its comparisons replaced by modes."""
    q, w, s = state
    a, ds = ([v if isinstance(v, Value) else builder.const(v) for v in part] for part in rates)
    found, guards, slides = freeze(builder, [*a, *ds], [*q, *w, *s], [*w, *s], Leaves(builder))
    return Motion(builder, q, w, s, builder.const(0.0), found[: len(a)], found[len(a) :], guards, slides)


def _groups(dynamics):
    n = len(dynamics.second)
    return dynamics.states[:n], dynamics.states[n : 2 * n], dynamics.states[2 * n :]


def _leaf(value):
    i = value.builder.instructions[value.id]
    return i.op, i.index


def kept_stable(program, lowering):
    """Return a program whose live parameters keep its steps stable, with notes, and its margin among the facts.

    Nothing is said of methods that have no longest step ("exact") or refuse one themselves ("taylor"), nor where a
    parameter of the motion has no value.
    """
    dynamics, values = lowering.dynamics, lowering.scene.values
    states, unbound = dynamics.states, set(lowering.scene.parameters) - set(values)
    if not states or len(states) > MOST_STATES or unbound or not hasattr(dynamics.method, "step"):
        return program
    steps = StableValues(lowering)
    margin = steps.margin()
    if not math.isfinite(margin):
        return program
    facts = {**program.facts, "margin": float(f"{margin:.3g}")}
    name, h = dynamics.method.name, dynamics.h
    notes = program.notes
    if margin < 1:
        doubles = steps.doubles()
        why = f"what vibrates doubles in {doubles:.2g} s"
        why = why if margin == 0 else f"its longest step is {margin * h:.3g} s, and {why}"
        notes += (f"{UNSTABLE}{name} in steps of {h:g} s, {why}; take more substeps, a shorter T or another method",)
        facts["doubles_s"] = float(f"{doubles:.3g}")
        if doubles < SLOW:
            return replace(program, facts=facts, notes=notes)
    settable = {c.name: c for c in program.parameters}
    ends = [(name, side, settable[name]) for name in steps.live if name in settable for side in (0, 1)]
    limits = _alone(steps, ends, values)
    begun = {key: origin(0.0, end) for (key, _), end in limits.items() if values[key] == 0}
    if begun:  # a logarithmic way does not begin at zero: what is bound to it counts as a little more
        values = {**values, **begun}
        limits = _alone(steps, ends, values)
    limits = _apart(steps, limits, values)
    kept = {key: (limits.get((key, 0), -math.inf), values[key], limits.get((key, 1), math.inf)) for key, _ in limits}
    near = {key: end for key, end in limits.items() if 1 / NEAR < abs(end / (values[key[0]] or end)) < NEAR}
    ends = [f"{key} {'<=' if side else '>='} {end:.4g} {settable[key].unit}" for (key, side), end in near.items()]
    said = f"{name} in steps of {h:g} s is stable for {', '.join(ends)}, each with the others as bound; more substeps allow more"
    return replace(program, facts=facts, notes=(*notes, *([said] if ends else [])), limits=kept)


def _alone(steps, ends, values):
    """Return (name, side) -> how far a parameter may go alone, of those that have a limit before their declared end."""
    near = [values[name] for name, _, _ in ends]
    far = [_far(values[name], c.high if side else c.low, side) for name, side, c in ends]

    def unstable(numbers, places):
        """Tell of places of each of some ends, shape (ends, places), which are unstable."""
        given = {name: np.full(places.size, values[name]) for name, _, _ in ends}
        for row, k in enumerate(numbers):
            given[ends[k][0]][row * places.shape[1] : (row + 1) * places.shape[1]] = places[row]
        return steps.unstable(places.size, **given).reshape(places.shape)

    every = np.arange(len(ends))
    ahead = np.reshape([_between(near[k], far[k])[[POINTS // 2, -1]] for k in every], (-1, 2))
    open_, found = [*every[unstable(every, ahead).any(axis=1)]], {}
    for _ in range(ROUNDS):
        if not open_:
            break
        places = np.array([_between(near[k], far[k]) for k in open_])
        for k, place, row in zip([*open_], places, unstable(open_, places), strict=True):
            first = int(np.argmax(row)) if row.any() else POINTS
            if first == POINTS or place[first] == 0:
                open_.remove(k)  # stable up to its declared end; a mass of zero is refused anyway
            else:
                near[k], far[k] = place[max(first - 1, 0)], place[first]
                found[ends[k][:2]] = float(near[k])
    return found


def _far(value, end, side):
    """Return an end to look at: the declared one, or one far from the value."""
    if math.isfinite(end):
        return end
    return (value or 1e-3) * FAR if (side == 1) == (value >= 0) else value - FAR * abs(value or 1e-3)


def _between(value, end):
    """Return places from a value to an end: geometric with one sign, closer to zero where one of them is zero."""
    if value * end > 0:
        return np.geomspace(value, end, POINTS)
    near_zero = np.r_[0.0, np.geomspace(1 / FAR, 1.0, POINTS - 1)]
    if value == 0 or end == 0:
        return end * near_zero if value == 0 else value * near_zero[::-1]
    ratio = abs(value / end)
    parts = np.r_[0.0, np.geomspace(ratio, 1.0, POINTS - 1)] if ratio < 0.1 else np.linspace(0.0, 1.0, POINTS)
    return value + (end - value) * parts


def _apart(steps, limits, values):
    """Return the limits, closer where a place between several of them is unstable."""
    if len({name for name, _ in limits}) < 2:
        return limits
    parts = np.random.default_rng(29).dirichlet(np.full(len(limits), 0.4), PLACES)
    for closer in CLOSER:
        if not steps.unstable(PLACES, **_places(limits, values, closer * parts)).any():
            return {(name, side): float(_along(values[name], end, closer)) for (name, side), end in limits.items()}
    return {(name, side): values[name] for name, side in limits}


def _places(limits, values, parts):
    """Return name -> places, each parameter the part of the way to the limit that it is nearer to, shape (places,)."""
    found, farthest = {}, {}
    for part, ((name, _), end) in zip(parts.T, limits.items(), strict=True):
        ahead = part > farthest.get(name, 0.0)
        found[name] = np.where(ahead, _along(values[name], end, part), found.get(name, values[name]))
        farthest[name] = np.maximum(part, farthest.get(name, 0.0))
    return found


def origin(value, end):
    """Return where the way to a limit begins: at the value bound, or a thousandth of the way past zero."""
    return value if value * end > 0 else end / 1e3


def _along(value, end, part):
    """Return a place a part of the way from a value to its limit."""
    start = origin(value, end)
    return start * (end / start) ** part


def part_of_the_way(now, value, end):
    """Return how far a parameter is on the way to its limit: 0 at the value bound, 1 at the limit, negative away from it.

    Examples
    --------
    >>> part_of_the_way(200.0, 100.0, 400.0), part_of_the_way(-1.0, 0.0, 4.0)
    (0.5, -inf)
    """
    start = origin(value, end)
    if now * end <= 0:
        return -math.inf
    return math.log(now / start) / math.log(end / start) if end != start else math.inf * (now != start)
