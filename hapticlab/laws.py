"""Force laws: walls, dampers and couplers, and laws that filter, guard or predict them.

Most return a Scene with parameters to bind, which runs on every paddle. Here 2 N push against 2.5 N s/m:

>>> import hapticlab as hl
>>> paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=2.0))
>>> log = paddle.run(hl.laws.virtual_damper()(B=2.0), duration=1)
>>> round(float(log.v[-1]), 3)
0.8

``hl.wall`` is the wall of the chapter. Its springs are records: ``law="ellis"`` is short for ``law=hl.laws.EllisSpring``, which
prints its equation, its cost and what it is confused with. Next: ``hl.velocity``, ``hl.design.compare_laws``.
"""

from .limits.linear_law import LinearLaw
from .rendering.deadbeat import Pairs, deadbeat_wall
from .rendering.digital import digital_wall
from .rendering.for_board import wall_for_board
from .rendering.hybrid import hybrid_wall
from .rendering.predictive import predictive_wall
from .rendering.wall_laws import wall_law
from .scene.laws.bilateral import Engagement, bilateral_coupling
from .scene.laws.chapter_laws import force_filter, predicted_sample, virtual_coupler, virtual_damper, wall
from .scene.laws.compensation import damping_compensation
from .scene.laws.entry_pulse import Entry, braking_pulse, friction_pulse
from .scene.laws.fixtures import guidance, tremor_filter
from .scene.laws.passivity_control import Credit, passivity_controller, passivity_observer, wall_energy
from .scene.laws.proxy import proxy_curve, proxy_wall
from .scene.laws.taps import SPRING_LAWS, SpringLaw
from .scene.notation.symbols import delay
from .vocabulary import page

SampledSpring = SPRING_LAWS["zoh"]
HalfSampleSpring = SPRING_LAWS["half_sample"]
BackwardDifferenceSpring = SPRING_LAWS["backward_difference"]
EllisSpring = SPRING_LAWS["ellis"]

__all__ = [
    "BackwardDifferenceSpring",
    "Credit",
    "EllisSpring",
    "Engagement",
    "Entry",
    "HalfSampleSpring",
    "LinearLaw",
    "Pairs",
    "SampledSpring",
    "SpringLaw",
    "bilateral_coupling",
    "braking_pulse",
    "damping_compensation",
    "deadbeat_wall",
    "delay",
    "digital_wall",
    "force_filter",
    "friction_pulse",
    "guidance",
    "hybrid_wall",
    "passivity_controller",
    "passivity_observer",
    "predicted_sample",
    "predictive_wall",
    "proxy_curve",
    "proxy_wall",
    "tremor_filter",
    "virtual_coupler",
    "virtual_damper",
    "wall",
    "wall_energy",
    "wall_for_board",
    "wall_law",
]

page(__name__)
