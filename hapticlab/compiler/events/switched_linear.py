"""``method="exact"`` where motion is linear between switches: a constant map a mode, and switches located inside the tick.

In the modes that hold at the sample the motion over a period is a matrix product, whose constants are the program's. It
stands where no surface can be reached within the period, which is not guessed but bounded: between both ends of the
period a distance g strays from its chord by at most E |y'(0)| + F |r|, y' the rates at the sample and r what drives
them, with E and F computed beforehand as the largest over the period. Elsewhere the switches are located, in pieces that
turn by a radian at most: see :mod:`hapticlab.compiler.events.located_step`.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from ...errors import LiveConstantError, ProgramError
from ..algebra.matrix_exponential import held
from ..ir.conditions import any_of, one_of
from ..ir.structural_zeros import dot, is_zero, plus, times
from ..ir.trace import Value, minimum, reachable, select
from .chord_bound import power_strays, strays
from .series_checks import is_linear
from .taylor_series import Series

#: most surfaces: their modes are counted one by one
MOST_SURFACES = 12
#: most maps: of the modes, those nearest to the one at the start
MOST_MAPS = 16
#: highest power of time that drives a motion
DEGREE = 6


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
    start : sequence of float
        The state at the first sample.
    number : callable position -> float
        What results of the program are there.
    """

    def __init__(self, motion, h, why, parameters, start, number):
        self.motion, self.h, self.why, self.parameters = motion, h, why, parameters
        self.leaves = [*motion.q, *motion.w, *motion.s]
        self.choices = [g.leaf for g in motion.guards] + [r.side for r in motion.reactions if r.side is not None]
        measures = [g.measure for g in motion.guards] + [r.measure for r in motion.reactions]
        # the maps put each free reaction in by its formula, which may hold none of the others; friction on a contact does
        leaves = {r.leaf.id for r in motion.reactions}
        pushed = reachable(motion.builder.instructions, [r.free.id for r in motion.reactions])
        if any(g.kind == "floor" for g in motion.guards) or not is_linear(motion, measures) or not leaves.isdisjoint(pushed):
            raise self._refused()
        if len(self.choices) > MOST_SURFACES:
            raise ProgramError(
                f"{why[0]}; method='exact' allows at most {MOST_SURFACES} surfaces (cases, Max, Min, contacts, frictions), "
                f"and there are {len(self.choices)}. Use method='taylor'"
            )
        self.surfaces = list(self._surfaces())
        first = self._sides(start, number)
        self.walls = self._walls(self._mode(first))
        near = sorted(filter(self._possible, itertools.product((False, True), repeat=len(first))), key=_changes_from(first))
        self.modes, self.complete = {sides: self._mode(sides) for sides in near[:MOST_MAPS]}, len(near) <= MOST_MAPS

    def _refused(self):
        return ProgramError("".join(self.why))

    @property
    def omega(self):
        """The largest |eigenvalue| [rad/s] of all modes."""
        return max(mode.omega for mode in self.modes.values())

    def _surfaces(self):
        """Yield (distance, leaf that says on which side it is, whether that side is the positive one, idle cases)."""
        for g in self.motion.guards:
            yield g.measure, g.leaf, False, g.idle
        for r in self.motion.reactions:
            yield r.measure, r.side, True, ()

    def _walls(self, mode):
        """(number of the choice, direction, place) of each surface that stands still: it is met at row y = place."""
        # two walls of one direction have three sides together, not four: a map for the fourth would never be used
        motion, found = self.motion, []
        still = self._at([0.0] * len(self.leaves), 0.0, mode.sides, 1)
        leaves = {leaf.id for leaf in self.choices} | {r.leaf.id for r in motion.reactions}
        for k, (surface, row) in enumerate(zip(self.surfaces, mode.rows, strict=True)):
            place, moves = still.of(surface[0], 1)
            place, size = place.constant if isinstance(place, Value) else place, np.linalg.norm(row)
            fixed = leaves.isdisjoint(reachable(motion.builder.instructions, [surface[0].id]))
            if k < len(motion.guards) and fixed and place is not None and is_zero(moves) and size:
                turned = -1.0 if row[np.flatnonzero(row)[0]] < 0 else 1.0
                found.append((k, tuple(np.round(turned * row / size, 9)), turned, -turned * place / size))
        return found

    def _possible(self, sides):
        """Whether a state can be on these sides of all surfaces that stand still: of walls in a row, not on any two."""
        within = {}
        for k, direction, turned, place in self.walls:
            low, high = within.get(direction, (-math.inf, math.inf))
            below = sides[k] == (turned > 0)  # the side that is true is the negative one
            within[direction] = (low, min(high, place)) if below else (max(low, place), high)
        return all(low <= high for low, high in within.values())

    def _series(self, rows, sides, order, number=None):
        """The series of a motion whose state stays as ``rows`` has it, nothing held, known to an order."""
        motion = self.motion
        rows |= {leaf.id: [value] + [0.0] * order for leaf, value in sides.items()}
        rows |= {r.leaf.id: [] for r in motion.reactions}
        series = Series(motion.builder.instructions, rows, number or motion.builder.result)
        for k in range(order + 1):
            for r in motion.reactions:
                rows[r.leaf.id].append(series.of(r.free, k)[k])
        return series

    def _mode(self, sides):
        """A mode: its matrix and rows column by column, the slopes by one state at a time."""
        motion, columns, sides = self.motion, [], dict(zip(self.choices, map(np.bool_, sides), strict=True))
        rates, measures = [*motion.a, *motion.ds], [surface[0] for surface in self.surfaces]
        for varied in self.leaves:
            rows = {leaf.id: [0.0, float(leaf is varied)] for leaf in self.leaves} | {motion.tau.id: [0.0, 0.0]}
            series = self._series(rows, sides, 1)
            columns.append([self._number(series.of(value, 1)[1]) for value in (*rates, *measures)])
        table, n = np.reshape(columns, (len(self.leaves), -1)).T, len(motion.q)
        A = np.vstack([np.eye(len(self.leaves))[n : 2 * n], table[: len(rates)]])
        return _Mode(sides, A, list(table[len(rates) :]))

    def _number(self, slope):
        """A slope as a number; refuse one that may change while the program runs."""
        value = slope.constant if isinstance(slope, Value) else slope
        if value is not None:
            return float(value)
        instructions = self.motion.builder.instructions
        reached = [instructions[p] for p in reachable(instructions, [slope.id])]
        live = sorted({self.parameters[i.index].name for i in reached if i.op == "param"})
        if not live:
            raise self._refused()
        raise LiveConstantError(
            f"{self.why[0]}; method='exact' computes the constants of each mode in advance, but {', '.join(live)} is live. "
            f"Compile with hl.compile(..., method='exact', live=[...]) without {', '.join(live)}, or use 'taylor'",
            live,
        )

    # at run time

    def over(self, state):
        """(state after the period, room): in the modes at the sample, ``room`` > 0 if they hold over the period."""
        values, n = [*state[0], *state[1], *state[2]], len(self.motion.q)
        moved = {sides: self._moved(mode, values) for sides, mode in self.modes.items()}
        *after, room = self._chosen(self._sides(values), moved, [*values, -1.0])
        return (after[:n], after[n : 2 * n], after[2 * n :]), room

    def _sides(self, values, number=None):
        """On which sides a state is, as the comparisons have it."""
        sides = {}
        for g in self.motion.guards:
            at = self._at(values, 0.0, sides, number=number)
            first, second = (at.of(part, 0)[0] for part in (g.first, g.second))
            sides[g.leaf] = first < second if g.strict else first <= second
        for r in self.motion.reactions:
            if r.side is not None:
                sides[r.side] = 0.0 < self._at(values, 0.0, sides, number=number).of(r.measure, 0)[0]
        return tuple(sides.values())

    def step(self, stepper, state, held):
        """(state, held, unlocated) after a period: by a map where that is sure, else with switches located."""
        # both are traced, and an engine may skip the one that is not chosen; a held reaction is an unknown that no map has
        fast, room = self.over(state)
        slow, now, missed = stepper.step(self.motion.builder.const(0.0), state, held, jumped=True)
        sure = (0.0 < room) & ~any_of(held)
        state = tuple([select(sure, *pair) for pair in zip(*parts, strict=True)] for parts in zip(fast, slow, strict=True))
        held = [one_of(sure, np.False_, later) for later in now]
        if stepper.impact:
            stepper.impact.sums.update({of: select(sure, 0.0, amount) for of, amount in stepper.impact.sums.items()})
        return state, held, select(sure, 0.0, select(missed, 1.0, self.motion.builder.const(0.0)))

    def longest(self, flags):
        """The part of the period in which a motion in the modes of these flags turns by a radian, at most 1."""
        parts = {}
        for sides, mode in self.modes.items():
            part = min(1.0, 1.0 / (mode.omega * self.h)) if mode.omega else 1.0
            parts[sides[: len(flags)]] = [min(part, *parts.get(sides[: len(flags)], [1.0]))]
        return self._chosen(flags, parts, min(parts.values()))[0]

    def _chosen(self, flags, results, other):
        """One of several lists of results, by flags; ``other`` where there is none, unless that cannot be."""
        if not results:
            return other
        if not len(flags):
            return results[()]
        above, below = ({sides[1:]: r for sides, r in results.items() if sides[0] == side} for side in (True, False))
        if self.complete and not (above and below):  # every mode has a map, so that these sides cannot be
            return self._chosen(flags[1:], above or below, other)
        pairs = zip(self._chosen(flags[1:], above, other), self._chosen(flags[1:], below, other), strict=True)
        return [a if a is b else select(flags[0], a, b) for a, b in pairs]

    def _at(self, values, tau, sides, order=0, number=None):
        rows = {leaf.id: [value] + [0.0] * order for leaf, value in zip(self.leaves, values, strict=True)}
        rows |= {self.motion.tau.id: [tau, *[self.h, *[0.0] * DEGREE][:order]]}
        return self._series(rows, sides, order, number)

    def _moved(self, mode, values):
        """The state after a period in a mode, and the room that its surfaces leave at least."""
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
            # g >= its chord - stray, and the chord is least at an end: room > 0 says that the surface is not reached
            bound = strays(mode.A, row, self.h, degree, scale) * np.array(units)[:, None]
            stray = _sum(dot([float(f) for f in E], [_size(c) for c in change]) for E, change in zip(bound, changes, strict=True))
            for k in range(2, DEGREE):
                stray = plus(stray, times(power_strays(k), _size(first[k])))
            room = minimum(minimum(first[0], last) - stray, room)
        return [*after, room]

    def _scale(self, A):
        """Units for the states, rates in those of the fastest spring: an exponential loses digits beside larger entries."""
        two = len(self.motion.q)
        frequency = max(1 / self.h, math.sqrt(np.abs(A[two : 2 * two, :two]).max(initial=0.0)))
        return np.r_[np.ones(two), np.full(two, frequency), np.ones(len(A) - 2 * two)]


def _changes_from(first):
    """A function that counts the sides that differ from these."""
    return lambda sides: sum(bool(a) != bool(b) for a, b in zip(sides, first, strict=True))


def linear_between(facts):
    """The note of a program that is linear between switches."""
    return (
        f"linear between switches: a constant map for each of {facts['maps']} modes is used where no switch can be reached "
        f"within the period; elsewhere switches are located, in at most {facts['pieces']} pieces"
    )


def _size(value):
    return value if is_zero(value) else abs(value)


def _sum(parts):
    total = 0.0
    for part in parts:
        total = plus(total, part)
    return total
