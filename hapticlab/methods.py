"""Methods: integrators and holds, the order of their error, and the trade of speed for accuracy that a scene allows.

Printing a record says its order, cost, stable step, source and what it is confused with. A text is short for a record:
``method="rk4"`` for ``method=hl.methods.RK4``, ``hold="soh"`` for ``hold=hl.methods.SecondOrderHold``.

>>> import hapticlab as hl
>>> rk4 = hl.methods.table()["rk4"]
>>> rk4.order, round(rk4.imaginary, 3)          # an undamped oscillation is stable for w h up to 2.828
(4, 2.828)

Next: ``hl.methods.tradeoff`` compares all of them on a scene and a board, ``hl.stability.step_limit`` finds the longest step.
"""

from .analysis.accuracy.handle_motions import HandleMotion, handle_motions
from .analysis.accuracy.port_error import force_error, sensor_floor
from .analysis.accuracy.reference import reference
from .analysis.accuracy.tradeoff import tradeoff
from .analysis.accuracy.tradeoff_asked import Conditions, Tried
from .analysis.programs.error_order import order_of
from .analysis.programs.method_comparison import methods as table
from .compiler.events.taylor_method import Taylor
from .compiler.methods.chosen_method import Exact
from .compiler.methods.method_table import METHODS, Method
from .compiler.tick.handle_samples import HOLDS, Hold
from .vocabulary import page

Euler = METHODS["euler"]
SemiImplicitEuler = METHODS["semi_implicit_euler"]
SemiImplicitEulerDamped = METHODS["semi_implicit_euler_damped"]
Verlet = METHODS["verlet"]
Midpoint = METHODS["midpoint"]
Heun = METHODS["heun"]
SSPRK3 = METHODS["ssprk3"]
Nystrom4 = METHODS["nystrom4"]
AdamsBashforth2 = METHODS["adams_bashforth2"]
AdamsBashforth3 = METHODS["adams_bashforth3"]
RK4 = METHODS["rk4"]
ZeroOrderHold = HOLDS["zoh"]
FirstOrderHold = HOLDS["foh"]
SecondOrderHold = HOLDS["soh"]

__all__ = [
    "RK4",
    "SSPRK3",
    "AdamsBashforth2",
    "AdamsBashforth3",
    "Conditions",
    "Euler",
    "Exact",
    "FirstOrderHold",
    "HandleMotion",
    "Heun",
    "Hold",
    "Method",
    "Midpoint",
    "Nystrom4",
    "SecondOrderHold",
    "SemiImplicitEuler",
    "SemiImplicitEulerDamped",
    "Taylor",
    "Tried",
    "Verlet",
    "ZeroOrderHold",
    "force_error",
    "handle_motions",
    "order_of",
    "reference",
    "sensor_floor",
    "table",
    "tradeoff",
]

page(__name__)
