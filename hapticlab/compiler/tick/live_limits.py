"""What live parameters may be set to, so that steps stay stable: each alone, and several together.

Each has a limit with the others as they are bound, which a note names. Whether a set of values is stable is asked of the
steps themselves, :class:`~hapticlab.compiler.tick.live_stability.StableValues`, which a program keeps until it is pickled.

A pickled one has limits for several at once instead: each takes a part of the way to its own limit, on a logarithmic scale,
and the parts may add up to 1. What steps resonate with is a sum of products of powers, such as (k + K)/m, and the places
where such a sum stays below a bound are convex on that scale. Places between the limits are looked at all the same, and
where one is unstable all shrink.
"""

import math
from dataclasses import replace

import numpy as np

from ...scene.frozen import Frozen
from ...scene.notation.symbols import delay, lag_of, n
from ..events.taylor_method import Switched, Taylor
from ..ir.cache import Shared
from ..ir.notes import UnstableNote
from ..ir.trace import reachable
from ..ir.values import Value
from .live_stability import SLOW, SMALL, SMALL_MOTIONS, StableValues

#: states of a motion whose limits are looked for, and places between limits
MOST_STATES, PLACES = 40, 32
#: without a declared end, values are looked at up to those of float32
LARGEST, SMALLEST = 3e38, 1e-37
#: places between the value bound and an end, of small motions and of others; between the two next to the limit, so often
FIRST, CLOSER_BY, ROUNDS = (40, 16), 7, 4
#: parts of the way to the limits at which places between them are looked at
CLOSER = (1.0, 0.99, 0.97, 0.93, 0.85, 0.7, 0.5, 0.25)
#: how the note of a program begins of whose steps nothing is known
UNKNOWN = "the stability of its steps is not checked: "
#: operations by which a motion has modes
COMPARING = ("lt", "le", "eq", "abs", "floor")
#: limits that a note names are within so many times the value bound
NEAR = 1e2


class Limits(Frozen):
    """name -> (low, value, high) of live parameters; and ``steps``, which tell of any values, None once it was pickled.

    Parameters
    ----------
    found : dict
    stepped : SteppedMotion, optional
        Of which the steps are made when they are asked for.
    """

    def __init__(self, found=(), stepped=None):
        super().__init__(found)
        self.stepped, self._made = stepped, Shared(math.inf)

    @property
    def steps(self):
        """The :class:`StableValues`, or None."""
        return None if self.stepped is None else self._made.get("steps", lambda: StableValues(self.stepped))

    def found(self, limits):
        """These limits of the same steps."""
        more = Limits(limits, self.stepped)
        more._made = self._made
        return more

    def __reduce__(self):
        return Frozen, (_apart(self.steps, self),)


def limits_apart(program):
    """Return name -> (low, value, high) of live parameters, for whoever sets several at once and has no steps to ask.

    Each value takes a part of the way to its limit, :func:`part_of_the_way`; up to a sum of 1 the steps are stable. Also of
    methods whose steps are otherwise asked where a value is set.
    """
    steps = getattr(program.limits, "steps", None)
    if steps is None or not steps.known_at(dict(zip([c.name for c in program.parameters], program.values, strict=True))):
        return dict(program.limits)
    return _apart(steps, program.limits or _limits(program, steps))


def kept_stable(program, stepped, form, graph):
    """A program whose live parameters keep its steps stable, with notes, and its margin among the facts.

    Nothing is said of methods that have no longest step ("exact"), nor where the motion sees its own past samples. "taylor"
    refuses itself what is too fast as bound, so that it is looked at where a value is set.

    Parameters
    ----------
    program : Program
    stepped : SteppedMotion
    form : ExplicitForm
        Of its equations of motion.
    graph : Graph
    """
    method, values, states = stepped.method, stepped.values, sum(map(len, stepped.start))
    if isinstance(method, Switched):
        return program
    fed_back = _fed_back(form, graph.variables_of)
    if fed_back is not None:
        note = f"{UNKNOWN}its motion is fed back through samples, by {fed_back}. Simulate it"
        return replace(program, notes=(*program.notes, note), limits=Limits())
    limits = Limits({}, stepped)
    if isinstance(method, Taylor) or states > MOST_STATES:
        return replace(program, limits=limits) if program.parameters else program
    unbound = _unbound(stepped)
    steps = None if unbound else limits.steps
    if unbound or not steps.known_at(values):
        names = unbound or [name for name in steps.live if not math.isfinite(values.get(name, math.nan))]
        unbound = ", ".join(names)
        note = f"{UNKNOWN}{unbound} has no value. It is checked when the value is set"
        return replace(program, limits=limits, notes=(*program.notes, note))
    limits = limits if steps.live else Limits()
    program = replace(_told(program, steps), limits=limits)
    if program.facts.get("doubles_s", math.inf) < SLOW:
        return program
    limits = limits.found(_limits(program, steps))
    program = replace(program, limits=limits)
    near = {(name, side): end for name, (low, bound, high) in limits.items() for side, end in ((0, low), (1, high))
            if math.isfinite(end) and 1 / NEAR < abs(end / (bound or end)) < NEAR}  # fmt: skip
    units = {c.name: c.unit for c in program.parameters}
    ends = [f"{name} {'<=' if side else '>='} {end:.4g} {units[name]}" for (name, side), end in near.items()]
    worth = "" if steps.linear else f" {SMALL_MOTIONS}"
    said = (
        f"{steps.name} in steps of {steps.h:g} s is stable{worth} for {', '.join(ends)}, each with the others at their "
        "bound values"
    )
    return replace(program, notes=(*program.notes, *([f"{said}; more substeps allow more"] if ends else [])))


