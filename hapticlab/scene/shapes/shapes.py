"""Planar shapes and where they are: what a gap is measured between. Chapter section 23.5.1, the geometric model.

A shape lies in a frame of its own; ``shape.at(x=, y=, angle=)`` places that frame, by expressions of coordinates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ...base.shows_itself import ShowsItself
from ...base.units import in_si
from ...errors import SceneError
from ..notation.amount import amount, take_lengths
from ..notation.derivative import Partial, rates_of
from .polygons import convex_parts, outline, width

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any

    from ...base.annotations import Term

ZERO = sp.S.Zero
#: the outline of a half-plane is its edge
POINT = ((ZERO, ZERO),)


class Shape:
    """A planar shape: convex cores (one for each convex part), widened by a radius.

    A core is a tuple of corners (x, y) [m], counter-clockwise: one corner for a disc, two for a bar with round ends.
    """

    radius = ZERO
    #: its closest points are found by following them, not by a formula
    tracked = False

    def at(self, *, x: Term = 0, y: Term = 0, angle: Term = 0, name: str | None = None) -> Placed:
        """Place the shape.

        Parameters
        ----------
        x, y : number [m], text or expression
            Where the shape's own origin is.
        angle : number or expression [rad]
            How far it is turned, counter-clockwise.
        name : str, optional
            What messages and contacts call it; else the kind of shape.

        Returns
        -------
        Placed
        """
        name = type(self).__name__.lower() if name is None else name
        if not (isinstance(name, str) and name.isidentifier()):
            raise SceneError(f"{name!r} cannot name a shape; needs one word of letters, digits and _, such as ball_1")
        x, y = amount(x, "m", f"x of {name}"), amount(y, "m", f"y of {name}")
        return Placed(self, x, y, amount(angle, "rad", f"angle of {name}"), name)

    @property
    def cores(self) -> tuple[Any, ...]:
        """Its convex cores, one for each convex part."""
        return (POINT,)

    @property
    def thickness(self) -> sp.Expr:
        """Least width [m] of the shape, which a body may not cross between two samples."""
        return 2 * self.radius


@dataclass(frozen=True)
class Circle(ShowsItself, Shape):
    """Disc around its origin.

    Parameters
    ----------
    radius : number [m], text such as "5 mm", or expression; >= 0, and 0 for a point

    Examples
    --------
    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m")
    >>> hl.shapes.Circle("20 mm").at(y=z, name="ball")
    ball: Circle(radius=(0.02 m)) at (0, z(t)), turned by 0
    """

    radius: sp.Expr

    def __post_init__(self) -> None:
        take_lengths(self, zero="radius")


@dataclass(frozen=True)
class Box(ShowsItself, Shape):
    """Rectangle around its origin, ``width`` along x and ``height`` along y, each > 0 [m].

    Parameters
    ----------
    width, height : number, text with a unit, or expression
        Sides along x and along y [m], > 0.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.shapes.Box("40 mm", "20 mm").at(y="15 mm", name="book")
    book: Box(width=(0.04 m), height=(0.02 m)) at (0, (0.015 m)), turned by 0
    """

    width: sp.Expr
    height: sp.Expr

    def __post_init__(self) -> None:
        take_lengths(self, "width", "height")

    @property
    def cores(self) -> tuple[Any, ...]:
        w, h = self.width / 2, self.height / 2
        return (((-w, -h), (w, -h), (w, h), (-w, h)),)

    @property
    def thickness(self) -> sp.Expr:
        return sp.Min(self.width, self.height, evaluate=False)


@dataclass(frozen=True)
class Capsule(ShowsItself, Shape):
    """Bar with round ends around its origin: a segment of ``length`` along x, widened by ``radius``; both > 0 [m].

    Parameters
    ----------
    length : number, text with a unit, or expression
        Of the segment along x [m], > 0.
    radius : number, text with a unit, or expression
        Of the round ends [m], > 0.

    Examples
    --------
    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m")
    >>> hl.shapes.Capsule("40 mm", "5 mm").at(y=z, name="bar")
    bar: Capsule(length=(0.04 m), radius=(0.005 m)) at (0, z(t)), turned by 0
    """

    length: sp.Expr
    radius: sp.Expr

    def __post_init__(self) -> None:
        take_lengths(self, "length", "radius")

    @property
    def cores(self) -> tuple[Any, ...]:
        return (((-self.length / 2, ZERO), (self.length / 2, ZERO)),)


@dataclass(frozen=True)
class Segment(ShowsItself, Shape):
    """Straight line of ``length`` [m] > 0 along x around its origin, without a thickness.

    Touched by a :class:`Circle` it has no inside: the distance is never negative. A body that passes it between two
    samples is on its other side; give it a thickness (:class:`Capsule`) where that can happen.

    Parameters
    ----------
    length : number, text with a unit, or expression
        Along x [m], > 0.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.shapes.Segment("40 mm").at(name="edge")
    edge: Segment(length=(0.04 m)) at (0, 0), turned by 0
    """

    length: sp.Expr

    def __post_init__(self) -> None:
        take_lengths(self, "length")

    cores = Capsule.cores


@dataclass(frozen=True)
class Polygon(ShowsItself, Shape):
    """Simple polygon; where it is not convex it is split into convex parts, once, when it is made.

    Parameters
    ----------
    points : sequence of (x, y), numbers [m] or texts such as "5 mm"
        The corners in order, either way around. Repeated and collinear ones are left out.
    radius : number [m], text or expression, >= 0
        Rounds the corners and widens the polygon.

    Raises
    ------
    SceneError
        Fewer than three corners, no area, or edges that cross.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hook = hl.shapes.Polygon([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])
    >>> [len(part) for part in hook.parts]
    [4, 4]
    """

    points: tuple[Any, ...]
    radius: sp.Expr = 0

    def __post_init__(self) -> None:
        try:
            points = [tuple(in_si(c, "m", f"corner {k}") for c in p) for k, p in enumerate(self.points, 1)]
        except TypeError:
            points = []
        if not points or any(len(p) != 2 or not all(map(math.isfinite, p)) for p in points):
            raise SceneError(f"points = {self.points!r}; needs a list of corners (x, y) in m, such as [(0, 0), (1, 0), (0, 1)]")
        object.__setattr__(self, "points", outline(points))
        object.__setattr__(self, "parts", convex_parts(self.points))
        take_lengths(self, zero="radius")

    @property
    def cores(self) -> tuple[Any, ...]:
        return tuple(tuple((amount(u, "m", "x"), amount(v, "m", "y")) for u, v in part) for part in self.parts)  # type: ignore[attr-defined]

    @property
    def thickness(self) -> sp.Expr:
        return amount(min(map(width, self.parts)), "m", "width") + 2 * self.radius  # type: ignore[attr-defined]


@dataclass(frozen=True)
class HalfPlane(ShowsItself, Shape):
    """Everything below its own x axis: a floor; turned by pi/2, a wall that is solid to the right of its origin.

    Examples
    --------
    >>> import hapticlab as hl
    >>> floor = hl.shapes.HalfPlane().at(name="floor")
    >>> wall = hl.shapes.HalfPlane().at(x=0.1, angle=1.5707963267948966, name="wall")
    >>> floor.direction(0, 1), wall.direction(0, 1)
    ((0, 1), (-1, 0))
    """

    @property
    def thickness(self) -> sp.Expr:
        return sp.oo


def ground(y: Term = 0, *, name: str = "ground") -> Placed:
    """The floor below a height y [m]: a :class:`HalfPlane` in its place.

    Parameters
    ----------
    y : number, text with a unit, or expression
        Height of the floor [m].
    name : str
        What messages and pictures call it.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.shapes.ground("-20 mm")
    ground: HalfPlane() at (0, (-0.02 m)), turned by 0
    """
    return HalfPlane().at(y=y, name=name)


@dataclass(frozen=True, repr=False)
class Placed(ShowsItself):
    """A shape in its place: its origin at (x, y) [m], turned by ``angle`` [rad], each an expression."""

    shape: Shape
    x: sp.Expr
    y: sp.Expr
    angle: sp.Expr
    name: str

    def __repr__(self):
        return f"{self.name}: {self.shape} at ({self.x}, {self.y}), turned by {self.angle}"

    def direction(self, u, v):
        """A vector of the shape's frame along the axes of the plane."""
        c, s = sp.cos(self.angle), sp.sin(self.angle)
        return c * u - s * v, s * u + c * v

    def point(self, u, v):
        """Position (x, y) [m] in the plane of a point (u, v) [m] of the shape's frame."""
        across, up = self.direction(u, v)
        return self.x + across, self.y + up

    def velocity(self, point):
        """Velocity [m/s] of the body's material at a point (x, y) of the plane."""
        dx, dy = _rate(self.x), _rate(self.y)
        return dx - self.turning * (point[1] - self.y), dy + self.turning * (point[0] - self.x)

    @property
    def turning(self):
        """Angular velocity [rad/s]."""
        return _rate(self.angle)


