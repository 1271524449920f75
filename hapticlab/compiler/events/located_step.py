"""A step that finds the events inside it: pieces of closed motion between the crossings of its guards.

The step has a fixed number of pieces, one more than the events it can locate, so its work is the same at every tick. In
each the motion is a polynomial; the earliest crossing of all guards ends it, its mode changes there, and the rest of the
step goes on from that state. A step whose events outnumber its pieces goes on without locating, and says so.
"""

import math
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from ..algebra.polynomial_crossing import departing, first_crossing, horner, scaled
from ..ir import trace
from ..ir.conditions import any_of, either, one_of, signed, size
from ..ir.recurrences import product
from ..ir.structural_zeros import is_zero, plus, times
from ..ir.trace import select
from .flow import Flow
from .series_error import exceeded

#: two crossings closer than this part of a piece happen at once
TOGETHER = {"f64": 1e-14, "f32": 1e-6}


@dataclass(frozen=True)
class _Now:
    """Where a step stands: the state and modes at the start of a piece, and the part of the step that is left."""

    tau: object
    state: tuple
    sides: list
    flags: list
    held: list
    just: list
    left: object


class Stepper:
    """Advances a motion by one step, events located.

    Parameters
    ----------
    motion : Motion
    h : float
        Step [s].
    order : int
        Of the series.
    events : int
        Most events located within a step.
    impact : callable ``(at, fired, held) -> (w, held)``, optional
        What happens where contacts close: ``at(value)`` gives any value of the motion at that instant, ``fired`` tells
        for each reaction whether it is one of those; returns the rates after, and which reactions are held from then on.
    number : callable position -> value, optional
        See :class:`~hapticlab.compiler.events.flow.Flow`.
    steps : dict, optional
        Newton steps of a crossing: see :func:`~hapticlab.compiler.algebra.polynomial_crossing.first_crossing`.
    remainder : (float, float), optional
        Of a motion that is not linear, whose series may diverge: the part of each state that the last term may be. Past
        the first, the step counts as unlocated; past the second, the state is not a number.
    longest : callable flags -> value, optional
        Longest piece in the modes of these flags, as a part of the step: see :mod:`hapticlab.compiler.events.switched_linear`.
    pieces : int, optional
        Where pieces are held to a length; one more than the events, otherwise.
    """

    def __init__(self, motion, h, order, events, impact=None, number=None, steps=None, remainder=None, longest=None, pieces=None):
        self.motion, self.h, self.order = motion, h, order
        self.pieces = pieces or 1 + (0 if motion.smooth else events)
        self.impact, self.number, self.steps, self.remainder = impact, number, steps, remainder
        self.longest = longest

    def step(self, tau, state, held=(), jumped=False):
        """(state, held, unlocated) at tau + h; ``unlocated`` is true where an event was left out.

        ``jumped``: the handle is a new sample, not where the step before left it.
        """
        self._rough = np.False_
        now = self._start(tau, state, list(held))
        if jumped and self.motion.driven:
            now = self._put_back(now)
        ends = []
        for piece in range(self.pieces):  # traced whether an event ends one or not: a program has no jumps
            flow, now = self._flow(now)
            reach = trace.minimum(now.left, self.longest(now.flags)) if self.longest else now.left
            guards = [
                self._crossing(p, just, idle, reach)
                for (p, just), idle in zip(self._guards(flow, now), self._idles(now), strict=True)
            ]
            if piece < self.pieces - 1:  # the last one goes to the end of the step, and counts what it did not locate
                now = self._advanced(flow, now, guards, reach)
                ends.append((now, self._rough))
        missed = self._rough | any_of(found for _, found in guards)
        if self.longest:  # what is left stays undone: no series is taken beyond where it holds
            missed = missed | (reach < now.left)
        return self._ended(ends, self._moved(flow, now, reach), now.held, missed)

    def _ended(self, ends, state, held, missed):
        """(state, held, missed) of the first piece that ends the step."""
        # from the last piece back: each select holds all later ones, which an engine may skip as one arm
        for now, rough in reversed(ends):
            more = 0.0 < now.left
            state = tuple(
                [select(more, later, here) for later, here in zip(*parts, strict=True)]
                for parts in zip(state, now.state, strict=True)
            )
            held = [one_of(more, later, here) for later, here in zip(held, now.held, strict=True)]
            missed = one_of(more, missed, rough)
        return state, held, missed

    def end(self, tau, state, held):
        """(reactions of contacts and frictions, gaps of the contacts) at a state, with those held that are."""
        flow, _ = self._flow(self._start(tau, state, list(held)))
        given = self.motion.reactions[: self.motion.given]
        return [flow.at(r.leaf) for r in given], [flow.at(r.measure) for r in given if r.level == 2]

    def _start(self, tau, state, held):
        motion = self.motion
        now = _Now(tau, state, [], [], held, [np.False_] * (len(motion.guards) + len(motion.reactions)), 1.0)
        flags, sides = self._truths(tau, state)
        return replace(now, flags=flags, sides=sides)

    def _put_back(self, now):
        """The step after the handle jumped: bodies that rest on it or stick to it go along.

        A contact is let go where that takes a pull that its reaction could not give within the step.
        """
        flow = self._fresh(now)
        flow.begin()
        state, pushes = flow.put_back(now.held)
        flow.hold(now.held)
        held = [
            was if r.level == 1 else was & (0.0 <= flow.at(r.leaf) + p * (1 / self.h))
            for r, was, p in zip(self.motion.reactions, now.held, pushes, strict=True)
        ]
        let_go = any_of(was & ~is_ for was, is_ in zip(now.held, held, strict=True))
        state = tuple(
            [select(let_go, old, new) for old, new in zip(*parts, strict=True)] for parts in zip(now.state, state, strict=True)
        )
        return replace(now, state=state, held=held)

    def _truths(self, tau, state):
        """The flag of every guard, and the side of every slip, as the comparisons have them."""
        motion, modes, flags = self.motion, {}, []
        for g in motion.guards:  # in order: a surface may lie elsewhere in the modes of those before it
            flow = Flow(motion, tau, state, modes, self.h, self.number)
            first, second = flow.at(g.first), flow.at(g.second)
            flags.append(trace.floor(first) if g.kind == "floor" else first < second if g.strict else first <= second)
            modes[g.leaf] = flags[-1]
        flow = Flow(motion, tau, state, modes, self.h, self.number)
        return flags, [None if r.side is None else 0.0 < flow.at(r.measure) for r in motion.reactions]

    def _flow(self, now):
        """The motion from here on, and which reactions are held: those tried whose limits allow it."""
        flow = self._fresh(now)
        if self.motion.reactions:
            # a reaction tells whether it may be held once the series is begun with it held; then the series begins anew
            flow.begin()
            flow.hold(now.held)
            held, sides = self._allowed(flow, now)
            base = len(self.motion.guards)
            just = [(j | was) & ~is_ for j, was, is_ in zip(now.just[base:], now.held, held, strict=True)]
            q, w, s = now.state
            rates = [*w, *s]
            for n, k in self.motion.stops.items():  # a held rate is zero, not its rounding, which would add up over hours
                rates[n] = select(held[k], 0.0, rates[n])
            state = q, rates[: len(w)], rates[len(w) :]
            now = replace(now, state=state, held=held, sides=sides, just=[*now.just[:base], *just])
            flow = self._fresh(now)
            flow.begin()
            flow.hold(held)
        flow.grow(self.order)
        return flow, now

    def _fresh(self, now):
        modes = {g.leaf: flag for g, flag in zip(self.motion.guards, now.flags, strict=True)}
        modes |= {r.side: s for r, s in zip(self.motion.reactions, now.sides, strict=True) if s is not None}
        return Flow(self.motion, now.tau, now.state, modes, self.h, self.number)

    def _allowed(self, flow, now):
        held, sides = [], []
        for i, (r, wanted, side) in enumerate(zip(self.motion.reactions, now.held, now.sides, strict=True)):
            allowed = wanted & (0.0 <= flow.at(r.inside))
            if side is not None:
                # a friction holds where it acts against its own slip; any other surface is crossed (Filippov)
                holds = flow.slope(i) < 0.0
                allowed = allowed & holds
                side = either(wanted & ~allowed, either(holds, 0.0 < flow.at(r.lean), ~side), side)
            held.append(allowed)
            sides.append(side)
        return held, sides

    def _guards(self, flow, now):
        """Yield each guard as (coefficients, which are not negative before its event; starts at zero)."""
        motion, order, just = self.motion, self.order, iter(now.just)
        for g, flag in zip(motion.guards, now.flags, strict=True):
            p = flow.of(g.measure, order)
            if g.kind == "floor":  # 1/4 - d^2, d from the middle: zero at either of the two whole numbers
                square = [product(p, p, k) for k in range(order + 1)]
                yield [0.25 - square[0], *(times(-1.0, c) for c in square[1:])], next(just)
            else:
                yield [signed(flag, c) for c in p], next(just)
        for r, held, side in zip(motion.reactions, now.held, now.sides, strict=True):
            # a reaction is known to one order less than the motion that it acts on
            apart, inside = flow.of(r.measure, order), [*flow.of(r.inside, order - 1), 0.0]
            left = next(just)
            apart = departing([c if side is None else signed(~side, c) for c in apart], left, r.level)
            yield [a if is_zero(a) and is_zero(b) else select(held, b, a) for a, b in zip(apart, inside, strict=True)], left

    def _moved(self, flow, now, theta):
        """The state at theta; nan where its series diverges."""
        state = tuple([horner(p, theta) for p in part] for part in flow.state())
        if not self.remainder:
            return state
        rough, wild = exceeded(chain(*flow.state()), theta, self.order, self.remainder)
        self._rough = rough | self._rough
        return tuple([select(wild, math.nan, value) for value in part] for part in state)

    def _advanced(self, flow, now, guards, reach):
        """The step at the earliest of the crossings found, its mode changed."""
        motion, base = self.motion, len(self.motion.guards)
        earliest = 1.0
        for place, _ in guards:
            earliest = trace.minimum(place, earliest)
        # what happens at once, as at a corner, changes at once: the later of two would begin on the wrong side of its surface
        fired = [(place <= earliest + TOGETHER[motion.builder.real]) & found for place, found in guards]
        theta = earliest * reach
        state, tau = self._moved(flow, now, theta), now.tau + self.h * theta
        flags = self._toggled(flow, now, theta, fired)
        if any(g.idle for g in motion.guards):  # a guard that did nothing is looked up where it may be needed again
            truths, _ = self._truths(tau, state)
            flags = [
                self._chosen(g, self._idle(g, now), true, flag)
                for g, true, flag in zip(motion.guards, truths, flags, strict=True)
            ]
        held, sides = [], []
        for r, was, side, f in zip(motion.reactions, now.held, now.sides, fired[base:], strict=True):
            if side is None:  # a contact that closes is held if its impact says so
                held.append(was & ~f)
            else:  # a slip that comes to zero is tried; one that breaks away goes where it leans
                held.append((was & ~f) | (f & ~was))
                side = either(f & was, 0.0 < horner(flow.of(r.lean, self.order - 1), theta), side)
            sides.append(side)
        after = 0.0 if reach is now.left else now.left - reach
        later = _Now(tau, state, sides, flags, held, fired, plus(after, reach * (1.0 - earliest)))
        return self._struck(now, later, fired) if self.impact else later

    def _toggled(self, flow, now, theta, fired):
        """The flags after the crossings."""
        flags = []
        for g, flag, f in zip(self.motion.guards, now.flags, fired, strict=False):
            if g.kind == "floor":
                step = select(0.0 < horner(flow.of(g.measure, self.order), theta), 1.0, -1.0)
                flags.append(select(f, flag + step, flag))
            else:
                flags.append(either(f, ~flag, flag))
        return flags

    def _crossing(self, p, just, idle, left):
        place, found = first_crossing(scaled(p, left), just, self.steps)
        return (place, found) if idle is None else (select(idle, 1.0, place), ~idle & found)

    def _idles(self, now):
        """Yield for each guard and reaction whether it may be left alone, None where it may not."""
        for g in self.motion.guards:
            yield self._idle(g, now) if g.idle else None
        yield from (None for _ in self.motion.reactions)

    def _idle(self, guard, now):
        """Whether the motion does not depend on a guard in the present modes."""
        flags = {g.leaf: flag for g, flag in zip(self.motion.guards, now.flags, strict=True)}
        return any_of(flags[leaf] if value else ~flags[leaf] for leaf, value in guard.idle)

    def _chosen(self, guard, condition, a, b):
        return select(condition, a, b) if guard.kind == "floor" else either(condition, a, b)

    def _struck(self, before, now, fired):
        """Let the contacts that closed act on the rates; modes that look at rates are looked up again."""
        motion, base = self.motion, len(self.motion.guards)
        closed = [
            f & ~was if r.level == 2 else np.False_ for r, f, was in zip(motion.reactions, fired[base:], before.held, strict=True)
        ]
        struck = any_of(closed)
        w, held = self.impact(self._fresh(now).at, closed, now.held)  # traced at each piece; it counts where one closed
        w = [select(struck, new, old) for new, old in zip(w, now.state[1], strict=True)]
        state = now.state[0], w, now.state[2]
        flags, sides = self._truths(now.tau, state)
        flags = [
            self._chosen(g, struck & ~f, new, old) for g, f, new, old in zip(motion.guards, fired, flags, now.flags, strict=False)
        ]
        after, speed = self._fresh(replace(now, state=state)), size(w)
        for i, r in enumerate(motion.reactions):
            if r.side is not None:  # a slip that an impact stopped is tried, one that it set off is let go
                # a slip that is stopped keeps the rounding of its impulse, which is as large as that of the rates
                stopped = abs(after.at(r.measure)) <= 100 * TOGETHER[motion.builder.real] * speed
                held[i] = stopped
                sides[i] = either(struck, sides[i], now.sides[i])
        held = [either(struck, new, old) for new, old in zip(held, now.held, strict=True)]
        return replace(now, state=state, held=held, flags=flags, sides=sides)
