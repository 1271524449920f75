"""Shapes in the plane, the gaps between them, tracks along curves, and the force that replaces many.

A shape becomes a body with ``.at(...)``. Its place may move with a coordinate or with the handle:

>>> import hapticlab as hl
>>> z = hl.coordinate("z", unit="m")
>>> ball = hl.shapes.Circle("5 mm").at(y=z, name="ball")
>>> hl.shapes.gap(hl.shapes.ground(), ball)
z(t) - (0.005 m)

Next: ``hl.contact.between`` makes the contacts of several bodies at once.
"""

from .scene.notation.amount import Amount
from .scene.shapes.curves import Curve, track
from .scene.shapes.gaps import closest, gap
from .scene.shapes.shapes import Box, Capsule, Circle, HalfPlane, Polygon, Segment, ground, replacement
from .vocabulary import page

__all__ = [
    "Amount",
    "Box",
    "Capsule",
    "Circle",
    "Curve",
    "HalfPlane",
    "Polygon",
    "Segment",
    "closest",
    "gap",
    "ground",
    "replacement",
    "track",
]

page(__name__)
