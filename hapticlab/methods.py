"""Integrators: their table and options, the order of their error, and the trade of speed for accuracy that a scene allows."""

from .analysis.accuracy.handle_motions import HandleMotion, handle_motions
from .analysis.accuracy.port_error import force_error, sensor_floor
from .analysis.accuracy.reference import reference
from .analysis.accuracy.tradeoff import tradeoff
from .analysis.programs.error_order import order_of
from .analysis.programs.method_comparison import methods as table
from .compiler.events.taylor_method import Taylor
from .vocabulary import page

__all__ = [
    "HandleMotion",
    "Taylor",
    "force_error",
    "handle_motions",
    "order_of",
    "reference",
    "sensor_floor",
    "table",
    "tradeoff",
]

page(__name__)
