"""Stability of a wall, a damper or an integrator on one paddle: poles, root loci, maps and longest steps.

Stability is stated for this handle, this hand and this delay; passivity holds for every passive hand.

>>> import hapticlab as hl
>>> locus = hl.stability.root_locus(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
>>> round(locus.limit.K, 2), round(locus.limit.frequency, 2)        # N/m, and the Hz at which it oscillates there
(200.07, 10.06)

Next: ``hl.stability.wall_map`` simulates what a map of stiffness and damping does, ``hl.measure.largest_stiffness``.
"""

from .analysis.stability.step_limit import step_limit
from .analysis.walls.wall_map import wall_map
from .limits.coupled.two_hands import coupling_limit, wave_impedance_limit
from .limits.local_stiffness import local_stiffness
from .limits.root_locus import root_locus
from .limits.stability import closed_loop_matrix as matrix
from .limits.stability import closed_loop_poles as poles
from .limits.stability import damper_limit
from .vocabulary import page
from .widgets.view import explore

__all__ = [
    "coupling_limit",
    "damper_limit",
    "explore",
    "local_stiffness",
    "matrix",
    "poles",
    "root_locus",
    "step_limit",
    "wall_map",
    "wave_impedance_limit",
]

page(__name__)
