"""Design for one paddle: couplers, admittance control, damping compensation, gains, laws and whole designs compared.

The stiffest virtual coupler that stays stable with every passive hand and environment:

>>> import hapticlab as hl
>>> paddle = hl.SimulatedPaddle(m=0.05, b=0.2, T=1e-3)
>>> round(hl.design.coupler(paddle, b_c=0.05).k_c)      # 2 (b - b_c)/T
300

Next: ``hl.design.compare_laws`` runs several laws on the same entries, ``hl.design.law_limits`` finds the limit of each, and
``hl.design.measured`` measures error, load and passivity margin of a design under a budget.
"""

from .analysis.budget.front import front
from .analysis.budget.measured import measured
from .analysis.budget.task import TEXTBOOK as textbook
from .analysis.budget.task import Task
from .analysis.budget.tasks import task
from .analysis.walls.compare_laws import compare_laws
from .analysis.walls.law_limits import law_limits
from .limits.admittance import admittance_design as admittance
from .limits.coupler import coupler_design as coupler
from .rendering.compensation_limit import CompensationLimit
from .rendering.compensation_limit import compensation_limit as compensation
from .rendering.deadbeat import deadbeat_gains
from .rendering.digital import digital_gains
from .rendering.limit_cycle import limit_cycle
from .rendering.over_compensation import over_compensation
from .rendering.wall_laws import Rendering
from .vocabulary import page

__all__ = [
    "CompensationLimit",
    "Rendering",
    "Task",
    "admittance",
    "compare_laws",
    "compensation",
    "coupler",
    "deadbeat_gains",
    "digital_gains",
    "front",
    "law_limits",
    "limit_cycle",
    "measured",
    "over_compensation",
    "task",
    "textbook",
]

page(__name__)
