"""Published bounds on the stiffness of a virtual wall, one by one and side by side with the exact limit.

``table`` computes all that the constants of a paddle allow, and says what each one assumes:

>>> import hapticlab as hl
>>> found = hl.bounds.table(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)).found
>>> round(found["exact stability"].K, 2)
200.07

Next: ``docs/explanation/passivity_bounds.md`` compares them in numbers, ``hl.measure.largest_stiffness`` measures on the paddle.
"""

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
