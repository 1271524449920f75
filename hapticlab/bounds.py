"""Published bounds on the stiffness of a virtual wall, one by one and side by side with the exact limit."""

from .limits.bounds import abbott_okamura_limit as abbott_okamura
from .limits.bounds import bounds as table
from .limits.bounds import diolaiti as diolaiti_plane
from .limits.bounds import diolaiti_limit as diolaiti
from .limits.bounds import gil_limit as gil
from .vocabulary import page

__all__ = [
    "abbott_okamura",
    "diolaiti",
    "diolaiti_plane",
    "gil",
    "table",
]

page(__name__)
