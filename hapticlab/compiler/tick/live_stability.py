"""Whether the steps of a program are stable at values of its live parameters, in every mode of its motion.

The motion is taken from the instructions that the program is traced from, with its comparisons as modes, differentiated,
and stepped as the program steps it. Where it is not linear, that holds for small motions about the positions that were examined.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..algebra.tangents import tangents
from ..events.flow import Motion
from ..events.guards import Leaves, freeze
from ..events.series_checks import around, cases_of, is_linear, leaf_of, live_in, modes_of, numbers, onto_surfaces, within
from ..events.taylor_method import Taylor
from ..ir.trace import Value, reachable
from ..methods.method_table import Method
from ..methods.step_matrix import excess, longest_step, step_matrix
from .program_builder import Tracing

#: looked at: modes; cases at a value that is set, and at each of many values
MOST_MODES, AT_ONE, AT_MANY = 64, 64, 7
#: states past which eigenvalues take their time
SMALL = 8
#: what doubles more slowly [s] may run: Heun's method on an undamped spring is unstable, and any hand damps more
SLOW = 10.0
#: steps looked at for the margin, times the largest |eigenvalue|, and how the limit is closed in
STEPS, CLOSING = np.geomspace(1e-2, 1e2, 30), (17, 17)
#: what a linearisation is worth where the motion is not linear
SMALL_MOTIONS = "for small motions about the positions that were examined"


@dataclass(frozen=True)
class SteppedMotion:
    """The motion of a program at the sample, as its method sees it, and how it is stepped.

    Attributes
    ----------
    tracing : Tracing
        Complete.
    values : dict name -> float
        Of the parameters that are bound.
    method : Method or Taylor
    h : float
        Step [s].
    positions : tuple of coordinates
        Those with rates.
    start : (q, w, s)
        The states at the sample.
    state : (q, w, s)
        What the method took for them, where it asked for accelerations first.
    rates : (a, ds)
        There, without implicit damping.
    damped : callable step -> (a, ds)
        The same with the implicit damping of a step [s], a Value.
    bound : bool
        Constraints tie the positions.
    """

    tracing: Tracing
    values: dict
    method: Method | Taylor
    h: float
    positions: tuple
    start: tuple
    state: tuple
    rates: tuple
    damped: Callable
    bound: bool


class StableValues:
    """The step of a program as a function of its live parameters.

    Parameters
    ----------
    stepped : SteppedMotion

    Attributes
    ----------
    values : dict name -> float
        Those bound.
    live : list of str
        The live parameters that the motion depends on.
    linear : bool
        Whether the motion is, in every mode.
    """

    def __init__(self, stepped):
        self.tracing, self.values, method = stepped.tracing, stepped.values, stepped.method
        self.instructions, self.h, self.name = self.tracing.tick.instructions, stepped.h, method.name
        self.taylor = isinstance(method, Taylor)
        self.damped = not self.taylor and method.implicit_damping
        self.method = replace(method, implicit_damping=False) if self.damped else method
        self.allowed = 1.0 if self.taylor else math.exp(self.h * math.log(2.0) / SLOW)
        self.step, self.motion = _in_modes(stepped, self.damped)
        self.number = {p.name: k for k, p in enumerate(self.tracing.parameters)}
        self.live = [p.name for p in live_in(self.motion, self.tracing.parameters)]
        self.moving = [leaf_of(v) for v in (*self.motion.q, *self.motion.w, *self.motion.s)]
        self.wanted = [rate.id for rate in (*self.motion.a, *self.motion.ds)]
        self.start = [[value.id for value in group] for group in stepped.start]
        self.linear = is_linear(self.motion)
        self.ranges, self.bound = [(type(q).low, type(q).high) for q in stepped.positions], stepped.bound
        # contacts of an instant are apart, and friction slips
        others = [p for p in reachable(self.instructions, self.wanted)
                  if self.instructions[p].op == "input" and self.instructions[p].index > 1]  # fmt: skip
        leaves = {leaf_of(self.tracing.tick.result(p)): self.instructions[p].type for p in others}
        self.still = {leaf: np.bool_(True) if type == "bool" else 0.0 for leaf, type in leaves.items()}
        self.known = None

    def known_at(self, values):
        """Whether all live parameters of the motion have a value, one of these or that bound."""
        known = {**self.values, **values}
        return all(math.isfinite(known.get(name, math.nan)) for name in self.live)

    def cases(self, values):
        """Leaf -> values, one for each mode and place that is looked at: all, with parameters bound to ``values``."""
        motion, given = self.motion, self.tracing.at_start(values)
        number = numbers(self.instructions, given)
        start = tuple([number(k) for k in group] for group in self.start)
        states = [start]
        if not self.linear:
            states += [*around(start, self.ranges, self.bound), *(within(self.ranges, start) if self.taylor else ())]
        pairs = list(itertools.product(itertools.islice(modes_of(motion), MOST_MODES), states))
        found = cases_of(motion, *zip(*pairs, strict=True), given)
        found = found if self.linear else onto_surfaces(motion, found, len(pairs))
        return self.still | {leaf: np.broadcast_to(value, len(pairs)) for leaf, value in found.items()}, len(pairs)

    def jacobians(self, cases, lanes=1, h=0.0, **values):
        """J of every case, shape (cases, lanes, S, S), with parameters of shape (lanes,); of a damped step h."""
        (given, count), n, S = cases, len(self.motion.q), len(self.moving)
        points = count * lanes
        given = {leaf: np.repeat(column, lanes) if np.ndim(column) else column for leaf, column in given.items()}
        given |= {("param", self.number[name]): np.tile(value, count) for name, value in values.items()}
        if self.damped:
            given[self.step] = np.tile(np.broadcast_to(h, lanes), count)
        _, slopes = tangents(self.instructions, self.wanted, given, self.moving, points)
        J = np.zeros((points, S, S))
        J[:, :n, n : 2 * n] = np.eye(n)
        J[:, n:] = np.moveaxis(slopes, 2, 0)
        return J.reshape(count, lanes, S, S)

    def few(self):
        """The first case at the values bound and the stiffest that differ, those without a finite slope left out."""
        if self.known is None:
            cases = self.cases(self.values)
            self.known = _chosen(cases, self._telling(cases, AT_MANY if len(self.moving) <= SMALL else 2))
        return self.known

    def _telling(self, cases, most):
        """The numbers of the first case and of the stiffest that differ."""
        different = {}
        for k, (J,) in enumerate(self.jacobians(cases, h=self.h)):
            if np.isfinite(J).all():
                different.setdefault(J.tobytes(), (np.linalg.norm(J), k))
        first = [k for _, k in different.values()][:1]
        return [*first, *(k for _, k in sorted([*different.values()][1:], reverse=True)[:most])]

    def growths(self, lanes=1, **values):
        """The factor by which a step multiplies what only steps make grow, shape (lanes,); of Taylor's, omega h.

        Parameters
        ----------
        **values : array of shape (lanes,)
            Of live parameters; the others as bound.
        """
        return self._growths(self.few(), lanes, values)

    def growth(self, values):
        """The same at one set of values, in every mode and place that there is with them; inf where it has no slope."""
        cases = self.cases({**self.values, **values})
        telling = self._telling(cases, AT_ONE if len(self.moving) <= SMALL else 8)
        if not telling:
            return math.inf
        return float(self._growths(_chosen(cases, telling), 1, {})[0])

    def _growths(self, cases, lanes, values):
        count, S = cases[1], len(self.moving)
        J = self.jacobians(cases, lanes, self.h, **values).reshape(-1, S, S)
        known = np.isfinite(J).all(axis=(1, 2))
        J = np.where(known[:, None, None], J, 0.0)
        if self.taylor:
            found = self.h * np.abs(np.linalg.eigvals(J)).max(axis=-1)
        else:
            with np.errstate(all="ignore"):
                R = step_matrix(self.method, J, len(self.motion.q), self.h)
            true = self.jacobians(cases, lanes, 0.0, **values).reshape(-1, S, S) if self.damped else J
            known &= np.isfinite(true).all(axis=(1, 2))
            found = excess(R, np.where(known[:, None, None], true, 0.0), self.h, self.allowed)
        return np.where(known, found, np.inf).reshape(count, lanes).max(axis=0, initial=0.0)

    def unstable(self, lanes=1, **values):
        """For each lane, whether in some case steps make grow what doubles within SLOW, or there is no finite slope."""
        return self.growths(lanes, **values) > self.allowed

    def margin(self):
        """h_max/h at the values bound, the least over the cases where it is known; inf without a limit."""
        n, least, cases = len(self.motion.q), np.inf, self.few()
        places = (STEPS, CLOSING) if len(self.moving) <= 2 * SMALL else (STEPS[::2], (9,))
        for k, (J,) in enumerate(self.jacobians(cases)):
            one = _chosen(cases, [k])

            def step(h, J=J, one=one):
                return step_matrix(self.method, self.jacobians(one, len(h), h)[0] if self.damped else J, n, h)

            with np.errstate(all="ignore"):
                least = min(least, longest_step(step, J, *places) / self.h)
        return least

    def doubles(self, growth):
        """The time [s] in which what a step multiplies by ``growth`` doubles; inf where it does not grow."""
        if not math.isfinite(growth):
            return 0.0
        return self.h * math.log(2.0) / math.log(growth) if growth > 1.0 else math.inf


def _chosen(cases, kept):
    """Some of the cases."""
    given, _ = cases
    return {leaf: column[kept] if np.ndim(column) else column for leaf, column in given.items()}, len(kept)


def _in_modes(stepped, damped):
    """A leaf for the step, and the :class:`Motion` at the sample, its comparisons replaced by modes."""
    builder, (q, w, s), (a, ds) = stepped.tracing.tick, stepped.state, stepped.rates
    new = Leaves(builder)
    step, moving, n = new(), [*q, *w, *s], len(a)
    true = [v if isinstance(v, Value) else builder.const(v) for v in (*a, *ds)]
    rates = true
    if damped:
        a, ds = stepped.damped(step)
        rates = [v if isinstance(v, Value) else builder.const(v) for v in (*a, *ds)]
    # the comparisons of implicit damping are those of the place
    found, guards, slides = freeze(builder, [*rates, *true], moving, [*w, *s], new, true)
    return leaf_of(step), Motion(builder, q, w, s, new(), found[:n], found[n : len(rates)], guards, slides)
