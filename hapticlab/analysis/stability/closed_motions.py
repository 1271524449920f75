"""Energy that a program gives to a handle that is moved along closed motions, many at once: a lane for each motion."""

from dataclasses import dataclass, replace

import numpy as np

from ...compiler.engines.engine import load
from ...compiler.ir.program import REAL_TYPES, Channel
from ...compiler.tick.handle_samples import is_past_sample
from ...limits.limit import whole_and_fraction

#: cycles after which what remembers samples alone repeats itself, and Newton steps to where bodies do
SETTLED, STEPS = 4, 4
#: relative difference of the force from one cycle to the next below which it repeats itself
REPEATS = 1e-6
#: relative change of a state by which its effect is measured
CHANGE = 1e-6
#: a state of which a cycle takes less than this part away, such as a count or a sum, drifts from any start
ADRIFT = 1e-7


@dataclass(frozen=True)
class Books:
    """What each closed motion draws from the program in a cycle, and what a device would dissipate.

    Attributes
    ----------
    drawn : array of shape (L,)
        Work of the program on the handle [J].
    viscous : array of shape (L,)
        Energy that a damper of 1 N s/m dissipates [J]; at the least, with a constant velocity between two positions.
    path : array of shape (L,)
        Distance that the handle covers [m].
    held : array of shape (P, L)
        Force on the environment [N] from each position to the next one.
    repeats : array of shape (L,)
        Whether the force repeats itself from cycle to cycle.
    """

    drawn: np.ndarray
    viscous: np.ndarray
    path: np.ndarray
    held: np.ndarray
    repeats: np.ndarray


class ClosedMotions:
    """A program, moved along closed motions.

    A motion is its positions at the samples. A delay of a fraction of a period lets the force change between two samples:
    the position at that instant then follows each sampled position.

    Parameters
    ----------
    program : Program
        Of the input x alone.
    delay : float
        [s]

    Attributes
    ----------
    work : float
        Instructions that a motion of one sample takes, about.
    spent : float
        Instructions so far.
    adrift : int
        Motions so far whose force does not repeat itself from cycle to cycle.

    Examples
    --------
    >>> import hapticlab as hl
    >>> wall = hl.compile(hl.wall()(k=1000), T="1 ms", dtype="float64", live=())
    >>> books = ClosedMotions(wall).books(np.array([[0.0], [1e-3]]))
    >>> books.drawn.round(9).tolist(), books.viscous.round(9).tolist()   # k X^2 and 2 X^2/T
    ([0.001], [0.002])
    """

    def __init__(self, program, delay=0.0):
        self.whole, fraction = whole_and_fraction(delay, program.T)
        parts = (fraction, 1 - fraction) if fraction else (1.0,)
        self.durations = program.T * np.array(parts)
        self._values, self._loaded = list(program.values), load(_moved(program))
        self._bodies = [k for k, c in enumerate(program.states) if c.type in REAL_TYPES and not is_past_sample(c.name)]
        self._length, self.spent, self.adrift = len(program) or 1, 0.0, 0  # a constant force takes no instruction
        self.work = self._length * (SETTLED + (STEPS * (len(self._bodies) + 1) if self._bodies else 0))

    def books(self, positions):
        """Return the :class:`Books` of motions: positions [m] of shape (P, L), P a whole number of samples."""
        sampled = positions[:: len(self.durations)]
        force, repeats = self._forces(sampled)
        self.adrift += np.count_nonzero(~repeats)
        late = [np.roll(force, self.whole + k, axis=0) for k in range(len(self.durations))]
        held = np.stack(late[::-1], axis=1).reshape(positions.shape)
        steps = np.roll(positions, -1, axis=0) - positions
        durations = np.resize(self.durations, len(positions))[:, None]
        return Books(-(held * steps).sum(0), (steps**2 / durations).sum(0), np.abs(steps).sum(0), held, repeats)

    def _forces(self, sampled):
        """Return the forces along a cycle after which they repeat themselves, shape (samples, L), and whether they do."""
        force, states = self._cycle(sampled, None)
        for _ in range(SETTLED - 1):
            before, (force, states) = force, self._cycle(sampled, states)
            repeats = _alike(force, before)
            if repeats.all():
                return force, repeats
        late = np.flatnonzero(~repeats)
        if self._bodies:
            force[:, late], repeats[late] = self._shot(sampled[:, late], states[:, late])
        return force, repeats

    def _shot(self, sampled, states):
        """Return what :meth:`_forces` does, from the states to which a cycle leads back: shooting, by Newton's method."""
        lanes, bodies = sampled.shape[1], len(self._bodies)
        many = np.tile(sampled, bodies + 1)
        for _ in range(STEPS):
            begun = np.tile(states, bodies + 1)
            change = CHANGE * (np.abs(states[self._bodies]).max(axis=1) + CHANGE)
            for k, (row, by) in enumerate(zip(self._bodies, change, strict=True), 1):
                begun[row, k * lanes : (k + 1) * lanes] += by
            ended = self._cycle(many, begun)[1][self._bodies].reshape(bodies, bodies + 1, lanes)
            with np.errstate(all="ignore"):
                slopes = np.moveaxis((ended[:, 1:] - ended[:, :1]) / change[:, None], 2, 0)
                left = (ended[:, 0] - states[self._bodies]).T[..., None]
                known = np.isfinite(slopes).all((1, 2)) & np.isfinite(left).all((1, 2))
                kept = np.eye(bodies) - np.where(known[:, None, None], slopes, 0.0)
                largest = np.maximum(np.linalg.norm(kept, 2, axis=(1, 2)), ADRIFT)
                inverse = np.linalg.pinv(kept, rcond=ADRIFT / largest)
                states[self._bodies] += (inverse @ np.where(known[:, None, None], left, 0.0))[..., 0].T
        before, states = self._cycle(sampled, states)
        force, _ = self._cycle(sampled, states)
        return force, _alike(force, before)

    def _cycle(self, sampled, states):
        """Return the forces at the samples, and the states after them."""
        self.spent += self._length * sampled.size
        rows = np.empty((len(self._values) + 1, sampled.shape[1]))
        rows[:-1] = np.array(self._values, float)[:, None]
        force = np.empty(sampled.shape)
        for k, rows[-1] in enumerate(sampled):
            outputs, states = self._loaded.run(1, None, rows, states)
            force[k] = outputs[0, 0]
        return force, states


def _alike(force, before):
    with np.errstate(invalid="ignore", over="ignore"):
        return (np.abs(force - before) <= REPEATS * np.abs(force).max(0)).all(0)


def _moved(program):
    """Return the program with its input as one more parameter, so that each lane has its own."""
    last = len(program.parameters)

    def without_input(block):
        instructions = (replace(i, op="param", index=last) if i.op == "input" else i for i in block.instructions)
        return replace(block, instructions=tuple(instructions))

    (x,) = program.inputs
    return replace(
        program, inputs=(), parameters=(*program.parameters, Channel("moved.x", x.unit, x.type)), values=(*program.values, 0.0),
        init=without_input(program.init), tick=without_input(program.tick),
    )  # fmt: skip
