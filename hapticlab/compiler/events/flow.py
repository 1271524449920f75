"""The motion over one piece of a step, as polynomials of theta = tau/h: the series of the accelerations in given modes."""

import math
from dataclasses import dataclass

import numpy as np

from ...errors import ProgramError
from ..algebra.complementarity import impossible, reactions
from ..ir.structural_zeros import dot, minus, plus, times
from ..ir.trace import Value, maximum, reachable, select
from .guards import Leaves, Reaction, freeze, hidden
from .taylor_series import Series


@dataclass(frozen=True, eq=False)
class Motion:
    """Accelerations as a graph over leaves of its own, comparisons replaced by modes.

    Attributes
    ----------
    builder : Builder
        The one the motion is traced in, and advanced in.
    q, w, s : list of Value
        Leaves: positions, their rates, and first-order states.
    tau : Value
        Leaf: time since the sample.
    a, ds : list of Value
        Derivatives of w and of s.
    guards : list of Guard
    reactions : list of Reaction
        Those of contacts and frictions first, ``given`` of them; then the mixtures of cases that can be slid along.
    """

    builder: object
    q: list
    w: list
    s: list
    tau: Value
    a: list
    ds: list
    guards: list
    reactions: list
    given: int = 0

    @property
    def smooth(self):
        """True where one series holds for the whole step."""
        return not (self.guards or self.reactions)

    @property
    def driven(self):
        """True where what is held has to be put back: to the handle, or where an event was left out."""
        if any(r.level == 2 for r in self.reactions):
            return True
        inside = {leaf.id for leaf in (*self.q, *self.w, *self.s)} | {r.leaf.id for r in self.reactions}
        seen = reachable(self.builder.instructions, [r.measure.id for r in self.reactions])
        return any(self.builder.instructions[p].op in ("input", "state") and p not in inside for p in seen)

    @property
    def stops(self):
        """The rates that stand still while a reaction holds: dict position in (w, s) -> number of the reaction."""
        found = {}
        for k, r in enumerate(self.reactions):
            i = self.builder.instructions[r.measure.id]
            slip = i.args[0] if i.op == "neg" else r.measure.id
            found |= {n: k for n, leaf in enumerate((*self.w, *self.s)) if r.level == 1 and leaf.id == slip}
        return found


def motion_of(builder, rates, second, first=0, events=None):
    """Trace ``rates(tau, q, w, s) -> (a, ds)`` once, over leaves, and return it as a :class:`Motion`.

    Parameters
    ----------
    builder : Builder
    rates : callable
    second, first : int
        How many coordinates of second and of first order.
    events : callable ``(tau, q, w, s, new) -> list of Reaction``, optional
        Contacts and frictions beside the comparisons; called before ``rates``, so that these may use their leaves.
    """
    new = Leaves(builder)
    q, w = [new() for _ in range(second)], [new() for _ in range(second)]
    s, tau = [new() for _ in range(first)], new()
    given = events(tau, q, w, s, new) if events else []
    a, ds = ([v if isinstance(v, Value) else builder.const(v) for v in part] for part in rates(tau, q, w, s))
    parts = [part for r in given for part in (r.measure, r.free, r.inside)]
    leaves = [*q, *w, *s, tau, *(r.leaf for r in given), *(r.side for r in given if r.side is not None)]
    values, guards, found = freeze(builder, [*a, *ds, *parts], leaves, [*w, *s], new)
    parts = iter(values[len(a) + len(ds) :])
    if any(r.level == 2 and {leaf.id for leaf in s} & {*reachable(builder.instructions, [r.measure.id])} for r in given):
        raise ProgramError(
            "the gap of a contact contains a coordinate of first order, whose acceleration no equation gives. A gap depends "
            "on coordinates with masses, the handle and time: give that coordinate a mass, or use a penalty law"
        )
    given = [Reaction(r.leaf, next(parts), r.level, next(parts), next(parts), r.lean, r.side) for r in given]
    guards = hidden(guards, found, values)
    return Motion(
        builder, q, w, s, tau, values[: len(a)], values[len(a) : len(a) + len(ds)], guards, [*given, *found], len(given)
    )


