"""``method="exact"`` where motion is linear between switches: a constant map a mode, and switches located inside the tick.

In the modes that hold at the sample the motion over a period is a matrix product, whose constants are the program's. It
stands where no surface can be reached within the period, which is not guessed but bounded: between both ends of the
period a distance g strays from its chord by at most E |y'(0)| + F |r|, y' the rates at the sample and r what drives
them, with E and F computed beforehand as the largest over the period. Elsewhere the switches are located, in pieces that
turn by a radian at most: see :mod:`hapticlab.compiler.located`.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from ..errors import ProgramError
from .conditions import any_of, one_of
from .exponential import exponential, held
from .stiffness import is_linear
from .taylor import Series
from .trace import Value, minimum, reachable, select
from .zeros import dot, is_zero, plus, times

#: most surfaces; twice as many modes have a map of their own with each
MOST_SURFACES = 4
#: highest power of time that drives a motion
DEGREE = 6
#: what rounding may add to a bound
INFLATED = 1 + 1e-6


def strays(A, c, h, degree, scale):
    """Return how far c y strays from its chord over [0, h], at most, a unit of each rate and of each drive.

    y(tau) = y(0) + Psi_0(tau) y'(0) + sum of Psi_j(tau) r_j for y'' = A y' + r_1 + r_2 tau + ..., the Psi_j of
    :func:`~hapticlab.compiler.exponential.held`. The largest of places h/16 apart or nearer; between two of them the
    second derivative bounds the rest, |row e^(H s)| <= |row| e^(|H| s).

    Parameters
    ----------
    A : array of shape (S, S)
    c : array of shape (S,)
    h : float
        Period [s].
    degree : int
        Of the drive.
    scale : array of shape (S,)
        Sizes of the states beside each other.

    Returns
    -------
    array of shape (degree + 1, S)

    Examples
    --------
    >>> import numpy as np
    >>> A, one = np.array([[0.0, 1.0], [0.0, 0.0]]), np.ones(2)
    >>> strays(A, np.array([1.0, 0.0]), 2.0, 0, one).round(3).tolist()  # h^2/8 = 0.5 for an acceleration of 1
    [[0.0, 0.502]]
    """
    n, ratio = len(A), scale[None, :] / scale[:, None]
    H = np.zeros((n * (degree + 2),) * 2)
    H[:n, :n] = A * h * ratio
    for k in range(degree + 1):
        H[k * n : (k + 1) * n, (k + 1) * n : (k + 2) * n] = np.eye(n)
    places = max(16, math.ceil(8 * np.abs(H[:n, :n]).sum(axis=1).max(initial=0.0)))
    E, row = exponential(H / places), np.r_[c * scale, np.zeros(n * (degree + 1))]
    rows = [row]
    for _ in range(places):
        rows.append(rows[-1] @ E)
    rows = np.array(rows)
    chord = np.linspace(0.0, 1.0, places + 1)[:, None] * (rows[-1] - rows[0])
    between = (np.abs(rows @ H @ H) @ exponential(np.abs(H) / places)).max(axis=0) / (8 * places**2)
    most = (np.abs(rows - rows[0] - chord).max(axis=0) + between)[n:].reshape(degree + 1, n)
    return most * INFLATED * h ** np.arange(1, degree + 2)[:, None] / scale


@dataclass(frozen=True)
class _Mode:
    """One choice of sides: leaf -> bool, its matrix, and the rows of the distances to its surfaces."""

    sides: dict
    A: np.ndarray
    rows: list

    @property
    def omega(self):
        return float(max(abs(np.linalg.eigvals(self.A)), default=0.0))


class Maps:
    """The maps of a motion over a period, one a mode.

    Parameters
    ----------
    motion : Motion
    h : float
        Period [s].
    why : (str, str)
        Why it is not one linear system, and what to do where it is not linear in every mode either.
    parameters : sequence of Parameter
        Of its scene.
    """

    def __init__(self, motion, h, why, parameters):
        self.motion, self.h, self.why, self.parameters = motion, h, why, parameters
        self.leaves = [*motion.q, *motion.w, *motion.s]
        self.choices = [g.leaf for g in motion.guards] + [r.side for r in motion.reactions if r.side is not None]
        measures = [g.measure for g in motion.guards] + [r.measure for r in motion.reactions]
        if any(g.kind == "floor" for g in motion.guards) or not is_linear(motion, measures):
            raise self._refused()
        if len(self.choices) > MOST_SURFACES:
            raise ProgramError(
                f"{why[0]}; method='exact' makes a map for each of the modes of at most {MOST_SURFACES} surfaces (cases, Max, "
                f"Min, contacts, frictions), and there are {len(self.choices)}: use method='taylor'"
            )
        self.surfaces = list(self._surfaces())
        self.modes = [
            self._mode(dict(zip(self.choices, map(np.bool_, sides), strict=True)))
            for sides in itertools.product((False, True), repeat=len(self.choices))
        ]

    def _refused(self):
        return ProgramError("".join(self.why))

    @property
    def omega(self):
        """The largest |eigenvalue| [rad/s] of all modes."""
        return max(mode.omega for mode in self.modes)

    def _surfaces(self):
        """Yield (distance, leaf that says on which side it is, whether that side is the positive one, idle cases)."""
        for g in self.motion.guards:
            yield g.measure, g.leaf, False, g.idle
        for r in self.motion.reactions:
            yield r.measure, r.side, True, ()

    def _series(self, rows, sides, order):
        """Return the series of a motion whose state stays as ``rows`` has it, nothing held, known to an order."""
        motion = self.motion
        rows |= {leaf.id: [value] + [0.0] * order for leaf, value in sides.items()}
        rows |= {r.leaf.id: [] for r in motion.reactions}
        series = Series(motion.builder.instructions, rows, motion.builder.result)
        for k in range(order + 1):
            for r in motion.reactions:
                rows[r.leaf.id].append(series.of(r.free, k)[k])
        return series

    def _mode(self, sides):
        """Return a mode: its matrix and rows column by column, the slopes by one state at a time."""
        motion, columns = self.motion, []
        rates, measures = [*motion.a, *motion.ds], [surface[0] for surface in self.surfaces]
        for varied in self.leaves:
            rows = {leaf.id: [0.0, float(leaf is varied)] for leaf in self.leaves} | {motion.tau.id: [0.0, 0.0]}
            series = self._series(rows, sides, 1)
            columns.append([self._number(series.of(value, 1)[1]) for value in (*rates, *measures)])
        table, n = np.reshape(columns, (len(self.leaves), -1)).T, len(motion.q)
        A = np.vstack([np.eye(len(self.leaves))[n : 2 * n], table[: len(rates)]])
        return _Mode(sides, A, list(table[len(rates) :]))

    def _number(self, slope):
        """Return a slope as a number; refuse one that may change while the program runs."""
        value = slope.constant if isinstance(slope, Value) else slope
        if value is not None:
            return float(value)
        instructions = self.motion.builder.instructions
        reached = [instructions[p] for p in reachable(instructions, [slope.id])]
        live = sorted({self.parameters[i.index].name for i in reached if i.op == "param"})
        if not live:
            raise self._refused()
        raise ProgramError(
            f"{self.why[0]}; method='exact' makes constants of each mode, and {', '.join(live)} may be set while it runs; fix "
            f"what modes are made of, hl.compile(..., method='exact', live=[...]) without {', '.join(live)}, or use 'taylor'"
        )

    # at run time

    def over(self, state):
        """Return (state after the period, room): in the modes at the sample, ``room`` > 0 if they hold over the period."""
        motion, values, sides = self.motion, [*state[0], *state[1], *state[2]], {}
        for g in motion.guards:
            first, second = (self._at(values, 0.0, sides).of(part, 0)[0] for part in (g.first, g.second))
            sides[g.leaf] = first < second if g.strict else first <= second
        for r in motion.reactions:
            if r.side is not None:
                sides[r.side] = 0.0 < self._at(values, 0.0, sides).of(r.measure, 0)[0]
        moved = self._chosen([sides[leaf] for leaf in self.choices], [self._moved(mode, values) for mode in self.modes])
        n, after = len(motion.q), moved[:-1]
        return (after[:n], after[n : 2 * n], after[2 * n :]), moved[-1]

    def step(self, stepper, state, held):
        """Return (state, held, unlocated) after a period: by a map where that is sure, else with switches located."""
        fast, room = self.over(state)
        slow, now, missed = stepper.step(self.motion.builder.const(0.0), state, held, jumped=True)
        sure = (0.0 < room) & ~any_of(held)
        state = tuple(
            [select(sure, *pair) for pair in zip(*parts, strict=True)] for parts in zip(fast, slow, strict=True)
        )
        held = [one_of(sure, np.False_, later) for later in now]
        if stepper.impact:
            stepper.impact.sums.update({of: select(sure, 0.0, amount) for of, amount in stepper.impact.sums.items()})
        return state, held, select(sure, 0.0, select(missed, 1.0, self.motion.builder.const(0.0)))

    def longest(self, flags):
        """Return the part of the period in which a motion in the modes of these flags turns by a radian, at most 1."""
        sides = len(self.choices) - len(self.motion.guards)
        parts = [min(1.0, 1.0 / (mode.omega * self.h)) if mode.omega else 1.0 for mode in self.modes]
        parts = np.reshape(parts, (-1, 2**sides)).min(axis=1)
        return self._chosen(flags, [[float(part)] for part in parts])[0]

    def _chosen(self, flags, results):
        """Return one of 2^n lists of results, by n flags."""
        if not len(flags):
            return results[0]
        half = len(results) // 2
        below, above = (self._chosen(flags[1:], part) for part in (results[:half], results[half:]))
        return [a if a is b else select(flags[0], a, b) for a, b in zip(above, below, strict=True)]

    def _at(self, values, tau, sides, order=0):
        rows = {leaf.id: [value] + [0.0] * order for leaf, value in zip(self.leaves, values, strict=True)}
        rows |= {self.motion.tau.id: [tau, *[self.h, *[0.0] * DEGREE][:order]]}
        return self._series(rows, sides, order)

    def _moved(self, mode, values):
        """Return the state after a period in a mode, and the room that its surfaces leave at least."""
        motion, n = self.motion, len(self.motion.q)
        series = self._at(values, 0.0, mode.sides, DEGREE)
        drives = [series.of(rate, DEGREE) for rate in (*motion.a, *motion.ds)]
        if any(not is_zero(row[DEGREE]) for row in drives):
            raise self._refused()
        rates = [*values[n : 2 * n], *(row[0] for row in drives)]
        degree = max((k for row in drives for k in range(1, DEGREE) if not is_zero(row[k])), default=0)
        # coefficient k of theta^k is k!/h^k of the derivative that Psi_k takes
        drives = [[*[0.0] * n, *(row[k] for row in drives)] for k in range(1, degree + 1)]
        units = [math.factorial(k) / self.h**k for k in range(degree + 1)]
        scale = self._scale(mode.A)
        Psi = [P * unit for P, unit in zip(held(mode.A, self.h, scale, max(degree, 1))[1], units, strict=False)]
        changes = [rates, *drives]
        after = [
            plus(value, _sum(dot([float(f) for f in P[k]], change) for P, change in zip(Psi, changes, strict=False)))
            for k, value in enumerate(values)
        ]
        end = self._at(after, self.h, mode.sides)
        room = math.inf
        for (measure, leaf, positive, idle), row in zip(self.surfaces, mode.rows, strict=True):
            if any(bool(mode.sides[other]) == value for other, value in idle):
                continue
            first, last = series.of(measure, DEGREE), end.of(measure, 0)[0]
            if leaf is not None and bool(mode.sides[leaf]) != positive:
                first, last = [times(-1.0, c) for c in first], times(-1.0, last)
            bound = strays(mode.A, row, self.h, degree, scale) * np.array(units)[:, None]
            stray = _sum(dot([float(f) for f in E], [_size(c) for c in change]) for E, change in zip(bound, changes, strict=True))
            for k in range(2, DEGREE):
                stray = plus(stray, times(_power_strays(k), _size(first[k])))
            room = minimum(minimum(first[0], last) - stray, room)
        return [*after, room]

    def _scale(self, A):
        two = len(self.motion.q)
        frequency = max(1 / self.h, math.sqrt(np.abs(A[two : 2 * two, :two]).max(initial=0.0)))
        return np.r_[np.ones(two), np.full(two, frequency), np.ones(len(A) - 2 * two)]


def linear_between(facts):
    """Return what a program says of being linear between switches."""
    return (
        f"linear between switches: a constant map for each of {facts['maps']} modes, wherever no switch can be reached within "
        f"the period; where one may be, it is located, in at most {facts['pieces']} pieces"
    )


def _size(value):
    return value if is_zero(value) else abs(value)


def _sum(parts):
    total = 0.0
    for part in parts:
        total = plus(total, part)
    return total


def _power_strays(k):
    """Return how far theta^k strays from its chord over [0, 1]."""
    place = k ** (-1 / (k - 1))
    return (place - place**k) * INFLATED
