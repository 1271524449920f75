"""The points of a sweep, without an object for each: those that share a program lie together and are counted through.

A file that a sweep goes on from knows its points by this count: whoever changes it gives the file a new format number.
"""

import functools
from dataclasses import dataclass, replace

import numpy as np

from ...device.simulated.lanes import lane_values, together
from ...device.simulated.plant import decided

#: what a sweep may change about a simulated paddle, and its unit
PADDLE_AXES = {
    "T": "s", "m": "kg", "b": "N*s/m", "delay": "s", "counts_per_metre": "1/m", "coulomb": "N", "force_max": "N", "noise": "m",
    "sensor_delay": "s",
}  # fmt: skip
START_AXES = {"x": "m", "v": "m/s"}
#: each of their values asks for a program, or for inputs, of its own
_OWN_PROGRAM = ("T", "noise")


@dataclass(frozen=True, eq=False)
class Points:
    """Points of a sweep that share one program, counted as a product of axes: the last one runs fastest.

    Attributes
    ----------
    paddle : SimulatedPaddle
        Of one of them; the others have the same structure.
    lengths : dict of str to float
        Parameters of the scene that the program has as constants, and the axes decide.
    axes : dict of str to array
        First the axes that decide which points these are, then the rest.
    deciding : int
        How many axes those are.
    places : int array
        Where these points lie in the product of the deciding axes; each place has all of the rest.
    """

    paddle: object
    lengths: dict
    axes: dict
    deciding: int
    places: np.ndarray

    @property
    def _shapes(self):
        shape = tuple(len(a) for a in self.axes.values())
        return shape[: self.deciding], shape[self.deciding :]

    def __len__(self):
        return len(self.places) * int(np.prod(self._shapes[1]))

    def indices(self, start, stop):
        """Return name -> position on each axis of the points start ... stop."""
        first, rest = self._shapes
        place, within = np.divmod(np.arange(start, stop), int(np.prod(rest)))
        found = (*_unravel(self.places[place], first), *_unravel(within, rest))
        return dict(zip(self.axes, found, strict=True))

    def cut(self, start, stop):
        """Return the same points with only the part of the axes that start ... stop takes, and where that starts then."""
        index = self.indices(start, stop)
        low = {name: int(i.min()) for name, i in index.items()}
        axes = {name: a[low[name] : int(index[name].max()) + 1] for name, a in self.axes.items()}
        part = replace(self, axes=axes, places=np.zeros(0, int))
        first, rest = part._shapes
        moved = [i - low[name] for name, i in index.items()]
        places, place = np.unique(_ravel(moved[: self.deciding], first, stop - start), return_inverse=True)
        within = _ravel(moved[self.deciding :], rest, stop - start)
        return replace(part, places=places), int(place[0]) * int(np.prod(rest)) + int(within[0])

    def parameters(self, program, starts, start, stop):
        """Return the linked program's parameters at the points start ... stop, shape (parameters, points).

        Parameters
        ----------
        program : Program
        starts : dict
            x [m] and v [m/s] of the first sample, where they are no axes.
        start, stop : int
        """
        index = self.indices(start, stop)
        given = {name: self.axes[name][i] for name, i in index.items()}
        rows = np.repeat(np.array(program.values, float)[:, None], stop - start, axis=1)
        for row, channel in enumerate(program.parameters):
            if channel.name in given:
                rows[row] = given[channel.name]
        plant = self._plant(index)
        rows[len(rows) - 2 - len(plant) : -2] = plant
        for row, name in ((-2, "x"), (-1, "v")):
            rows[row] = given.get(name, starts[name])
        return rows

    def count(self, start, stop):
        """Return the length of one encoder count [m] at the points start ... stop; 0 where the paddle has no encoder."""
        if "counts_per_metre" in self.axes:
            return 1 / self.axes["counts_per_metre"][self.indices(start, stop)["counts_per_metre"]]
        return 1 / self.paddle.counts_per_metre if self.paddle.counts_per_metre else 0.0

    def _plant(self, index):
        """Return the paddles' parameters at some points; equal paddles are computed once."""
        names = [name for name in index if name in PADDLE_AXES]
        code = _ravel([index[name] for name in names], [len(self.axes[name]) for name in names], 1)
        _, first, again = np.unique(code, return_index=True, return_inverse=True)
        return lane_values(self.paddle, {name: self.axes[name][index[name][first]] for name in names})[:, again]