def replacement(body: Placed, forces: Iterable[Any]) -> Any:
    """The force and couple that replace several forces on a body; chapter section 23.5.2.

    Parameters
    ----------
    body : Placed
        The resultant acts at its origin (x, y).
    forces : sequence of ((F_x, F_y), (p_x, p_y))
        Each force [N] and the point [m] it acts at.

    Returns
    -------
    F_x, F_y, couple : expressions [N, N, N*m]

    Examples
    --------
    >>> import hapticlab as hl
    >>> N, a = hl.parameters("N a", units="N m")
    >>> hl.shapes.replacement(hl.shapes.Box(1, 1).at(), [((0, N), (a, 0)), ((0, -N), (0, 0))])
    (0, 0, N*a)
    """
    F_x, F_y = sp.Add(*(f[0] for f, _ in forces)), sp.Add(*(f[1] for f, _ in forces))
    couple = sp.Add(*((p[0] - body.x) * f[1] - (p[1] - body.y) * f[0] for f, p in forces))
    return F_x, F_y, couple


def generalized(body, F_x, F_y, couple, q):
    """Generalized force along a coordinate q, or x(t), of a force at a body's origin and a couple: force times dx/dq, ..."""
    return F_x * Partial(body.x, q) + F_y * Partial(body.y, q) + couple * Partial(body.angle, q)


def _rate(pose):
    return sp.Add(*(Partial(pose, variable).doit() * rate for variable, rate in rates_of(pose).items()))
