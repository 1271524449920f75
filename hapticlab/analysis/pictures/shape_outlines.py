"""The outline of a placed shape, as it moves."""

import numpy as np

from ...library.sketch import BODY
from ...scene.shapes.shapes import HalfPlane
from .plain_formulas import formula

TURNS = 8


class Outline:
    """Draws a shape in its place.

    Parameters
    ----------
    placed : Placed

    Attributes
    ----------
    names : frozenset of str
        The coordinates and parameters that its size and place depend on, and ``x``.
    """

    def __init__(self, placed):
        self.is_ground = isinstance(placed.shape, HalfPlane)
        self.cores = [len(core) for core in placed.shape.cores]
        corners = [number for core in placed.shape.cores for point in core for number in point]
        self._numbers, names = formula(placed.x, placed.y, placed.angle, placed.shape.radius, *corners)
        self.names = names - {"x"}

    def draw(self, s, state):
        """Draw it on a sketch, as the state (a dict of numbers) has it."""
        x, y, angle, radius, *corners = self._numbers(state)
        turned = np.reshape(np.stack([np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)]), (2, 2))
        place = np.stack([x, y])
        if self.is_ground:
            half = (s.right - s.left) / 2
            middle = (turned @ (np.stack([(s.left + s.right) / 2, (s.bottom + s.top) / 2]) - place))[0]
            s.ground(*(np.reshape(np.stack([middle - half, 0, middle + half, 0]), (2, 2)) @ turned + place))
            return
        corners = np.reshape(np.stack(corners), (-1, 2))
        for size in self.cores:
            core, corners = corners[:size], corners[size:]
            s.area(rim(core, radius) @ turned + place, color=BODY)


def rim(core, radius):
    """Return the outline of a convex core (corners counter-clockwise) widened by a radius, shape (points, 2).

    Examples
    --------
    >>> rim(np.array([[0.0, 0.0]]), 1.0).max(axis=0).round(3)
    array([1., 1.])
    """
    if len(core) == 1:
        return core + radius * _arc(0.0, 2 * np.pi, 4 * TURNS)
    if radius == 0:
        return core
    edges = np.roll(core, -1, axis=0) - core
    leaving = np.arctan2(edges[:, 1], edges[:, 0]) - np.pi / 2  # outward normals, of the edge after each corner
    arriving = np.roll(leaving, 1)
    return np.concatenate([
        corner + radius * _arc(first, first + (last - first) % (2 * np.pi), TURNS)
        for corner, first, last in zip(core, arriving, leaving, strict=True)
    ])  # fmt: skip


def _arc(first, last, steps):
    turns = np.linspace(first, last, steps + 1)
    return np.column_stack([np.cos(turns), np.sin(turns)])
