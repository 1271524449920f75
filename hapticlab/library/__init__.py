"""Scenes of a course in system dynamics, in the field's names: each a few lines, with a picture and what it teaches.

>>> import hapticlab as hl
>>> scene = hl.library.detents()(p="8 mm")
>>> print(hl.library.catalogue["detents"])
detents: Detents, as of a knob that clicks: F = A sin(2 pi x/p), minima of U at every multiple of the pitch p.
  passive on a paddle with b >= 0.19 N s/m; on an Uno: 1000 Hz

``print(hl.library)`` lists them all, ``hl.mechanics.picture("detents")`` draws one. Their values are made for :data:`nominal`, a
paddle of 50 g with 50 mm of travel to either side and at most 5 N; another may ask for others, ``scene(k=..., m=...)``.
"""

import sys

from ..vocabulary import Page
from .bodies import mass_spring_damper, tuned_absorber, two_masses
from .contacts import ball_on_the_paddle, stick_slip
from .entries import CATALOGUE as catalogue
from .entries import NOMINAL as nominal
from .entries import unknown
from .mechanisms import four_bar, gears, rolling, slider_crank
from .pendulums import cart_pole, pendulum_on_the_handle
from .surfaces import buckling_beam, detents, texture, virtual_fixture

__all__ = [
    "ball_on_the_paddle",
    "buckling_beam",
    "cart_pole",
    "catalogue",
    "detents",
    "four_bar",
    "gears",
    "mass_spring_damper",
    "nominal",
    "pendulum_on_the_handle",
    "rolling",
    "slider_crank",
    "stick_slip",
    "texture",
    "tuned_absorber",
    "two_masses",
    "virtual_fixture",
]


class _Library(Page):
    """The page of a library: it prints as its catalogue, and knows in which words a scene may be asked for."""

    def __repr__(self):
        return str(catalogue)

    def __getattr__(self, name):
        raise AttributeError(unknown(name, catalogue))


sys.modules[__name__].__class__ = _Library