def _unbound(stepped):
    """Parameters without a value that the accelerations depend on; none where comparisons say on which they depend."""
    builder, rates = stepped.tracing.tick, [rate for part in stepped.rates for rate in part]
    reached = [builder.instructions[p] for p in reachable(builder.instructions, [r.id for r in rates if isinstance(r, Value)])]
    if any(i.op in COMPARING for i in reached):
        return []
    live = [stepped.tracing.parameters[k] for k in sorted({i.index for i in reached if i.op == "param"})]
    return [p.name for p in live if not math.isfinite(stepped.values.get(p.name, math.nan))]


def _fed_back(form, variables_of):
    """What the motion depends on through past samples that depends on the motion, or None."""
    waiting, seen = [(leaf, None) for leaf in variables_of([*form.f, *(m for row in form.M for m in row)])], set()
    while waiting:
        leaf, through = waiting.pop()
        role = getattr(type(leaf), "role", None)
        if through is not None and (leaf.is_Derivative or role == "coordinate"):
            return through
        if leaf in seen or not (isinstance(leaf, delay) or role == "signal"):
            continue
        seen.add(leaf)
        held = leaf.args[0] if isinstance(leaf, delay) else form.updates.get(leaf.func(n) if lag_of(leaf) else leaf)
        waiting += [(part, through or leaf) for part in variables_of([held])] if held is not None else []
    return None


def _told(program, steps):
    """A program with its margin, and in what time it grows where it is unstable as bound."""
    margin, growth = steps.margin(), float(steps.growths()[0])
    facts = {**program.facts, **({"margin": float(f"{margin:.3g}")} if math.isfinite(margin) else {})}
    if margin >= 1 and growth <= steps.allowed:
        return replace(program, facts=facts)
    doubles = steps.doubles(growth)
    why = f"an oscillation doubles in {doubles:.2g} s"
    why = f"its longest step is {margin * steps.h:.3g} s, and {why}" if 0 < margin < 1 else why
    worth = "" if steps.linear else f", {SMALL_MOTIONS}"
    why = f"{steps.name} in steps of {steps.h:g} s, {why}{worth}. Use more substeps, a shorter T or another method"
    note = UnstableNote(why)
    return replace(program, facts=facts | {"doubles_s": float(f"{doubles:.3g}")}, notes=(*program.notes, note))


def _limits(program, steps):
    """name -> (low, value, high) of the live parameters that have a limit."""
    settable, values = {c.name: c for c in program.parameters}, steps.values
    ends = [(name, side, settable[name]) for name in steps.live if name in settable for side in (0, 1)]
    limits = _alone(steps, ends, values)
    begun = {key: origin(0.0, end) for (key, _), end in limits.items() if values[key] == 0}
    if begun:  # a logarithmic way does not begin at zero: what is bound to it counts as a little more
        values = {**values, **begun}
        limits = _alone(steps, ends, values)
    return {key: (limits.get((key, 0), -math.inf), values[key], limits.get((key, 1), math.inf)) for key, _ in limits}


