"""Estimates of the handle's velocity from its sampled positions, and a comparison of their errors.

Pass an estimate as ``velocity=`` to a law, or write ``estimate.velocity`` in a force of your own:

>>> import hapticlab as hl
>>> smooth = hl.velocity.filtered(tau="4 ms")
>>> hl.wall("half_sample", velocity=smooth)(k=150, x_o="10 mm").name
'half_sample wall, filtered difference'

A smoother velocity is a later one: ``hl.velocity.compare`` measures both. Next: ``hl.laws.virtual_damper``.
"""

from .rendering.velocity_errors import velocity_errors as compare
from .scene.laws.adaptive_window import window_velocity as window
from .scene.laws.estimators import VelocityEstimate
from .scene.laws.estimators import backward_velocity as backward
from .scene.laws.estimators import filtered_velocity as filtered
from .scene.laws.kalman import kalman_velocity as kalman
from .vocabulary import page

__all__ = [
    "VelocityEstimate",
    "backward",
    "compare",
    "filtered",
    "kalman",
    "window",
]

page(__name__)
