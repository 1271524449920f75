"""Shapes in the plane, the gaps between them, tracks along curves, and the force that replaces many."""

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
