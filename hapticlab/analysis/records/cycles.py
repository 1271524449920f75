"""How fast a recorded quantity oscillates, from its upward crossings."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.telemetry import check_record
from ...errors import AnalysisError

if TYPE_CHECKING:
    from ...base.telemetry import Telemetry


def frequency(log: Telemetry, name: str = "x", *, begin: float = 0.0) -> float:
    """Frequency [Hz] of a recorded oscillation: its cycles from the first to the last upward crossing of its mean.

    The crossings are interpolated between samples. The mean is that of the part from ``begin`` on, which should hold several
    cycles about a resting position. :func:`hapticlab.chatter` tells chatter of a wall from decay and from driven motion.

    Parameters
    ----------
    log : Telemetry
    name : str
        Of what was recorded: ``"x"``, ``"F"``, a watched state.
    begin : float
        Time after the start of the record from which on it is used [s], such as when the hand rests.

    Returns
    -------
    float

    Raises
    ------
    AnalysisError
        For a name that was not recorded, and for a record with fewer than two upward crossings.

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.base.telemetry import Telemetry
    >>> t = np.arange(0, 2, 1e-3)
    >>> x = 0.01 * np.sin(2 * np.pi * 3 * t)
    >>> round(frequency(Telemetry(t=t, x=x, v=0 * t, F=0 * t, T=1e-3)), 3)
    3.0
    """
    check_record(log, "frequency", whole=False)
    if name not in log.columns:
        raise AnalysisError(
            f"{name} was not recorded; this log has {', '.join(log.columns)}. Watch it: hl.Scene(..., watch=[...])"
        )
    used = log.t >= begin + (log.t[0] if len(log) else 0.0)
    t, y = log.t[used], np.asarray(getattr(log, name), float)[used]
    y = y - y.mean() if len(y) else y
    before = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    if len(before) < 2:
        raise AnalysisError(
            f"frequency of {name}: the record has {len(before)} upward crossing(s) of its mean and a frequency needs two. "
            "Record more cycles, and hold still while it oscillates."
        )
    step = t[before + 1] - t[before]
    crossings = t[before] - y[before] * step / (y[before + 1] - y[before])
    return float((len(crossings) - 1) / (crossings[-1] - crossings[0]))
