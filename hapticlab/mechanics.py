"""Mechanics: equations of motion from energies, what a scene requires, its picture, and smaller models.

Give the kinetic energy minus the potential energy; Lagrange's equations follow:

>>> import hapticlab as hl
>>> z, (m, k) = hl.coordinate("z", unit="m"), hl.parameters("m k", units="kg N/m")
>>> print(hl.mechanics.lagrange(m * z.diff(hl.t) ** 2 / 2 - k * z**2 / 2).equations[0])
Eq(m*Derivative(z(t), (t, 2)), -k*z(t))

Next: ``hl.library`` for ready scenes, ``hl.contact`` for bodies that touch, ``hl.methods`` for the integrators.
"""

from .analysis.impedance.reduction import reduction
from .analysis.pictures.pictures import picture
from .analysis.programs.felt_difference import felt_difference
from .analysis.programs.requires import requires
from .scene.mechanics.device_image import device_image
from .scene.mechanics.lagrange import Mechanics, lagrange
from .scene.mechanics.sympy_models import from_mechanics
from .vocabulary import page

__all__ = [
    "Mechanics",
    "device_image",
    "felt_difference",
    "from_mechanics",
    "lagrange",
    "picture",
    "reduction",
    "requires",
]

page(__name__)
