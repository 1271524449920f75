"""Mechanics: equations of motion from energies, what a scene requires, its picture, and a smaller model that feels the same."""

from .analysis.impedance.reduction import reduction
from .analysis.pictures.pictures import picture
from .analysis.programs.requires import requires
from .scene.mechanics.device_image import device_image
from .scene.mechanics.lagrange import Mechanics, lagrange
from .scene.mechanics.sympy_models import from_mechanics
from .vocabulary import page

__all__ = [
    "Mechanics",
    "device_image",
    "from_mechanics",
    "lagrange",
    "picture",
    "reduction",
    "requires",
]

page(__name__)
