"""Measurements on a paddle, simulated or real: the stiffest wall, the Z-width, the impedance that is felt.

The same call runs on a board, where it cuts the motor at the first oscillation that grows:

>>> import hapticlab as hl
>>> found = hl.measure.largest_stiffness(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
>>> 190 < float(found) < 210            # N/m; the exact limit is 200.07 N/m
True

Next: ``hl.stability_limit`` for the theory, ``hl.stability.wall_map`` for a map over stiffness and damping.
"""

from .measurement.impedance import measured_impedance as impedance
from .measurement.impedance_plan import Averaging, Excitation, Safety
from .measurement.largest_stiffness import largest_stiffness
from .measurement.quality.comparison import compare_qualities
from .measurement.quality.join import paddle_quality as quality
from .measurement.quality.join import read_quality
from .measurement.search import Judgement, Search, Starts
from .measurement.signals import multisine
from .measurement.z_width import z_width
from .vocabulary import page

__all__ = [
    "Averaging",
    "Excitation",
    "Judgement",
    "Safety",
    "Search",
    "Starts",
    "compare_qualities",
    "impedance",
    "largest_stiffness",
    "multisine",
    "quality",
    "read_quality",
    "z_width",
]

page(__name__)
