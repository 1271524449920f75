"""Records of a run: telemetry, its energy and passivity, what else it would have shown, and programs over a given motion.

``paddle.run`` returns a Telemetry, whose columns are arrays in SI units:

>>> import hapticlab as hl
>>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
>>> log = paddle.run(hl.wall()(k=500), duration=0.2, v=0.2)
>>> log.columns, len(log)
(('t', 'x', 'v', 'F'), 200)
>>> print(hl.records.staircase(log))
1: 2.05 mm deep: generated 0.1672 mJ, rebound 1.048 of the entry speed

Next: ``hl.plot(log)``, ``hl.energy(log)``, ``hl.chatter(log)``; ``log.save`` and ``Telemetry.load`` keep a record.
"""

from .analysis.programs.replay import replay
from .analysis.records.cycles import frequency
from .analysis.records.energy_books import balance, energy_books
from .analysis.records.staircase import staircase
from .analysis.records.storage import storage
from .base.telemetry import Telemetry
from .compiler.engines.evaluate import evaluate
from .vocabulary import page

__all__ = [
    "Telemetry",
    "balance",
    "energy_books",
    "evaluate",
    "frequency",
    "replay",
    "staircase",
    "storage",
]

page(__name__)
