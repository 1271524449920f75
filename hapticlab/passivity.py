"""Passivity of a law on a sampled paddle: margins, indices, ledgers, Nyquist's plot, and ports with bodies behind them."""

from .analysis.impedance.impedance import impedance
from .analysis.records.passivity_trace import passivity_trace as trace
from .analysis.stability.port_passivity import port_passivity as port
from .limits.colgate import equivalent_damper, wall_damping
from .limits.colgate import passivity_margin as margin
from .limits.excess import passivity_ledger as ledger
from .limits.indices import passivity_indices as indices
from .limits.nyquist_disk import nyquist_disk
from .limits.port import port_damping
from .limits.two_port import TwoPort
from .vocabulary import page

__all__ = [
    "TwoPort",
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
]

page(__name__)
