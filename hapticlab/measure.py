"""Measurements on a paddle, simulated or real: the stiffest wall, the Z-width, the impedance that is felt."""

from .measurement.impedance import measured_impedance as impedance
from .measurement.impedance_plan import Averaging, Excitation, Safety
from .measurement.largest_stiffness import largest_stiffness
from .measurement.search import Judgement, Search
from .measurement.signals import multisine
from .measurement.z_width import z_width
from .vocabulary import page

__all__ = [
    "Averaging",
    "Excitation",
    "Judgement",
    "Safety",
    "Search",
    "impedance",
    "largest_stiffness",
    "multisine",
    "z_width",
]

page(__name__)
