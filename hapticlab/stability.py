"""Stability of a wall, a damper or an integrator on a sampled paddle: poles, root loci, maps and longest steps."""

from .analysis.stability.step_limit import step_limit
from .analysis.walls.wall_map import wall_map
from .limits.local_stiffness import local_stiffness
from .limits.root_locus import root_locus
from .limits.stability import closed_loop_matrix as matrix
from .limits.stability import closed_loop_poles as poles
from .limits.stability import damper_limit
from .vocabulary import page
from .widgets.view import explore

__all__ = [
    "damper_limit",
    "explore",
    "local_stiffness",
    "matrix",
    "poles",
    "root_locus",
    "step_limit",
    "wall_map",
]

page(__name__)
