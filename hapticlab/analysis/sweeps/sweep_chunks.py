"""Parts of a sweep that run anywhere: a program, what its points are made of, and which of them; no trace, no point itself."""

import hashlib
import pickle
from dataclasses import dataclass

import numpy as np

from ...compiler.ir.cache import Shared
from ...device.simulated.closed_loop import link, load_linked
from .sweep_grid import Points
from .sweep_measures import METRICS, WithFault, WithUnlocated

#: lanes and ticks of one call of an engine
LANES, TICKS = 2048, 2000
#: what chunks of the latest programs run with: instructions and inputs
READY = Shared(4)
#: instructions times ticks times points of a chunk: a few tenths of a second of machine code
WORK = 8e9
#: points of a chunk, whatever they cost
FEWEST, MOST = 64, 16384


@dataclass(frozen=True, eq=False)
class Chunk:
    """A range of points that share a program.

    Attributes
    ----------
    group, first, count : int
        Which points of the sweep: of the group's, from the first one on so many.
    program, digest : bytes
        The linked program, pickled, and the digest of it and its inputs; a process compiles each once.
    points : Points
        Cut to the axes' parts in use; the paddle in it holds the seed of its noise.
    start : int
        Where the chunk begins in these points.
    starts : dict
        x [m] and v [m/s] at the first sample, where they are no axes.
    ticks : int
    metric, engine : str
    """

    group: int
    first: int
    count: int
    program: bytes
    digest: bytes
    points: Points
    start: int
    starts: dict
    ticks: int
    metric: str
    engine: str


def measured(chunk):
    """Run a chunk; return its group, its first point in it, the metric at its points, and how many left an event unlocated."""
    program, loaded, inputs = _ready(chunk)
    points, ticks, stop = chunk.points, chunk.ticks, chunk.start + chunk.count
    parameters, last = points.parameters(program, chunk.starts, chunk.start, stop), []
    for first in range(0, chunk.count, LANES):
        lanes, states = parameters[:, first : first + LANES], None
        for tick in range(0, ticks, TICKS):
            rows = inputs[tick : tick + TICKS]
            outputs, states = loaded.run(len(rows), rows, lanes, states, every=len(rows))
        last.append(outputs[-1])
    numbers, missed = [*np.concatenate(last, axis=1)], 0
    if program.outputs[-1].name == "unlocated":
        missed = np.count_nonzero(numbers.pop())
    fault = numbers.pop()
    count, T = points.count(chunk.start, stop), program.T
    found = METRICS[chunk.metric](ticks, T).value(numbers, count=count, quarter=ticks // 4 * T)
    return chunk.group, chunk.first, np.where(fault > 0, np.nan, found), missed


def linked(program, paddle, ticks, metric):
    """Return a scene's program on a paddle with a metric in it, its bytes, and a digest of it with its inputs and values."""
    measure = WithFault(METRICS[metric](ticks, paddle.T))
    locates = any(c.name == "unlocated" for c in program.outputs)
    made = link(program, paddle, WithUnlocated(measure) if locates else measure)
    what = (made.parameters, made.inputs, made.states, made.outputs, made.init, made.tick, made.values, made.T, ticks)
    digest = hashlib.sha256(repr(what).encode() + paddle.inputs(ticks).tobytes()).digest()[:16]
    return made, pickle.dumps(made), digest


def chunk_size(program, ticks, points, workers):
    """Points of a chunk, from the cost of a point; enough chunks for every worker."""
    size = WORK / (ticks * (len(program) + 1))
    if isinstance(workers, int):
        size = min(size, points / (4 * workers)) if workers > 1 else size
    return int(min(max(size, FEWEST), MOST))


def _ready(chunk):
    """Return a chunk's program, the engine that runs it and its inputs; kept, so that a process makes them once."""

    def make():
        program = pickle.loads(chunk.program)
        return program, load_linked(program, chunk.engine), chunk.points.paddle.inputs(chunk.ticks)

    return READY.get((chunk.digest, chunk.engine), make)
