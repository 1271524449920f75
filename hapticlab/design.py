"""Design for one paddle: couplers, admittance control, damping compensation, dead-beat and digital gains, and laws compared."""

from .analysis.walls.compare_laws import compare_laws
from .analysis.walls.law_limits import law_limits
from .limits.admittance import admittance_design as admittance
from .limits.coupler import coupler_design as coupler
from .rendering.compensation_limit import CompensationLimit
from .rendering.compensation_limit import compensation_limit as compensation
from .rendering.deadbeat import deadbeat_gains
from .rendering.digital import digital_gains
from .rendering.over_compensation import over_compensation
from .rendering.wall_laws import Rendering
from .vocabulary import page

__all__ = [
    "CompensationLimit",
    "Rendering",
    "admittance",
    "compare_laws",
    "compensation",
    "coupler",
    "deadbeat_gains",
    "digital_gains",
    "law_limits",
    "over_compensation",
]

page(__name__)
