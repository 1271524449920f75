"""Identification: the constants of a paddle and of a hand from records, with 95 % intervals.

>>> import hapticlab as hl
>>> unknown = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, coulomb=0.05, noise=5e-6, force_max=2.0)
>>> found = hl.identify.paddle(unknown, kinds=("steps",))
>>> 0.03 in found["m"], 0.1 in found["b"]        # each is an interval
(True, True)

Next: ``found.plot()`` shows what the fit leaves unexplained; ``hl.identify.twin("bench 7", found)`` makes a profile of it,
to save, to simulate and to predict with; ``hl.identify.hand`` identifies whoever holds the handle.
"""

from .base.profile.estimate import Estimate
from .identification.free_motion import coasting, throw
from .identification.hand import identify_hand as hand
from .identification.handle_records import HandleRecord, chirp_response, spin_down, step_response
from .identification.handle_records import identify as handle
from .identification.interval_plot import plot_intervals
from .identification.motor_curve import MotorCurve
from .identification.motor_curve import identify_motor as motor
from .identification.paddle import identify_paddle as paddle
from .identification.pushes import push_hand as pushes
from .identification.twin import identify_twin as twin
from .vocabulary import page

__all__ = [
    "Estimate",
    "HandleRecord",
    "MotorCurve",
    "chirp_response",
    "coasting",
    "hand",
    "handle",
    "motor",
    "paddle",
    "plot_intervals",
    "pushes",
    "spin_down",
    "step_response",
    "throw",
    "twin",
]

page(__name__)
