"""Energy that a program gives to a handle that is moved along closed motions, many at once: a lane for each motion."""

from dataclasses import dataclass, replace

import numpy as np

from ...compiler.engines.engine import load
from ...compiler.ir.program import Channel
from ...limits.limit import whole_and_fraction

#: periods after which the force along a closed motion must repeat itself
LONGEST = 2000
#: relative difference of the force from one cycle to the next below which it repeats itself
REPEATS = 1e-6


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
        self._remembers = bool(program.states)

    def books(self, positions):
        """Return the :class:`Books` of motions: positions [m] of shape (P, L), P a whole number of samples."""
        sampled = positions[:: len(self.durations)]
        force, repeats = self._forces(sampled)
        late = [np.roll(force, self.whole + k, axis=0) for k in range(len(self.durations))]
        held = np.stack(late[::-1], axis=1).reshape(positions.shape)
        steps = np.roll(positions, -1, axis=0) - positions
        durations = np.resize(self.durations, len(positions))[:, None]
        return Books(-(held * steps).sum(0), (steps**2 / durations).sum(0), np.abs(steps).sum(0), held, repeats)

    def _forces(self, sampled):
        """Return the forces along the last cycle, shape (samples, L), and whether they were the same one cycle before."""
        rows = np.empty((len(self._values) + 1, sampled.shape[1]))
        rows[:-1] = np.array(self._values, float)[:, None]
        states, before = None, np.full(sampled.shape, np.nan)
        for _ in range(max(3, LONGEST // len(sampled)) if self._remembers else 2):
            force = np.empty(sampled.shape)
            for k, rows[-1] in enumerate(sampled):
                outputs, states = self._loaded.run(1, None, rows, states)
                force[k] = outputs[0, 0]
            with np.errstate(invalid="ignore", over="ignore"):
                repeats = (np.abs(force - before) <= REPEATS * np.abs(force).max(0)).all(0)
            if repeats.all():
                break
            before = force
        return force, repeats


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
