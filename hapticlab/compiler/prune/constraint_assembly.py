"""Look at constraints before they run: is the start on them, do they repeat each other, do they lose a rank anywhere.

The configurations a mechanism can reach from its start are walked numerically: along a tangent of the constraints, then
back onto them by Newton's method, many walks at once. Where the smallest singular value of the constraints' Jacobian has
a minimum the walk narrows down on it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

#: relative singular value of the constraints' Jacobian below which a rank counts as lost
SMALLEST = {"f64": 1e-8, "f32": 1e-4}
#: step of a walk, in radians, or in lengths of the mechanism
STRIDE, STRIDES = 0.08, 160
WALKS = 24


@dataclass(frozen=True)
class Assembly:
    """Constraints as functions of the coordinates, all else at its value at the start.

    Attributes
    ----------
    look : callable
        q of shape (n, lanes) -> g of shape (positions, lanes) and J of shape (m, n, lanes). The first rows of J are the
        gradients of the g; the others belong to constraints on rates.
    start : array, shape (n,)
    low, high : arrays, shape (n,)
        Declared ranges.
    angles : array of bool, shape (n,)
    """

    look: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    start: np.ndarray
    low: np.ndarray
    high: np.ndarray
    angles: np.ndarray

    @cached_property
    def scale(self):
        """What makes every coordinate a number near one: an angle as it is, a length by the size of the mechanism."""
        _, J = self.look(self.start[:, None])
        lever = np.linalg.norm(J[:, self.angles, 0]) if self.angles.any() else 0.0
        slope = np.linalg.norm(J[:, ~self.angles, 0]) if not self.angles.all() else 0.0
        length = lever / slope if lever > 0 and slope > 0 else np.max(np.abs(self.start), initial=0.0) or 1.0
        return np.where(self.angles, 1.0, length)

    def jacobian(self, q):
        """The Jacobian at each lane, shape (lanes, m, n), its rows and columns of size one."""
        _, J = self.look(q)
        return np.moveaxis(J, 2, 0) * self.scale / self._rows[:, None]

    @cached_property
    def _rows(self):
        _, J = self.look(self.start[:, None])
        rows = np.linalg.norm(J[:, :, 0] * self.scale, axis=1)
        return np.where(rows > 0, rows, 1.0)

    def closest(self, q, times=50):
        """The nearest configuration on the constraints, by Newton's method with the smallest correction."""
        for _ in range(times):
            g, J = self.look(q)
            if not (np.isfinite(g).all() and np.isfinite(J).all()):
                break
            J = np.moveaxis(J, 2, 0)[:, : len(g)] * self.scale
            move = -_transposed(J) @ _solved(J, g.T[:, :, None])
            q = q + self.scale[:, None] * move[:, :, 0].T
            if np.max(np.abs(move), initial=0.0) < 1e-14:
                break
        return q

    def dependent(self, q):
        """The weights of a sum of constraints that has no gradient at q, or None where they are independent."""
        J = self.jacobian(q[:, None])[0]
        left, sizes, _ = np.linalg.svd(J)
        if len(sizes) == len(J) and sizes[-1] > SMALLEST["f64"] * sizes[0]:
            return None
        return left[:, -1]

    @cached_property
    def reached(self):
        """Configurations the mechanism can reach, shape (n, many); the start alone where nothing can move."""
        free = len(self.start) - len(self._rows)
        return self._walked(free).reshape(len(self.start), -1) if free > 0 else self.start[:, None]

    def weakest(self, columns=slice(None)):
        """(relative singular value, configuration) where the constraints come closest to losing a rank.

        ``columns`` picks coordinates, when the others are held.
        """
        values = self.weakness(self.reached, columns)
        best = np.argsort(values)[:8]
        return self._narrowed(self.reached[:, best], values[best], columns)

    def weakness(self, q, columns=slice(None)):
        """The relative singular value at each configuration, shape (lanes,)."""
        J = self.jacobian(q)[:, :, columns]
        known = np.isfinite(J).all(axis=(1, 2))  # a mechanism does not get where its constraints are not numbers
        sizes = np.linalg.svd(np.where(known[:, None, None], J, 0.0), compute_uv=False)
        return np.where(known, sizes[:, -1] / np.maximum(sizes[:, 0], 1.0), np.inf)

    def _along(self, q, headings):
        """Directions projected onto the motions that the constraints allow, of size one; shape (lanes, n)."""
        J = self.jacobian(q)
        h = headings[:, :, None]
        along = (h - _transposed(J) @ _solved(J, J @ h))[:, :, 0]
        size = np.linalg.norm(along, axis=1, keepdims=True)
        return along / np.where(size > 0, size, 1.0)

    def _walked(self, free):
        """Configurations reached by walks from the start, shape (n, strides, walks)."""
        walks = 2 if free == 1 else WALKS
        q = np.repeat(self.start[:, None], walks, axis=1)
        heading = np.random.default_rng(23).standard_normal((walks, len(q)))
        if free == 1:
            heading[1] = -heading[0]
        kept = [q]
        for _ in range(STRIDES if free == 1 else STRIDES // 2):
            heading = self._along(q, heading)
            moved = self.closest(q + self.scale[:, None] * STRIDE * heading.T, times=2)
            inside = np.all((moved >= self.low[:, None]) & (moved <= self.high[:, None]), axis=0) & self._lies_on(moved)
            heading = np.where(inside[:, None], heading, -heading)
            q = np.where(inside, moved, q)
            kept.append(q)
        return np.stack(kept, axis=1)

    def _lies_on(self, q):
        g, J = self.look(q)
        sizes = np.linalg.norm(np.moveaxis(J, 2, 0)[:, : len(g)] * self.scale, axis=2).T
        return np.all(np.abs(g) <= 1e-6 * np.where(sizes > 0, sizes, 1.0), axis=0)

    def _narrowed(self, q, value, columns):
        """Walk on from the weakest configurations, in ever smaller steps, to where they are weakest."""
        generator = np.random.default_rng(7)
        lanes, stride, ways = q.shape[1], np.full(q.shape[1], STRIDE), 4
        for _ in range(60):
            if np.all(100 * stride < value):
                break  # singular values change no faster than the configuration does, within a factor
            heading = generator.standard_normal((ways, lanes, len(q)))
            heading[ways // 2 :] = -heading[: ways // 2]
            from_ = np.tile(q, (1, ways))
            along = self._along(from_, heading.reshape(-1, len(q))).T * np.tile(stride, ways)
            tried = self.closest(from_ + self.scale[:, None] * along, times=3)
            values = np.where(self._lies_on(tried), self.weakness(tried, columns), np.inf).reshape(ways, lanes)
            best = np.argmin(values, axis=0)
            found = values[best, np.arange(lanes)]
            better = found < value
            q = np.where(better, tried.reshape(len(q), ways, lanes)[:, best, np.arange(lanes)], q)
            value, stride = np.where(better, found, value), np.where(better, stride, 0.4 * stride)
        k = int(np.argmin(value))
        return float(value[k]), q[:, k]


def _transposed(J):
    return np.swapaxes(J, 1, 2)


def _solved(J, right):
    """(J J^T)^-1 right at each lane, with a trace of stiffness that only a lost rank feels."""
    W = J @ _transposed(J)
    trace = np.trace(W, axis1=1, axis2=2)[:, None, None]
    return np.linalg.solve(W + 1e-15 * np.where(trace > 0, trace, 1.0) * np.eye(W.shape[1]), right)
