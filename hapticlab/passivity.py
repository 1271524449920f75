"""Passivity of a law on a sampled paddle: margins, indices, ledgers, Nyquist's plot, and ports of whole scenes.

A passive paddle chatters in no passive hand. ``port`` asks how much damping a compiled scene needs from the device:

>>> import hapticlab as hl
>>> paddle = hl.SimulatedPaddle(m=0.05, b=0.15, T=1e-3)
>>> port = hl.passivity.port(paddle, hl.wall()(k=200, x_o="10 mm"))
>>> round(port.b_req, 3), port.passive          # k T/2, Eq. (23.10)
(0.1, True)

Of a scene that switches, that is said of each mode; ``worst_motion`` searches what a motion between modes can draw.

Next: ``hl.passivity_limit`` for the stiffest passive wall, ``hl.bounds.table`` for all bounds, ``hl.stability``.
"""

from .analysis.impedance.impedance import impedance
from .analysis.records.passivity_trace import passivity_trace as trace
from .analysis.stability.port_passivity import port_passivity as port
from .analysis.stability.worst_motion import worst_motion
from .limits.colgate import equivalent_damper, wall_damping
from .limits.colgate import passivity_margin as margin
from .limits.coupled.every_pair import coupled_paddles, coupling_any_hand
from .limits.excess import passivity_ledger as ledger
from .limits.indices import passivity_indices as indices
from .limits.nyquist_disk import nyquist_disk
from .limits.port import port_damping
from .limits.two_port import TwoPort
from .vocabulary import page

__all__ = [
    "TwoPort",
    "coupled_paddles",
    "coupling_any_hand",
    "equivalent_damper",
    "impedance",
    "indices",
    "ledger",
    "margin",
    "nyquist_disk",
    "port",
    "port_damping",
    "trace",
    "wall_damping",
    "worst_motion",
]

page(__name__)