class Flow:
    """The series of a motion from a state, in modes that hold from there on.

    Parameters
    ----------
    motion : Motion
    tau : Value or float
        Time since the sample at the start.
    state : (q, w, s)
        Lists of values.
    modes : dict leaf -> Value
        What the guards' leaves and the reactions' sides are.
    h : float
        The unit of theta [s].
    number : callable position -> value, optional
        What parameters and samples are; traced values of the motion's builder, by default.
    """

    def __init__(self, motion, tau, state, modes, h, number=None):
        self.motion, self.h = motion, h
        leaves = [[*zip(part, values, strict=True)] for part, values in zip((motion.q, motion.w, motion.s), state, strict=True)]
        rows = {leaf.id: [value] for group in leaves for leaf, value in group}
        for leaf, w in zip(motion.q, state[1], strict=True):
            rows[leaf.id].append(times(h, w))
        # time is linear, and a mode constant, to any order that is asked: 20 of a method, 2 more of a gap
        rows[motion.tau.id] = [tau, h] + [0.0] * 40
        rows |= {leaf.id: [value] + [0.0] * 40 for leaf, value in modes.items()}
        rows |= {r.leaf.id: [] for r in motion.reactions}
        self.series = Series(motion.builder.instructions, rows, number or motion.builder.result)
        self.held = []

    def at(self, value):
        """A value of the motion at the start."""
        return self.series.of(value, 0)[0]

    def grow(self, order):
        """Make the state known to theta**order."""
        for k in range(order):
            if self.motion.reactions and k:
                self._set(k, self._solved(self._left(k, [0.0] * len(self.held))))
            self._grow_once(k, self.motion.stops)

    def of(self, value, order):
        """The coefficients 0 to order of a value of the motion."""
        return self.series.of(value, order)

    def state(self):
        """The coefficients of (q, w, s)."""
        motion, known = self.motion, self.series.known
        return tuple([known[leaf.id] for leaf in group] for group in (motion.q, motion.w, motion.s))

    def _grow_once(self, k, stops=()):
        motion, series = self.motion, self.series
        series.upto([rate.id for rate in (*motion.a, *motion.ds)], k)
        known, step = series.known, self.h / (k + 1)
        for n, (leaf, rate) in enumerate(zip((*motion.w, *motion.s), (*motion.a, *motion.ds), strict=True)):
            next = times(step, known[rate.id][k])
            if n in stops:  # at rest to the last bit, whatever rounding leaves of its reaction
                next = select(self.held[stops[n]], 0.0, next)
            known[leaf.id].append(next)
        for leaf, rate in zip(motion.q, motion.w, strict=True):
            known[leaf.id].append(times(self.h / (k + 2), known[rate.id][k + 1]))

    # the reactions: at every order they enter what they must satisfy linearly, with the same slopes

    def begin(self):
        """Find out how the reactions act, before :meth:`hold` says which are held."""
        n = len(self.motion.reactions)
        self._start = self.series.lengths()
        self._rest, a = self._left(0, [0.0] * n), self._a
        ones = []  # accelerations are linear in the reactions, so one trial of each tells all, whatever is held later
        self._pushes = []  # how each reaction changes the rates of w and s
        for i in range(n):
            ones.append(self._left(0, [1.0 if j == i else 0.0 for j in range(n)]))
            self._pushes.append([minus(pushed, free) for pushed, free in zip(self._a, a, strict=True)])
        # for free and for held: row i, column j says how residual i changes with reaction j
        self._slopes = [[[minus(one[i][m], self._rest[i][m]) for one in ones] for i in range(n)] for m in (0, 1)]

    def hold(self, held):
        """Find the reactions at the start, these ones held."""
        self.held = held
        self.series.cut(self._start)
        self._set(0, self._solved(self._rest))

    def put_back(self, held):
        """((q, w, s), impulses) with what is held put back to where it is held; after :meth:`begin`.

        The handle moves between two samples as its hold has it, so at a sample it jumps, and with it what it touches.
        Positions and rates change by as little as the masses allow: by what the reactions themselves push.
        """
        levels = [r.level for r in self.motion.reactions]
        rates = [self.of(r.measure, 1)[1] * (1 / self.h) if r.level == 2 else self.at(r.measure) for r in self.motion.reactions]
        gaps = [self.at(r.measure) for r in self.motion.reactions]
        p = self._masked(held, rates)
        r = self._masked([h if level == 2 else np.False_ for h, level in zip(held, levels, strict=True)], gaps)
        q, w, s = ([row[0] for row in part] for part in self.state())
        moved = [plus(value, dot(r, push)) for value, *push in zip(q, *(row[: len(q)] for row in self._pushes), strict=True)]
        moved = self._possible(moved, r, held, gaps)
        rates = [plus(value, dot(p, push)) for value, *push in zip([*w, *s], *self._pushes, strict=True)]
        return (moved, rates[: len(w)], rates[len(w) :]), p

    def _possible(self, moved, pushes, held, gaps):
        """The positions put back, nan where a body is held between two that leave no room for it."""
        contacts = [i for i, r in enumerate(self.motion.reactions) if r.level == 2]
        slopes = [[self._slopes[1][i][j] for j in contacts] for i in contacts]
        r, size = [pushes[i] for i in contacts], 0.0
        for i in contacts:
            size = maximum(size, select(held[i], abs(gaps[i]), 0.0))
        after = [plus(gaps[i], dot(row, r)) for i, row in zip(contacts, slopes, strict=True)]
        never = impossible(slopes, after, [held[i] for i in contacts], size)
        return moved if never is False else [select(never, math.nan, value) for value in moved]

    def _masked(self, held, left):
        """The pushes that take away what is left of some held measures."""
        n = len(held)
        rows = [[_either(held[i], self._slopes[1][i][j], float(i == j)) for j in range(n)] for i in range(n)]
        return reactions(rows, [_either(h, value, 0.0) for h, value in zip(held, left, strict=True)], [True] * n)

    def slope(self, i):
        """The slope of the rate of measure i by its own reaction."""
        return self._slopes[1][i][i]

    def _set(self, k, values):
        for r, value in zip(self.motion.reactions, values, strict=True):
            self.series.known[r.leaf.id].append(value)

    def _left(self, k, trial):
        """[(free, held)]: what each reaction leaves unsatisfied at order k with trial values; forget the trial."""
        series, motion = self.series, self.motion
        start = series.lengths()
        self._set(k, trial)
        self._grow_once(k)
        self._a = [series.known[rate.id][k] for rate in (*motion.a, *motion.ds)]
        left = []
        for r, value in zip(motion.reactions, trial, strict=True):
            free = minus(value, series.of(r.free, k)[k])
            scale = math.factorial(k + r.level) / math.factorial(k) / self.h**r.level
            left.append((free, times(scale, series.of(r.measure, k + r.level)[k + r.level])))
        series.cut(start)
        return left

    def _solved(self, left):
        held, n = self.held, len(self.held)
        rows = [[_either(held[i], self._slopes[1][i][j], self._slopes[0][i][j]) for j in range(n)] for i in range(n)]
        return reactions(rows, [_either(held[i], *left[i][::-1]) for i in range(n)], [True] * n)


def _either(held, a, b):
    return a if a is b else select(held, a, b)
