"""A sweep laid out: which points share a program, that program, and the chunks that are left to run."""

import hashlib
import textwrap

import numpy as np

from ... import __version__
from ...compiler.engines.table import chosen
from ...errors import AnalysisError, LiveConstantError, ProgramError
from ...scene.notation.parameters import Parameter
from ..records.chatter import SHORTEST
from .sweep_chunks import Chunk, chunk_size, linked
from .sweep_file import Record, remaining

#: samples of a point, which even machine code takes hours for
MOST_TICKS = 10**12


class Plan:
    """What a sweep does.

    Attributes
    ----------
    grid : Grid
    groups : list of Points
    digests : dict of int to bytes
        Group -> digest of its program and inputs, of those met by now.
    sent : dict of (int, int) to int
        Group and first point of the chunks that are under way -> number of points.
    missed : int
        Points whose run left an event unlocated, of those taken by now.
    """

    def __init__(self, scene, grid, starts, options, duration, metric, engine):
        self.scene, self.grid, self.starts, self.options = scene, grid, starts, options
        self.duration, self.metric, self.engine = duration, metric, engine
        self.groups, self.digests, self.sent, self.missed = grid.groups(), {}, {}, 0
        for points in self.groups:
            ticks, T = points.paddle.ticks(duration), points.paddle.T
            if ticks > MOST_TICKS:
                raise AnalysisError(
                    f"duration = {duration:g} s is {ticks:.3g} samples of T = {T:g} s; a sweep runs at most {MOST_TICKS:.0e}"
                )
            if ticks < SHORTEST:
                raise AnalysisError(f"duration = {duration:g} s is {ticks} samples of T = {T:g} s; needs at least {SHORTEST}")

    @property
    def machine_code(self):
        """Whether the points run outside Python, so that threads run side by side."""
        return chosen(self.engine).side_by_side

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
                raise self._other()
            size = chunk_size(program, ticks, self.grid.points, workers)
            for first, stop in _pieces(remaining(here, len(points)), size):
                part, start = points.cut(first, stop)
                self.sent[group, first] = count = stop - first
                yield Chunk(group, first, count, packed, digest, part, start, self.starts, ticks, self.metric, self.engine)

    def taken(self, given):
        """Return the Record of what a worker gave back for a chunk; refuse anything else, and a chunk's second result."""
        try:
            group, first, values, missed = given
            count, values, missed = self.sent.get((group, first)), np.asarray(values, float), int(missed)
        except (TypeError, ValueError):
            raise AnalysisError(
                f"the workers returned {_shown(given)}; needs a map that returns the results of the function"
            ) from None
        if count is None:
            raise AnalysisError(
                "the workers returned a chunk twice, or one that they were not given; needs a map that returns each chunk once"
            )
        if values.shape != (count,):
            raise AnalysisError(
                f"the workers returned an array of shape {values.shape} for a chunk of {count} points; needs a map that "
                "returns the results of the function"
            )
        del self.sent[group, first]
        self.missed += missed
        return Record(group, first, self.digests[group], values)

    def put(self, result, record, known):
        """Write a record's values where they belong and are not known yet; return how many they are."""
        first, stop = record.first, record.first + len(record.values)
        if record.group >= len(self.groups) or stop > len(self.groups[record.group]):
            raise self._other()
        cells = self.grid.cells(self.groups[record.group], first, stop)
        fresh = ~known[cells]
        result[cells[fresh]] = record.values[fresh]
        known[cells] = True
        return np.count_nonzero(fresh)

    def _other(self):
        return AnalysisError(
            f"the file to resume from belongs to a different sweep: {self.scene.name}, its values, the paddle or its hand "
            "have changed. Give a different file, or delete this one"
        )

    def _program(self, points):
        """Return the program of the scene for a group."""
        try:
            program = points.paddle.program(self.scene(**points.lengths) if points.lengths else self.scene, **self.options)
        except LiveConstantError as error:
            names = ", ".join(name for name in self.options.get("live", ()) if name in error.live)
            if not names:
                raise
            raise ProgramError(
                f"method='exact' computes constants for the motion, so {names} in it cannot be an axis of the sweep. Use "
                "method='taylor', or one call for each value"
            ) from error
        for channel in program.parameters:  # a program may take less than a scene
            if channel.name in self.grid.axes:
                swept = Parameter(channel.name, channel.unit, channel.low, channel.high)
                for end in (np.min, np.max):
                    swept.check(float(end(self.grid.axes[channel.name])))
        return program


def _shown(given):
    """An argument in a few words, however long it is."""
    return textwrap.shorten(repr(given), 80, placeholder=" ...")


def _pieces(ranges, size):
    """Cut ranges into equal pieces of at most a size."""
    for start, stop in ranges:
        ends = np.linspace(start, stop, -(-(stop - start) // size) + 1).astype(int).tolist()
        yield from zip(ends[:-1], ends[1:], strict=True)


def identity(plan, scene):
    """The facts that tell a sweep from another, part by part; the programs' digests say the rest."""
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
