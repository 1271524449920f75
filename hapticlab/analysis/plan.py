"""A sweep laid out: which points share a program, that program, and the chunks that are left to run."""

import hashlib

import numpy as np

from .. import __version__
from ..compiler.llvm import llvmlite_is_ready
from ..errors import AnalysisError
from ..scene.parameters import Parameter
from .chatter import SHORTEST
from .chunks import Chunk, chunk_size, linked
from .partial import remaining


class Plan:
    """What a sweep does.

    Attributes
    ----------
    grid : Grid
    groups : list of Points
    digests : dict of int to bytes
        Group -> digest of its program and inputs, of those met by now.
    """

    def __init__(self, scene, grid, starts, options, duration, metric, engine):
        self.scene, self.grid, self.starts, self.options = scene, grid, starts, options
        self.duration, self.metric, self.engine = duration, metric, engine
        self.groups, self.digests, self._compiled = grid.groups(), {}, (None, None)
        for points in self.groups:
            ticks, T = points.paddle.ticks(duration), points.paddle.T
            if ticks < SHORTEST:
                raise AnalysisError(f"duration = {duration:g} s is {ticks} samples of T = {T:g} s; needs at least {SHORTEST}")

    @property
    def machine_code(self):
        """Whether the points run outside Python, so that threads run side by side."""
        return self.engine == "llvm" or (self.engine == "auto" and llvmlite_is_ready())

    def chunks(self, records, workers):
        """Yield the chunks that no record covers; refuse records of another program."""
        found = {}
        for record in records:
            found.setdefault(record.group, []).append(record)
        for group, points in enumerate(self.groups):
            ticks = points.paddle.ticks(self.duration)
            program, packed, digest = linked(self._program(points), points.paddle, ticks, self.metric)
            self.digests[group] = digest
            here = found.get(group, [])
            if any(record.digest != digest for record in here):
                raise AnalysisError(
                    f"the file to resume from is of another sweep: {self.scene.name}, its values, the paddle or its hand "
                    "are not what they were. Name another file, or delete this one"
                )
            size = chunk_size(program, ticks, self.grid.points, workers)
            for first, stop in _pieces(remaining(here, len(points)), size):
                part, start = points.cut(first, stop)
                count = stop - first
                yield Chunk(group, first, count, packed, digest, part, start, self.starts, ticks, self.metric, self.engine)

    def put(self, result, record, shown):
        """Write a record's values where they belong, and move the bar; return how many they are."""
        count = len(record.values)
        cells = self.grid.cells(self.groups[record.group], record.first, record.first + count)
        result[cells] = record.values
        shown.update(count)
        return count

    def _program(self, points):
        """Return the program of the scene for a group; groups that follow one another often share it."""
        paddle = points.paddle
        key = paddle.T, paddle.velocity, tuple(points.lengths.items())
        if key != self._compiled[0]:
            program = paddle.program(self.scene(**points.lengths), **self.options)
            for channel in program.parameters:  # a program may take less than a scene
                if channel.name in self.grid.axes:
                    swept = Parameter(channel.name, channel.unit, channel.low, channel.high)
                    for end in (np.min, np.max):
                        swept.check(float(end(self.grid.axes[channel.name])))
            self._compiled = key, program
        return self._compiled[1]


def _pieces(ranges, size):
    """Cut ranges into equal pieces of at most a size."""
    for start, stop in ranges:
        ends = np.linspace(start, stop, -(-(stop - start) // size) + 1).astype(int).tolist()
        yield from zip(ends[:-1], ends[1:], strict=True)


def identity(plan, scene):
    """Return what tells a sweep from another, part by part; the programs' digests say the rest."""
    grid = plan.grid
    parts = {
        "hapticlab": __version__,
        "scene": scene.name,
        "metric": plan.metric,
        "duration": f"{float(plan.duration)} s",
        "options": ", ".join(f"{name} = {a}" for name, a in plan.options.items()) or "none",
        "start": ", ".join(f"{name} = {a!r}" for name, a in plan.starts.items()),
        "paddle": " ".join(str(grid.paddle).split()),
    }
    for name, a in grid.axes.items():
        digest = hashlib.sha256(np.ascontiguousarray(a, "<f8").tobytes()).hexdigest()[:8]
        parts[f"axis {name}"] = f"{len(a)} from {a[0]:g} to {a[-1]:g} ({digest})"
    return {**parts, "order of the axes": ", ".join(grid.axes)}
