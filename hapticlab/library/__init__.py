"""Scenes of a course in system dynamics, in the field's names: each a few lines, with a picture and what it teaches.

>>> import hapticlab as hl
>>> scene = hl.library.detents()(p="8 mm")
>>> print(hl.library.catalogue["detents"])
detents: Detents, as of a knob that clicks: F = A sin(2 pi x/p), minima of U at every multiple of the pitch p.
  passive on a paddle with b >= 0.19 N s/m; on an Uno: 1000 Hz

``print(hl.library.catalogue)`` lists them all. Their values are made for :data:`nominal`, a paddle of 50 g with 50 mm of
travel to either side and at most 5 N; another paddle may ask for other values, ``scene(k=..., m=...)``.
"""

from .bodies import mass_spring_damper, tuned_absorber, two_masses
from .entries import CATALOGUE as catalogue
from .entries import NOMINAL as nominal
from .entries import unknown
from .surfaces import buckling_beam, detents, texture, virtual_fixture

__all__ = [
    "buckling_beam",
    "catalogue",
    "detents",
    "mass_spring_damper",
    "nominal",
    "texture",
    "tuned_absorber",
    "two_masses",
    "virtual_fixture",
]


def __getattr__(name):
    raise AttributeError(unknown(name, catalogue))


def __dir__():
    return __all__
