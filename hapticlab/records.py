"""Records of a run: telemetry, its energy and passivity, and what else it would have shown."""

from .analysis.programs.replay import replay
from .analysis.records.energy_books import balance, energy_books
from .analysis.records.staircase import staircase
from .analysis.records.storage import storage
from .base.telemetry import Telemetry
from .vocabulary import page

__all__ = [
    "Telemetry",
    "balance",
    "energy_books",
    "replay",
    "staircase",
    "storage",
]

page(__name__)