def _alone(steps, ends, values):
    """(name, side) -> how far a parameter may go alone, of those that have a limit before their declared end."""

    def unstable(numbers, places):
        """Which of the places are unstable, shape (ends, places): a row of places for each of some ends."""
        given = {name: np.full(places.size, values[name]) for name, _, _ in ends}
        for row, k in enumerate(numbers):
            given[ends[k][0]][row * places.shape[1] : (row + 1) * places.shape[1]] = places[row]
        return steps.unstable(places.size, **given).reshape(places.shape)

    far = [_far(values[name], c.high if side else c.low, side) for name, side, c in ends]
    open_ = [k for k, (name, _, _) in enumerate(ends) if far[k] != values[name]]
    count = FIRST[len(steps.moving) > SMALL]
    places, found = np.array([_first(values[ends[k][0]], far[k], ends[k][2], count) for k in open_]), {}
    for _ in range(ROUNDS + 1):
        if not open_:
            break
        still, closer = [], []
        for k, place, row in zip(open_, places, unstable(open_, places), strict=True):
            first = int(np.argmax(row)) if row.any() else len(place)
            if first < len(place) and place[first] != 0:  # else stable up to its end; a mass of zero is refused anyway
                found[ends[k][:2]] = float(place[max(first - 1, 0)])
                still.append(k)
                closer.append(_between(place[max(first - 1, 0)], place[first], CLOSER_BY))
        open_, places = still, np.array(closer)
    return found


def _far(value, end, side):
    """An end to look at: the declared one, or one of float32."""
    if math.isfinite(end):
        return end
    return (1.0 if side else -1.0) * LARGEST


def _first(value, end, channel, count):
    """The places of the first look: geometric, and half of them even where a range is declared; in order."""
    if math.isfinite(channel.low) and math.isfinite(channel.high):
        places = np.r_[_between(value, end, count // 2), np.linspace(value, end, count // 2)]
        return np.sort(places) if end > value else np.sort(places)[::-1]
    return _between(value, end, count)


def _between(value, end, count):
    """Places from a value to an end: geometric with one sign, else down to zero and up again."""
    if value * end > 0:
        return np.geomspace(value, end, count)
    if value == 0:
        return np.r_[0.0, np.geomspace(end * max(SMALLEST / abs(end), 1e-45), end, count - 1)] if end else np.zeros(count)
    if end == 0:
        return _between(0.0, value, count)[::-1]
    down, small = count // 2, min(abs(value), abs(end)) / 1e6
    up = np.geomspace(math.copysign(small, end), end, count - down)
    return np.r_[np.geomspace(value, math.copysign(small, value), down - 1), 0.0, up]


def _apart(steps, found):
    """name -> (low, value, high), closer where a place between several limits is unstable."""
    values = {name: value for name, (_, value, _) in found.items()}
    ends = [((name, side), end) for name, (low, _, high) in found.items() for side, end in ((0, low), (1, high))]
    limits = {key: end for key, end in ends if math.isfinite(end)}
    if steps is None or len(found) < 2:
        return dict(found)
    parts = np.random.default_rng(29).dirichlet(np.full(len(limits), 0.4), PLACES)
    for part in (*CLOSER, 0.0):
        if not part or not steps.unstable(PLACES, **_places(limits, values, part * parts)).any():
            break
    closer = {key: float(_along(values[key[0]], end, part)) if part else values[key[0]] for key, end in limits.items()}
    return {key: (closer.get((key, 0), -math.inf), value, closer.get((key, 1), math.inf)) for key, value in values.items()}


def _places(limits, values, parts):
    """name -> places, each parameter the part of the way to the limit that it is nearer to, shape (places,)."""
    found, farthest = {}, {}
    for part, ((name, _), end) in zip(parts.T, limits.items(), strict=True):
        ahead = part > farthest.get(name, 0.0)
        found[name] = np.where(ahead, _along(values[name], end, part), found.get(name, values[name]))
        farthest[name] = np.maximum(part, farthest.get(name, 0.0))
    return found


def origin(value, end):
    """The start of the way to a limit: at the value bound, or a thousandth of the way past zero."""
    return value if value * end > 0 else end / 1e3


def _along(value, end, part):
    """A place a part of the way from a value to its limit."""
    start = origin(value, end)
    return start * (end / start) ** part


def part_of_the_way(now, value, end):
    """How far a parameter is on the way to its limit: 0 at the value bound, 1 at the limit, negative away from it.

    Examples
    --------
    >>> part_of_the_way(200.0, 100.0, 400.0), part_of_the_way(-1.0, 0.0, 4.0)
    (0.5, -inf)
    """
    start = origin(value, end)
    if now * end <= 0:
        return -math.inf
    return math.log(now / start) / math.log(end / start) if end != start else math.inf * (now != start)
