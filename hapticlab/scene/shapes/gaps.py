"""Gaps: the signed distance of two placed shapes as an expression, chapter section 23.5.1.2, the narrow phase.

Discs, half-planes, boxes and bars that meet a disc have closed forms, written out. Any other pair is a
:class:`ClosestPoints`, one word that the compiler turns into straight-line arithmetic: exact to rounding, of a cost known
beforehand, and differentiated with the closest points held on their bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp
from sympy.core.symbol import Str

from ...base.arguments import choice
from ...errors import SceneError
from .closest_points import PARTS, ClosestPoints
from .shapes import Box, Capsule, Circle, HalfPlane, Placed, Segment

METHODS = ("faces", "sample", "gjk")


@dataclass(frozen=True)
class Closest:
    """Where two placed shapes are closest.

    Attributes
    ----------
    first, second : Placed
    gap : expression [m]
        Positive apart, 0 in touch, negative in overlap.
    normal : (x, y)
        Unit vector from the first to the second.
    point : (x, y) [m]
        On the surface of one of them; in touch, where they touch.
    """

    first: Placed
    second: Placed
    gap: sp.Expr
    normal: tuple
    point: tuple

    @property
    def slip(self):
        """Velocity [m/s] of the second past the first, along the normal turned by a quarter turn counter-clockwise."""
        (a_x, a_y), (b_x, b_y) = self.first.velocity(self.point), self.second.velocity(self.point)
        return self.normal[0] * (b_y - a_y) - self.normal[1] * (b_x - a_x)

    def force(self, normal_force, friction=0):
        """((F_x, F_y), point) of a normal force, and a friction along the slip, on the second body."""
        n_x, n_y = self.normal
        return (normal_force * n_x - friction * n_y, normal_force * n_y + friction * n_x), self.point


def gap(a: Placed, b: Placed, *, method: str = "faces") -> sp.Expr:
    """Signed distance [m] of two placed shapes: positive apart, 0 in touch, negative in overlap.

    Its depth in overlap is the shortest way apart. Of a nonconvex polygon it is the least over its convex parts, so it
    is right up to touch and as deep as the nearest seam between two parts.

    Parameters
    ----------
    a, b : Placed
        Shapes in their places, ``shape.at(...)``.
    method : {"faces", "sample", "gjk"}
        How the closest edges and corners are found. ``"faces"``: wherever the gap is asked for, at every stage of a
        step; exact. ``"sample"``: once a sample, as Fig. 23.7 has the collision detector beside the solver; the distance
        of what is closest then is exact inside the step, and what is closest changes a sample late. It costs a fraction
        and leaves the motion smooth between samples, which laws with impulses need of polygons. ``"gjk"``: as
        ``"faces"``, cheaper from about 16 corners each; gives no negative distance of the cores, so it is only for
        shapes that a radius widens.

    Returns
    -------
    sympy expression [m]

    Examples
    --------
    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m")
    >>> hl.shapes.gap(hl.shapes.ground(), hl.shapes.Circle("5 mm").at(y=z))
    z(t) - (0.005 m)
    """
    return closest(a, b, method=method).gap


def closest(a: Placed, b: Placed, *, method: str = "faces") -> Any:
    """Where two placed shapes are closest: gap, normal and point; see :func:`gap`.

    Parameters
    ----------
    a, b : Placed
        Two shapes in their places; the normal points from a to b.
    method : str
        As for :func:`gap`.

    Examples
    --------
    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m")
    >>> found = hl.shapes.closest(hl.shapes.ground(), hl.shapes.Circle("5 mm").at(y=z))
    >>> found.gap, found.normal
    (z(t) - (0.005 m), (0, 1))
    """
    for body in (a, b):
        check_placed(body)
    choice("method", method, METHODS, error=SceneError)
    if isinstance(b.shape, HalfPlane) or (isinstance(a.shape, Circle) and not isinstance(b.shape, Circle)):
        if isinstance(a.shape, HalfPlane):
            raise SceneError(f"{a.name} and {b.name} are two half-planes, which always overlap; bound one of them: hl.shapes.Box")
        distance, (n_x, n_y), point = _closest(b, a, method)
        normal = (-n_x, -n_y)
    else:
        distance, normal, point = _closest(a, b, method)
    return Closest(a, b, distance, normal, point)


def check_placed(body):
    """Refuse what is no shape in its place, and a curve, whose gap takes equations of its own."""
    if not isinstance(body, Placed):
        raise SceneError(f"{body!r} is not a shape with a position; write hl.shapes.Circle(0.01).at(x=..., y=..., name='ball')")
    if body.shape.tracked:
        raise SceneError(f"{body.name} is a curve, whose closest point is followed by an equation of motion: hl.shapes.track")


def corners(a, b):
    """A :class:`Closest` for each corner of b above the half-plane a, which together hold a box that lies flat."""
    if not isinstance(a.shape, HalfPlane):
        raise SceneError(f"{a.name} is a {type(a.shape).__name__}; separate gaps for the corners exist only above a HalfPlane")
    return tuple(Closest(a, b, *found) for found in _above(a, b))


def _closest(a, b, method):
    """(Distance, normal, point) of a pair; a half-plane comes first, and a disc second."""
    if isinstance(a.shape, Circle):
        return _discs(a, b)
    above = _above(a, b) if isinstance(a.shape, HalfPlane) else ()
    if len(above) == 1:
        return above[0]
    radii = a.shape.radius + b.shape.radius
    if method == "gjk" and radii == 0:
        raise SceneError(
            f"{a.name} and {b.name}: gjk gives no negative distance, so no force would be felt. Give one of them a radius, "
            "or use method='faces'"
        )
    known = {part: ClosestPoints(_cores(a), _cores(b), Str(method), Str(f"{a.name}, {b.name}"), Str(part)) for part in PARTS}
    normal, r = (known["normal_x"], known["normal_y"]), b.shape.radius
    point = known["point_x"] - r * normal[0], known["point_y"] - r * normal[1]
    if above and method != "sample":
        return _extreme(sp.Min, [height for height, _, _ in above]), normal, point
    if method != "sample" and isinstance(b.shape, Circle) and isinstance(a.shape, (Box, Capsule, Segment)):
        return _from_disc(a, b), normal, point
    return known["distance"] - radii, normal, point


def _cores(body):
    cores = () if isinstance(body.shape, HalfPlane) else body.shape.cores
    corners = sp.Tuple(*(sp.Tuple(*(sp.Tuple(*p) for p in core)) for core in cores))
    return sp.Tuple(corners, body.x, body.y, body.angle, body.shape.radius)


def _extreme(kind, values):
    # not evaluated: SymPy would compare every two of them, in symbols
    return kind(*values, evaluate=False)


def _above(a, b):
    """(Height, normal, point) of each corner above a half-plane."""
    normal, r = a.direction(sp.S.Zero, sp.S.One), b.shape.radius
    found = []
    for u, v in dict.fromkeys(p for core in b.shape.cores for p in core):
        x, y = b.point(u, v)
        height = normal[0] * (x - a.x) + normal[1] * (y - a.y) - r
        found.append((height, normal, (x - r * normal[0], y - r * normal[1])))
    return found


def _discs(a, b):
    x, y = b.x - a.x, b.y - a.y
    d, r = sp.sqrt(x**2 + y**2), b.shape.radius
    normal = x / d, y / d
    return d - a.shape.radius - r, normal, (b.x - r * normal[0], b.y - r * normal[1])


def _from_disc(a, b):
    """Distance of a disc b from a bar or a box, in the frame of the bar or box (Voronoi regions)."""
    x, y, c, s = b.x - a.x, b.y - a.y, sp.cos(a.angle), sp.sin(a.angle)
    u, v = c * x + s * y, c * y - s * x
    if isinstance(a.shape, Box):
        u, v = sp.Abs(u) - a.shape.width / 2, sp.Abs(v) - a.shape.height / 2
        # SymPy's own cases: that a corner is closest is decided beforehand where the disc stays level with the box
        distance = sp.Piecewise((sp.sqrt(u**2 + v**2), (u > 0) & (v > 0)), (_extreme(sp.Max, [u, v]), True))
    else:
        half = a.shape.length / 2
        beyond = _extreme(sp.Max, [sp.Abs(u) - half, sp.S.Zero])
        distance = sp.sqrt(beyond**2 + v**2)
    return distance - a.shape.radius - b.shape.radius