class Grid:
    """The product of the axes of a sweep over paddles.

    Parameters
    ----------
    paddle : SimulatedPaddle
    axes : dict of str to array
        SI; names of the paddle, of the start and of the scene.
    lengths : sequence of str
        Axes of the scene whose every value asks for a program of its own.
    """

    def __init__(self, paddle, axes, lengths=()):
        self.axes, self.lengths = axes, [name for name in axes if name in lengths]
        self.shape = tuple(len(a) for a in axes.values())
        self.points = int(np.prod(self.shape))
        own = {name: a for name, a in axes.items() if name in PADDLE_AXES}
        # refuses what lies out of range: the ends, a delay beside each T, and the least m beside the longest T
        ends = ({"delay": end, "sensor_delay": end} for end in (np.min, np.max))
        for fixed in ({"m": np.min, "T": np.max}, *ends, {}):
            for end in (np.min, np.max):
                self.paddle = replace(paddle, **{name: fixed.get(name, end)(a).item() for name, a in own.items()})

    def groups(self):
        """Return the points as a list of Points, each of one program and one set of inputs."""
        rubbing = np.max(self.axes.get("coulomb", self.paddle.coulomb)) > 0
        names = (*_OWN_PROGRAM, "delay", "sensor_delay", "coulomb", *(("m", "b") if rubbing else ()), *self.lengths)
        slow = [name for name in self.axes if name in names]
        axes = {name: self.axes[name] for name in (*slow, *(name for name in self.axes if name not in slow))}
        shape = [len(axes[name]) for name in slow]
        index = dict(zip(slow, _unravel(np.arange(int(np.prod(shape))), shape), strict=True))
        own = {name: axes[name][i] for name, i in index.items() if name in PADDLE_AXES}
        kinds = [index[name] for name in (*_OWN_PROGRAM, *self.lengths) if name in index]
        kinds += decided(together(self.paddle, own))
        kind = np.broadcast_to(functools.reduce(_combined, kinds, 0), int(np.prod(shape)))
        order = np.argsort(kind, kind="stable")
        ends = np.flatnonzero(np.diff(kind[order])) + 1
        return [self._group(axes, index, places) for places in np.split(order, ends)]

    def _group(self, axes, index, places):
        here = {name: axes[name][i[places[0]]].item() for name, i in index.items()}
        paddle = replace(self.paddle, **{name: a for name, a in here.items() if name in PADDLE_AXES})
        return Points(paddle, {name: here[name] for name in self.lengths}, axes, len(index), places)

    def cells(self, points, start, stop):
        """Return where points start ... stop of a group lie in the flat result, axes in the order given."""
        index = points.indices(start, stop)
        return _ravel([index[name] for name in self.axes], self.shape, stop - start)


def _combined(code, kind):
    """Return one number for each pair of them; small again, so that many can be combined."""
    kind = np.unique(kind, return_inverse=True)[1].reshape(np.shape(kind))
    return np.unique(code * (kind.max() + 1) + kind, return_inverse=True)[1].reshape(np.broadcast(code, kind).shape)


def _ravel(indices, shape, points):
    """Return flat positions in an array of a shape, which may have no axes."""
    return np.ravel_multi_index(tuple(indices), tuple(shape)) if len(shape) else np.zeros(points, int)


def _unravel(flat, shape):
    return np.unravel_index(flat, tuple(shape)) if len(shape) else ()
